#include "renderer/view_targets.h"

#include <fmt/format.h>

#include <algorithm>

namespace ensemble {
namespace {

constexpr std::array<std::uint32_t, 5> kAovPixelBytes = {4, 4, 4, 4, 16};
constexpr std::uint32_t kLinearPixelBytes = 8;

}  // namespace

Readback::Readback(gpu::Device& device, const gpu::Image& image, std::uint32_t pixel_bytes,
                   std::uint64_t max_buffer_bytes)
    : width_(image.options().width),
      height_(image.options().height),
      row_bytes_(std::size_t{pixel_bytes} * image.options().width) {
  rows_per_band_ =
      static_cast<std::uint32_t>(std::clamp<std::uint64_t>(max_buffer_bytes / row_bytes_, 1, height_));
  for (std::uint32_t row = 0; row < height_; row += rows_per_band_) {
    const std::uint32_t rows = std::min(rows_per_band_, height_ - row);
    bands_.emplace_back(device, rows * row_bytes_, vk::BufferUsageFlagBits::eTransferDst,
                        gpu::Buffer::Kind::kReadback, fmt::format("a buffer to read {} rows back", rows));
  }
}

void Readback::record(const vk::raii::CommandBuffer& commands, const gpu::Image& image) const {
  for (std::size_t band = 0; band < bands_.size(); ++band) {
    const std::uint32_t first = static_cast<std::uint32_t>(band) * rows_per_band_;
    commands.copyImageToBuffer(
        image.handle(), vk::ImageLayout::eTransferSrcOptimal, bands_[band].handle(),
        vk::BufferImageCopy{
            .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eColor, .layerCount = 1},
            .imageOffset = {0, static_cast<std::int32_t>(first), 0},
            .imageExtent = {width_, std::min(rows_per_band_, height_ - first), 1}});
  }
  gpu::recordBarrier(commands, vk::PipelineStageFlagBits2::eTransfer, vk::AccessFlagBits2::eTransferWrite,
                     vk::PipelineStageFlagBits2::eHost, vk::AccessFlagBits2::eHostRead);
}

ViewTargets::ViewTargets(gpu::Device& device, const TargetSize& target_size, std::uint64_t max_buffer_bytes)
    : size(target_size) {
  using Usage = vk::ImageUsageFlagBits;
  const std::string what = fmt::format("a picture of {} x {} pixels", size.width, size.height);
  const auto image = [&](vk::Format format, vk::ImageUsageFlags usage, std::uint32_t samples_of_image) {
    return gpu::Image(device,
                      {.width = size.width,
                       .height = size.height,
                       .samples = samples_of_image,
                       .format = format,
                       .usage = usage},
                      what);
  };
  shadow_map = gpu::Image(device,
                          {.width = size.shadow_size,
                           .height = size.shadow_size,
                           .format = kDepthFormat,
                           .usage = Usage::eDepthStencilAttachment | Usage::eSampled | Usage::eTransferDst},
                          "the shadow map");
  if (size.samples > 1)
    samples = image(kColorFormat, Usage::eColorAttachment | Usage::eSampled, size.samples);
  linear = image(kColorFormat,
                 Usage::eColorAttachment | Usage::eSampled | Usage::eTransferSrc | Usage::eStorage, 1);
  depth = image(kDepthFormat, Usage::eDepthStencilAttachment | Usage::eSampled, size.samples);
  srgb = image(vk::Format::eR8G8B8A8Unorm, Usage::eStorage | Usage::eTransferSrc, 1);
  readback = Readback(device, srgb, 4, max_buffer_bytes);
}

void ViewTargets::addLinearReadback(gpu::Device& device, std::uint64_t max_buffer_bytes) {
  if (!linear_readback) linear_readback = Readback(device, linear, kLinearPixelBytes, max_buffer_bytes);
}

