#include "renderer/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/check.h"
#include "core/image_file.h"
#include "core/input_error.h"
#include "renderer/crowd_extents.h"
#include "renderer/frame_loop.h"
#include "renderer/mip_chain.h"
#include "renderer/tints.h"

namespace ensemble {
namespace {

/// Runs a part of the public face: what Vulkan refuses leaves as a SystemError.
template <class Function>
decltype(auto) atPublicFace(const Function& function) {
  const auto refuse = [](const char* what) {
    throw SystemError(
        {.file = {}, .where = "Vulkan", .what = what, .mend = "see whether `vulkaninfo` works"});
  };
  try {
    return function();
  } catch (const gpu::VulkanError& error) {
    refuse(error.what());
    throw;
  } catch (const vk::Error& error) {
    refuse(error.what());
    throw;
  }
}

/// The mean colour of a template's skin over its faces, linear: what a skin tint replaces. A head's texture
/// with its hair and eyes tells less about it than plain skin does.
Vec3 meanSkin(const Wardrobe& wardrobe) {
  const TemplateBody& body = wardrobe.body;
  const std::string file = (wardrobe.folder / wardrobe.template_file).string();
  const auto is_plain_skin = [&](const BodyPart& part) {
    const RawMaterial& material = body.materials[part.material];
    return tintKindOf(material.name, true) == TintKind::kSkin && !material.image;
  };
  const bool has_plain = std::any_of(body.parts.begin(), body.parts.end(), is_plain_skin);
  glm::dvec3 sum(0.0);
  double faces = 0.0;
  for (const BodyPart& part : body.parts) {
    const RawMaterial& material = body.materials[part.material];
    if (tintKindOf(material.name, true) != TintKind::kSkin || (has_plain && material.image)) continue;
    Vec3 color(material.base_color);
    if (material.image) color *= meanColor(decodeImage(body.images[*material.image], file));
    sum += glm::dvec3(color) * double{static_cast<double>(part.face_count)};
    faces += part.face_count;
  }
  return faces > 0.0 ? Vec3(sum / faces) : Vec3(0.5f);
}

/// A scene on the device. Members refer to those above them.
struct LoadedScene {
  std::unique_ptr<const Crowd> crowd;
  AovNumbers numbers;
  std::unique_ptr<CrowdAssets> assets;
  std::unique_ptr<CrowdState> state;
  std::unique_ptr<EnvironmentAssets> environment;
  std::unique_ptr<FrameLoop> frames;
};

/// The sub-mesh lists of each wardrobe for what is worn, and which list entry each combination is.
struct WornLists {
  std::vector<SubMeshLists> lists;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> combinations;
};

WornLists buildLists(const Crowd& crowd, std::span<const Wardrobe> wardrobes, Technique technique) {
  WornLists worn;
  std::vector<std::vector<Combination>> per_wardrobe(wardrobes.size());
  for (const WornCombination& combination : crowd.combinations) {
    std::vector<Combination>& own = per_wardrobe[combination.wardrobe];
    worn.combinations.emplace_back(combination.wardrobe, static_cast<std::uint32_t>(own.size()));
    own.push_back(combination.items);
  }
  for (std::size_t w = 0; w < wardrobes.size(); ++w) {
    worn.lists.push_back(buildSubMeshLists(wardrobes[w], per_wardrobe[w], technique));
  }
  return worn;
}

}  // namespace

struct Renderer::Impl {
  explicit Impl(const RendererOptions& renderer_options)
      : options(renderer_options),
        device({.validate = renderer_options.validate,
                .memory_limit = renderer_options.memory_limit,
                .memory = renderer_options.memory}) {
    options.max_buffer_bytes =
        std::min<std::uint64_t>(options.max_buffer_bytes, device.limits().maxStorageBufferRange);
    // The palette is read as texels.
    options.max_buffer_bytes = std::min(options.max_buffer_bytes,
                                        sizeof(vec4) * std::uint64_t{device.limits().maxTexelBufferElements});
  }

