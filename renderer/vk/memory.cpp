#include "renderer/vk/memory.h"

#include <algorithm>

namespace ensemble::gpu {
namespace {

constexpr std::uint64_t kStagingBytes = 16ull << 20;

bool isDepth(vk::Format format) { return format == vk::Format::eD32Sfloat; }

}  // namespace

Buffer::Buffer(Device& device, std::uint64_t bytes, vk::BufferUsageFlags usage, Kind kind,
               const std::string& what)
    : size_(std::max<std::uint64_t>(bytes, 16)) {
  using Property = vk::MemoryPropertyFlagBits;
  buffer_ =
      ENSEMBLE_VK(vk::raii::Buffer(device.handle(), vk::BufferCreateInfo{.size = size_, .usage = usage}));
  const vk::MemoryRequirements wanted = buffer_.getMemoryRequirements();
  constexpr auto host = Property::eHostVisible | Property::eHostCoherent;
  vk::MemoryPropertyFlags required = kind == Kind::kDevice ? Property::eDeviceLocal : host;
  vk::MemoryPropertyFlags preferred;
  if (kind == Kind::kUpload) preferred = Property::eDeviceLocal;
  if (kind == Kind::kReadback) preferred = Property::eHostCached;
  vk::raii::DeviceMemory memory = device.allocate(wanted, required, preferred, what);
  ENSEMBLE_VK(buffer_.bindMemory(*memory, 0));
  if (kind != Kind::kDevice) mapped_ = ENSEMBLE_VK(memory.mapMemory(0, VK_WHOLE_SIZE));
  memory_ = Memory(device, std::move(memory), wanted.size);
}

vk::raii::BufferView Buffer::makeTexelView(const Device& device, vk::Format format) const {
  return ENSEMBLE_VK(vk::raii::BufferView(
      device.handle(),
      vk::BufferViewCreateInfo{.buffer = *buffer_, .format = format, .offset = 0, .range = VK_WHOLE_SIZE}));
}

Image::Image(Device& device, const ImageOptions& options, const std::string& what) : options_(options) {
  image_ = ENSEMBLE_VK(vk::raii::Image(
      device.handle(), vk::ImageCreateInfo{.imageType = vk::ImageType::e2D,
                                           .format = options.format,
                                           .extent = {options.width, options.height, 1},
                                           .mipLevels = options.mip_levels,
                                           .arrayLayers = options.layers,
                                           .samples = static_cast<vk::SampleCountFlagBits>(options.samples),
                                           .tiling = vk::ImageTiling::eOptimal,
                                           .usage = options.usage}));
  const vk::MemoryRequirements wanted = image_.getMemoryRequirements();
  vk::raii::DeviceMemory memory = device.allocate(wanted, vk::MemoryPropertyFlagBits::eDeviceLocal, {}, what);
  ENSEMBLE_VK(image_.bindMemory(*memory, 0));
  memory_ = Memory(device, std::move(memory), wanted.size);
  const bool array = options.array_view || options.layers > 1;
  view_ = ENSEMBLE_VK(vk::raii::ImageView(
      device.handle(),
      vk::ImageViewCreateInfo{.image = *image_,
                              .viewType = array ? vk::ImageViewType::e2DArray : vk::ImageViewType::e2D,
                              .format = options.format,
                              .subresourceRange = range()}));
}

vk::ImageSubresourceRange Image::range() const {
  return {.aspectMask =
              isDepth(options_.format) ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor,
          .baseMipLevel = 0,
          .levelCount = options_.mip_levels,
          .baseArrayLayer = 0,
          .layerCount = options_.layers};
}

Buffer uploadBuffer(Device& device, std::span<const std::byte> bytes, vk::BufferUsageFlags usage,
                    const std::string& what) {
  Buffer buffer(device, bytes.size(), usage | vk::BufferUsageFlagBits::eTransferDst, Buffer::Kind::kDevice,
                what);
  const Buffer staging(device, std::min<std::uint64_t>(bytes.size(), kStagingBytes),
                       vk::BufferUsageFlagBits::eTransferSrc, Buffer::Kind::kUpload, "a staging buffer");
  for (std::size_t done = 0; done < bytes.size();) {
    const std::size_t part = std::min<std::size_t>(bytes.size() - done, kStagingBytes);
    std::memcpy(staging.mapped<std::byte>().data(), bytes.data() + done, part);
    device.runOnce([&](const vk::raii::CommandBuffer& commands) {
      commands.copyBuffer(staging.handle(), buffer.handle(),
                          vk::BufferCopy{.srcOffset = 0, .dstOffset = done, .size = part});
      recordBarrier(commands, vk::PipelineStageFlagBits2::eTransfer, vk::AccessFlagBits2::eTransferWrite,
                    vk::PipelineStageFlagBits2::eAllCommands, vk::AccessFlagBits2::eMemoryRead);
    });
    done += part;
  }
  return buffer;
}

void uploadImage(Device& device, const Image& image, std::span<const std::byte> texels, ImagePart part) {
  const std::uint32_t width = std::max(image.options().width >> part.mip_level, 1u);
  const std::uint32_t height = std::max(image.options().height >> part.mip_level, 1u);
  const std::size_t row_bytes = texels.size() / height;
  ENSEMBLE_CHECK(row_bytes * height == texels.size());
  const auto rows_at_once =
      static_cast<std::uint32_t>(std::clamp<std::size_t>(kStagingBytes / row_bytes, 1, height));
  const Buffer staging(device, rows_at_once * row_bytes, vk::BufferUsageFlagBits::eTransferSrc,
                       Buffer::Kind::kUpload, "a staging buffer");
  constexpr auto layout = vk::ImageLayout::eTransferDstOptimal;
  for (std::uint32_t row = 0; row < height; row += rows_at_once) {
    const std::uint32_t rows = std::min(rows_at_once, height - row);
    std::memcpy(staging.mapped<std::byte>().data(), texels.data() + row * row_bytes, rows * row_bytes);
    device.runOnce([&](const vk::raii::CommandBuffer& commands) {
      const vk::ImageMemoryBarrier2 barrier{
          .srcStageMask = vk::PipelineStageFlagBits2::eTransfer,
          .srcAccessMask = vk::AccessFlagBits2::eTransferWrite,
          .dstStageMask = vk::PipelineStageFlagBits2::eTransfer,
          .dstAccessMask = vk::AccessFlagBits2::eTransferWrite,
          .oldLayout = row == 0 ? vk::ImageLayout::eUndefined : layout,
          .newLayout = layout,
          .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
          .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
          .image = image.handle(),
          .subresourceRange = {.aspectMask = vk::ImageAspectFlagBits::eColor,
                               .baseMipLevel = part.mip_level,
                               .levelCount = 1,
                               .baseArrayLayer = part.layer,
                               .layerCount = 1}};
      commands.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier});
      commands.copyBufferToImage(
          staging.handle(), image.handle(), layout,
          vk::BufferImageCopy{.imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor,
                                                   .mipLevel = part.mip_level,
                                                   .baseArrayLayer = part.layer,
                                                   .layerCount = 1},
                              .imageOffset = {0, static_cast<std::int32_t>(row), 0},
                              .imageExtent = {width, rows, 1}});
    });
  }
}