void ViewTargets::addAovs(gpu::Device& device, std::uint64_t max_buffer_bytes) {
  if (aov_depth) return;
  using Usage = vk::ImageUsageFlagBits;
  gpu::ImageOptions options{.width = size.width,
                            .height = size.height,
                            .format = kDepthFormat,
                            .usage = Usage::eDepthStencilAttachment};
  const std::string what = fmt::format("AOVs of {} x {} pixels", size.width, size.height);
  for (std::size_t i = 0; i < aovs.size(); ++i) {
    options.format = kAovFormats[i];
    options.usage = Usage::eColorAttachment | Usage::eTransferSrc | Usage::eStorage;
    aovs[i] = gpu::Image(device, options, what);
    aov_readbacks[i] = Readback(device, aovs[i], kAovPixelBytes[i], max_buffer_bytes);
  }
  options.format = kDepthFormat;
  options.usage = Usage::eDepthStencilAttachment | Usage::eSampled;
  aov_depth = gpu::Image(device, options, what);
}

void ViewTargets::addOverdraw(gpu::Device& device, std::uint64_t max_buffer_bytes) {
  addAovs(device, max_buffer_bytes);
  if (overdraw) return;
  using Usage = vk::ImageUsageFlagBits;
  overdraw = gpu::Image(device,
                        {.width = size.width,
                         .height = size.height,
                         .format = kOverdrawFormat,
                         .usage = Usage::eColorAttachment | Usage::eTransferSrc},
                        fmt::format("overdraw of {} x {} pixels", size.width, size.height));
  overdraw_readback = Readback(device, overdraw, sizeof(std::uint16_t), max_buffer_bytes);
}

vk::RenderingAttachmentInfo recordClearedDepth(const vk::raii::CommandBuffer& commands,
                                               const gpu::Image& depth, bool keep) {
  using Access = vk::AccessFlagBits2;
  constexpr auto stages =
      vk::PipelineStageFlagBits2::eEarlyFragmentTests | vk::PipelineStageFlagBits2::eLateFragmentTests;
  gpu::recordBarrier(commands, depth,
                     {.from_stage = stages | vk::PipelineStageFlagBits2::eComputeShader,
                      .to_stage = stages,
                      .from_access = Access::eDepthStencilAttachmentWrite,
                      .to_access = Access::eDepthStencilAttachmentWrite | Access::eDepthStencilAttachmentRead,
                      .to = vk::ImageLayout::eDepthAttachmentOptimal});
  return {.imageView = depth.view(),
          .imageLayout = vk::ImageLayout::eDepthAttachmentOptimal,
          .loadOp = vk::AttachmentLoadOp::eClear,
          .storeOp = keep ? vk::AttachmentStoreOp::eStore : vk::AttachmentStoreOp::eDontCare,
          .clearValue = vk::ClearDepthStencilValue{.depth = 0.0f}};
}

void recordReadableDepth(const vk::raii::CommandBuffer& commands, const gpu::Image& depth) {
  gpu::recordBarrier(commands, depth,
                     {.from_stage = vk::PipelineStageFlagBits2::eLateFragmentTests,
                      .to_stage = vk::PipelineStageFlagBits2::eComputeShader,
                      .from_access = vk::AccessFlagBits2::eDepthStencilAttachmentWrite,
                      .to_access = vk::AccessFlagBits2::eShaderSampledRead,
                      .from = vk::ImageLayout::eDepthAttachmentOptimal,
                      .to = vk::ImageLayout::eShaderReadOnlyOptimal});
}

void recordFullViewport(const vk::raii::CommandBuffer& commands, std::uint32_t width, std::uint32_t height) {
  commands.setViewport(0, vk::Viewport{.width = static_cast<float>(width),
                                       .height = static_cast<float>(height),
                                       .minDepth = 0.0f,
                                       .maxDepth = 1.0f});
  commands.setScissor(0, vk::Rect2D{.extent = {width, height}});
}

void recordTileViewport(const vk::raii::CommandBuffer& commands, const View& view, const Tile& tile) {
  commands.setViewport(0, vk::Viewport{.x = -static_cast<float>(tile.x),
                                       .y = -static_cast<float>(tile.y),
                                       .width = static_cast<float>(view.width),
                                       .height = static_cast<float>(view.height),
                                       .minDepth = 0.0f,
                                       .maxDepth = 1.0f});
  commands.setScissor(0, vk::Rect2D{.extent = {tile.width, tile.height}});
}

}  // namespace ensemble