  void load(const Scene& scene, std::span<const Wardrobe> wardrobes, const EnvironmentMesh* environment,
            Crowd crowd) {
    ENSEMBLE_CHECK(wardrobes.size() == scene.wardrobes.size());
    ENSEMBLE_CHECK(environment != nullptr || scene.environment.value.empty());
    loaded.reset();  // Its memory is needed.
    LoadedScene next;
    next.crowd = std::make_unique<const Crowd>(std::move(crowd));
    const WornLists worn = buildLists(*next.crowd, wardrobes, scene.technique);
    const Animation animation = buildAnimation(wardrobes);
    CrowdAssets::Input input{.wardrobes = {},
                             .combinations = worn.combinations,
                             .limits = {.max_buffer_bytes = options.max_buffer_bytes}};
    for (std::uint32_t w = 0; w < wardrobes.size(); ++w) {
      input.wardrobes.push_back({.lists = &worn.lists[w],
                                 .file = wardrobes[w].folder.string(),
                                 .fixed_joint = animation.joint_count[w] - 1,
                                 .region_count = static_cast<std::uint32_t>(wardrobes[w].body.regions.size()),
                                 .skin = meanSkin(wardrobes[w])});
      for (const std::string& name : worn.lists[w].garment_names) {
        next.numbers.garments.push_back(name);
        next.numbers.garment_wardrobes.push_back(w);
      }
    }
    next.assets = std::make_unique<CrowdAssets>(device, input);
    next.numbers.first_garment = next.assets->firstGarmentNumber();
    next.state = std::make_unique<CrowdState>(device, *next.crowd, animation, options.max_buffer_bytes);
    if (environment) {
      next.environment = std::make_unique<EnvironmentAssets>(
          device, *environment, AssetLimits{.max_buffer_bytes = options.max_buffer_bytes});
    }
    std::optional<CrowdExtents> extents;
    if (device.canRasterise() && scene.raster != RasterKind::kPipeline)
      extents = extentsOfCrowd(*next.crowd, worn.lists, worn.combinations, animation,
                               device.subgroupSize() * ENSEMBLE_RASTER_RUN);
    next.frames = std::make_unique<FrameLoop>(
        device, *next.assets, *next.state, next.environment.get(), std::move(extents),
        FrameLimits{.max_buffer_bytes = options.max_buffer_bytes,
                    .pose_cache_bytes = std::uint64_t{scene.poses.cache_mib} << 20,
                    .raster_work_bytes = options.raster_work_bytes,
                    .tiles = options.tiles});
    loaded.emplace(std::move(next));
  }

  RendererOptions options;
  gpu::Device device;
  std::optional<LoadedScene> loaded;
};

Renderer::Renderer(const RendererOptions& options)
    : impl_(atPublicFace([&] { return std::make_unique<Impl>(options); })) {}

Renderer::~Renderer() = default;

void Renderer::load(const Scene& scene, std::span<const Wardrobe> wardrobes,
                    const EnvironmentMesh* environment) {
  ENSEMBLE_CHECK(wardrobes.size() == scene.wardrobes.size());
  load(scene, wardrobes, environment, populateCrowd(scene, wardrobes));
}

void Renderer::load(const Scene& scene, std::span<const Wardrobe> wardrobes,
                    const EnvironmentMesh* environment, Crowd crowd) {
  atPublicFace([&] { impl_->load(scene, wardrobes, environment, std::move(crowd)); });
}

void Renderer::render(std::span<const View> views, double seconds, std::span<Picture> pictures) {
  ENSEMBLE_CHECK(impl_->loaded.has_value());
  atPublicFace([&] { impl_->loaded->frames->render(views, seconds, pictures); });
}

const Crowd& Renderer::crowd() const {
  ENSEMBLE_CHECK(impl_->loaded.has_value());
  return *impl_->loaded->crowd;
}

const AovNumbers& Renderer::aovNumbers() const {
  ENSEMBLE_CHECK(impl_->loaded.has_value());
  return impl_->loaded->numbers;
}

std::string Renderer::deviceName() const { return impl_->device.name(); }

bool Renderer::isOnCpu() const { return impl_->device.isCpu(); }

std::uint64_t Renderer::memoryInUse() const { return impl_->device.memoryInUse(); }

std::uint64_t Renderer::memoryLimit() const { return impl_->device.memoryLimit(); }

bool Renderer::countsVertexInvocations() const { return impl_->device.hasPipelineStatistics(); }

std::vector<std::string> Renderer::validationMessages() const { return impl_->device.validationMessages(); }

std::string deviceName() noexcept { return gpu::chosenDeviceName(); }

}  // namespace ensemble
