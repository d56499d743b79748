// Buffers and images with memory of their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "core/check.h"
#include "renderer/vk/device.h"

namespace ensemble::gpu {

/// Gives its bytes back to the device's account.
class Memory {
 public:
  Memory() = default;
  Memory(Device& device, vk::raii::DeviceMemory memory, std::uint64_t bytes)
      : device_(&device), memory_(std::move(memory)), bytes_(bytes) {}
  ~Memory() { release(); }
  Memory(Memory&& other) noexcept { *this = std::move(other); }
  Memory& operator=(Memory&& other) noexcept {
    release();
    device_ = std::exchange(other.device_, nullptr);
    memory_ = std::move(other.memory_);
    bytes_ = std::exchange(other.bytes_, 0);
    return *this;
  }
  const vk::raii::DeviceMemory& handle() const { return memory_; }

 private:
  void release() {
    if (device_) device_->freed(bytes_);
    device_ = nullptr;
  }
  Device* device_ = nullptr;
  vk::raii::DeviceMemory memory_ = nullptr;
  std::uint64_t bytes_ = 0;
};

/// A buffer. Mapped ones are host-coherent and stay mapped.
class Buffer {
 public:
  enum class Kind {
    kDevice,    ///< written by copies and shaders
    kUpload,    ///< mapped; the host writes, the device reads
    kReadback,  ///< mapped; the device writes, the host reads
  };

  Buffer() = default;
  /// @param bytes at least 1 is made of 0, so that it can be bound
  /// @throws SystemError if it does not fit; `what` names it
  Buffer(Device& device, std::uint64_t bytes, vk::BufferUsageFlags usage, Kind kind, const std::string& what);

  vk::Buffer handle() const { return *buffer_; }
  std::uint64_t size() const { return size_; }
  explicit operator bool() const { return size_ != 0; }
  /// A view of texels, for shaders that read it as a texel buffer.
  vk::raii::BufferView makeTexelView(const Device& device,
                                     vk::Format format = vk::Format::eR32G32B32A32Sfloat) const;
  vk::DescriptorBufferInfo descriptor() const { return {.buffer = *buffer_, .offset = 0, .range = size_}; }

  /// The mapped content as an array of T. @pre mapped
  template <class T>
  std::span<T> mapped() const {
    ENSEMBLE_CHECK(mapped_ != nullptr);
    return {static_cast<T*>(mapped_), size_ / sizeof(T)};
  }

 private:
  Memory memory_;
  vk::raii::Buffer buffer_ = nullptr;
  std::uint64_t size_ = 0;
  void* mapped_ = nullptr;
};

struct ImageOptions {
  std::uint32_t width = 1, height = 1, layers = 1, mip_levels = 1, samples = 1;
  vk::Format format = vk::Format::eUndefined;
  vk::ImageUsageFlags usage = {};
  bool array_view = false;  ///< a 2D array view even of one layer
};

/// A 2D image in device memory, with a view of all of it.
class Image {
 public:
  Image() = default;
  Image(Device& device, const ImageOptions& options, const std::string& what);

  vk::Image handle() const { return *image_; }
  vk::ImageView view() const { return *view_; }
  const ImageOptions& options() const { return options_; }
  explicit operator bool() const { return *image_ != vk::Image{}; }
  vk::ImageSubresourceRange range() const;

 private:
  Memory memory_;
  vk::raii::Image image_ = nullptr;
  vk::raii::ImageView view_ = nullptr;
  ImageOptions options_;
};

/// A device buffer with the given content, copied there now, in pieces through a staging buffer.
Buffer uploadBuffer(Device& device, std::span<const std::byte> bytes, vk::BufferUsageFlags usage,
                    const std::string& what);

/// A part of an image.
struct ImagePart {
  std::uint32_t layer = 0, mip_level = 0;
};

/// Copies texels, rows from the top without padding, into one level of one layer, through a staging
/// buffer. The image's first upload finds it undefined; `finishUpload` makes all of it readable.
void uploadImage(Device& device, const Image& image, std::span<const std::byte> texels, ImagePart part);
void finishUpload(Device& device, const Image& image);

/// One layout transition or memory dependency of a whole image.
struct ImageBarrier {
  vk::PipelineStageFlags2 from_stage = {}, to_stage = {};
  vk::AccessFlags2 from_access = {}, to_access = {};
  vk::ImageLayout from = vk::ImageLayout::eUndefined, to = vk::ImageLayout::eUndefined;
};
void recordBarrier(const vk::raii::CommandBuffer& commands, const Image& image, const ImageBarrier& barrier);

/// A dependency of all memory.
void recordBarrier(const vk::raii::CommandBuffer& commands, vk::PipelineStageFlags2 from_stage,
                   vk::AccessFlags2 from_access, vk::PipelineStageFlags2 to_stage,
                   vk::AccessFlags2 to_access);

/// What compute shaders wrote, for others and for indirect dispatches.
void recordComputeBarrier(const vk::raii::CommandBuffer& commands);

}  // namespace ensemble::gpu
