#include "renderer/animation_texture.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/input_error.h"

namespace ensemble {

gpu::Image uploadAnimation(gpu::Device& device, const Animation& animation) {
  constexpr std::uint32_t kWidth = ENSEMBLE_ANIMATION_WIDTH;
  const std::uint64_t rows = std::max<std::uint64_t>(1, (animation.texels.size() + kWidth - 1) / kWidth);
  const std::uint32_t limit = device.limits().maxImageDimension2D;
  if (rows > limit) {
    throw SystemError(
        {.file = {},
         .where = "Vulkan device " + device.name(),
         .what = fmt::format("the clips need {} rows of an image, the device has {}", rows, limit),
         .mend = "use fewer or shorter clips"});
  }
  gpu::Image image(device,
                   {.width = kWidth,
                    .height = static_cast<std::uint32_t>(rows),
                    .format = vk::Format::eR32G32B32A32Sfloat,
                    .usage = vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst},
                   "the animation texture");
  std::vector<vec4> texels = animation.texels;
  texels.resize(rows * kWidth);
  gpu::uploadImage(device, image, std::as_bytes(std::span(texels)), {.layer = 0, .mip_level = 0});
  gpu::finishUpload(device, image);
  return image;
}

}  // namespace ensemble