void finishUpload(Device& device, const Image& image) {
  device.runOnce([&](const vk::raii::CommandBuffer& commands) {
    recordBarrier(commands, image,
                  {.from_stage = vk::PipelineStageFlagBits2::eTransfer,
                   .to_stage = vk::PipelineStageFlagBits2::eAllCommands,
                   .from_access = vk::AccessFlagBits2::eTransferWrite,
                   .to_access = vk::AccessFlagBits2::eShaderSampledRead,
                   .from = vk::ImageLayout::eTransferDstOptimal,
                   .to = vk::ImageLayout::eShaderReadOnlyOptimal});
  });
}

void recordBarrier(const vk::raii::CommandBuffer& commands, const Image& image, const ImageBarrier& barrier) {
  const vk::ImageMemoryBarrier2 memory{.srcStageMask = barrier.from_stage,
                                       .srcAccessMask = barrier.from_access,
                                       .dstStageMask = barrier.to_stage,
                                       .dstAccessMask = barrier.to_access,
                                       .oldLayout = barrier.from,
                                       .newLayout = barrier.to,
                                       .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .image = image.handle(),
                                       .subresourceRange = image.range()};
  commands.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &memory});
}

void recordBarrier(const vk::raii::CommandBuffer& commands, vk::PipelineStageFlags2 from_stage,
                   vk::AccessFlags2 from_access, vk::PipelineStageFlags2 to_stage,
                   vk::AccessFlags2 to_access) {
  const vk::MemoryBarrier2 memory{.srcStageMask = from_stage,
                                  .srcAccessMask = from_access,
                                  .dstStageMask = to_stage,
                                  .dstAccessMask = to_access};
  commands.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &memory});
}

void recordComputeBarrier(const vk::raii::CommandBuffer& commands) {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  recordBarrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite,
                Stage::eComputeShader | Stage::eDrawIndirect,
                Access::eShaderStorageRead | Access::eShaderSampledRead | Access::eShaderStorageWrite |
                    Access::eIndirectCommandRead);
}

}  // namespace ensemble::gpu
