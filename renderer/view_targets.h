// The images that a view is drawn into, and the buffers through which it is read.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/view_setup.h"
#include "renderer/vk/memory.h"

namespace ensemble {

inline constexpr auto kColorFormat = vk::Format::eR16G16B16A16Sfloat;
inline constexpr auto kOverdrawFormat = vk::Format::eR16Sfloat;
inline constexpr auto kDepthFormat = vk::Format::eD32Sfloat;
/// In the order of Aov and ENSEMBLE_AOV_...
inline constexpr std::array<vk::Format, 5> kAovFormats = {vk::Format::eR32Uint, vk::Format::eR32Uint,
                                                          vk::Format::eR32Uint, vk::Format::eR32Sfloat,
                                                          vk::Format::eR32G32B32A32Sfloat};

/// An image's way to the host: rows in buffers of limited size.
class Readback {
 public:
  Readback() = default;
  Readback(gpu::Device& device, const gpu::Image& image, std::uint32_t pixel_bytes,
           std::uint64_t max_buffer_bytes);

  /// Copies the image, in layout eTransferSrcOptimal.
  void record(const vk::raii::CommandBuffer& commands, const gpu::Image& image) const;
  /// Rows of the last copy, to be read after the frame: calls take(row, bytes of the row).
  template <class Take>
  void forEachRow(const Take& take) const {
    for (std::size_t band = 0; band < bands_.size(); ++band) {
      const std::span<const std::byte> bytes = bands_[band].mapped<std::byte>();
      const std::uint32_t first = static_cast<std::uint32_t>(band) * rows_per_band_;
      for (std::uint32_t row = first; row < std::min(first + rows_per_band_, height_); ++row) {
        take(row, bytes.subspan(std::size_t{row - first} * row_bytes_, row_bytes_));
      }
    }
  }
  explicit operator bool() const { return !bands_.empty(); }

 private:
  std::vector<gpu::Buffer> bands_;
  std::uint32_t width_ = 0, height_ = 0, rows_per_band_ = 0;
  std::size_t row_bytes_ = 0;
};

/// What targets depend on.
struct TargetSize {
  std::uint32_t width = 0, height = 0, samples = 1, shadow_size = 0;
  auto operator<=>(const TargetSize&) const = default;
};

struct ViewTargets {
  /// @throws SystemError if they don't fit
  ViewTargets(gpu::Device& device, const TargetSize& target_size, std::uint64_t max_buffer_bytes);
  /// Adds what AOVs need, once.
  void addAovs(gpu::Device& device, std::uint64_t max_buffer_bytes);
  /// Adds what counts overdraw, and aov_depth, once.
  void addOverdraw(gpu::Device& device, std::uint64_t max_buffer_bytes);
  /// Adds what brings the linear picture to the host, once.
  void addLinearReadback(gpu::Device& device, std::uint64_t max_buffer_bytes);

  TargetSize size;
  Tile tile;  ///< what they are drawn into now; as large as they are, or smaller at the picture's edges
  gpu::Image shadow_map;
  gpu::Image samples;  ///< the colour pass's samples; none with one sample
  gpu::Image linear;   ///< resolved, linear, premultiplied
  gpu::Image depth;
  gpu::Image srgb;  ///< what is read back
  Readback readback;
  Readback linear_readback;

  gpu::Image aov_depth;
  std::array<gpu::Image, 5> aovs;
  std::array<Readback, 5> aov_readbacks;

  gpu::Image overdraw;
  Readback overdraw_readback;
};

/// Makes a depth image ready to be cleared and drawn into, after other passes may have done so.
/// @return the attachment that clears it to the sky's depth, 0, and drops it afterwards, unless it is kept
vk::RenderingAttachmentInfo recordClearedDepth(const vk::raii::CommandBuffer& commands,
                                               const gpu::Image& depth, bool keep = false);
/// Makes a depth image that was kept readable by compute shaders.
void recordReadableDepth(const vk::raii::CommandBuffer& commands, const gpu::Image& depth);

/// A viewport and a scissor over a whole target.
void recordFullViewport(const vk::raii::CommandBuffer& commands, std::uint32_t width, std::uint32_t height);
/// The viewport of the whole picture, moved so that the tile falls onto the target, and the tile's scissor.
void recordTileViewport(const vk::raii::CommandBuffer& commands, const View& view, const Tile& tile);

}  // namespace ensemble
