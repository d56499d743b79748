#include "renderer/texture_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "core/input_error.h"
#include "renderer/mip_chain.h"

namespace ensemble {
namespace {

constexpr auto kFormat = vk::Format::eR8G8B8A8Srgb;

/// The smallest array whose side holds the image; the largest for all above.
std::uint32_t sizeClassOf(const RawImage& image) {
  const std::uint32_t side = std::max(image.width, image.height);
  std::uint32_t size_class = 0;
  while (size_class + 1 < TextureStore::kSides.size() && TextureStore::kSides[size_class] < side)
    ++size_class;
  return size_class;
}

vk::raii::Sampler makeSampler(const gpu::Device& device, bool repeat_u, bool repeat_v) {
  const auto mode = [](bool repeat) {
    return repeat ? vk::SamplerAddressMode::eRepeat : vk::SamplerAddressMode::eClampToEdge;
  };
  return ENSEMBLE_VK(
      vk::raii::Sampler(device.handle(), vk::SamplerCreateInfo{.magFilter = vk::Filter::eLinear,
                                                               .minFilter = vk::Filter::eLinear,
                                                               .mipmapMode = vk::SamplerMipmapMode::eLinear,
                                                               .addressModeU = mode(repeat_u),
                                                               .addressModeV = mode(repeat_v),
                                                               .maxLod = VK_LOD_CLAMP_NONE}));
}

}  // namespace

TextureStore::TextureStore(gpu::Device& device, const std::vector<Source>& sources) {
  std::array<std::uint32_t, kSides.size()> layer_counts{};
  for (const Source& source : sources) {
    const std::uint32_t size_class = sizeClassOf(*source.image);
    textures_.push_back({.size_class = size_class, .layer = layer_counts[size_class]++});
  }
  for (std::size_t i = 0; i < kSides.size(); ++i) {
    // An array without textures is one texel, so that it can be bound.
    const bool used = layer_counts[i] > 0;
    const std::uint32_t side = used ? kSides[i] : 1;
    if (layer_counts[i] > device.limits().maxImageArrayLayers) {
      throw SystemError(
          {.file = {},
           .where = "Vulkan device " + device.name(),
           .what = fmt::format("{} textures of {} x {} texels are more than its {}", layer_counts[i], side,
                               side, device.limits().maxImageArrayLayers),
           .mend = "use fewer textures"});
    }
    arrays_[i] =
        gpu::Image(device,
                   {.width = side,
                    .height = side,
                    .layers = std::max(layer_counts[i], 1u),
                    .mip_levels = static_cast<std::uint32_t>(std::bit_width(side)),
                    .format = kFormat,
                    .usage = vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst,
                    .array_view = true},
                   fmt::format("the array of {} textures of {} x {} texels", layer_counts[i], side, side));
    if (!used) {
      const std::array<std::byte, 4> white = {std::byte{255}, std::byte{255}, std::byte{255}, std::byte{255}};
      gpu::uploadImage(device, arrays_[i], white, {});
    }
  }
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const Image8 image = decodeImage(*sources[i].image, sources[i].file);
    StoredTexture& texture = textures_[i];
    texture.mean = meanColor(image);
    const auto levels = mipChain(image, kSides[texture.size_class]);
    for (std::uint32_t level = 0; level < levels.size(); ++level) {
      gpu::uploadImage(device, arrays_[texture.size_class], std::as_bytes(std::span(levels[level])),
                       {.layer = texture.layer, .mip_level = level});
    }
  }
  for (const gpu::Image& array : arrays_) gpu::finishUpload(device, array);
  createSets(device);
}

void TextureStore::createSets(gpu::Device& device) {
  for (std::uint32_t wrap = 0; wrap < kWrapModes; ++wrap) {
    samplers_.push_back(makeSampler(device, (wrap & 1u) != 0, (wrap & 2u) != 0));
  }
  layout_ = gpu::makeSetLayout(device, {vk::DescriptorType::eCombinedImageSampler},
                               vk::ShaderStageFlagBits::eFragment | vk::ShaderStageFlagBits::eCompute);
  constexpr std::uint32_t count = kSides.size() * kWrapModes;
  sets_ = gpu::DescriptorSets(device, layout_, {vk::DescriptorType::eCombinedImageSampler}, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    gpu::writeImage(device, sets_[i], 0, arrays_[i / kWrapModes], &samplers_[i % kWrapModes],
                    vk::ImageLayout::eShaderReadOnlyOptimal);
  }
}

}  // namespace ensemble
