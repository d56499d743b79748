#include "renderer/frame_loop.h"

#include <algorithm>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "core/check.h"
#include "core/input_error.h"
#include "renderer/debug_overlay.h"
#include "renderer/read_picture.h"

namespace ensemble {
namespace {

constexpr std::size_t kMostSlots = 4;

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

vk::raii::Sampler makeShadowSampler(const gpu::Device& device) {
  // Outside the map lies nothing: depth 0, farther from the sun than anything.
  return ENSEMBLE_VK(vk::raii::Sampler(
      device.handle(), vk::SamplerCreateInfo{.magFilter = vk::Filter::eLinear,
                                             .minFilter = vk::Filter::eLinear,
                                             .addressModeU = vk::SamplerAddressMode::eClampToBorder,
                                             .addressModeV = vk::SamplerAddressMode::eClampToBorder,
                                             .compareEnable = true,
                                             .compareOp = vk::CompareOp::eGreaterOrEqual,
                                             .borderColor = vk::BorderColor::eFloatOpaqueBlack}));
}

/// The compute rasteriser transforms each triangle's corners for itself.
void addComputed(const ComputeRaster& compute, ComputeRaster::Eye eye, PassStats& pass) {
  const std::uint64_t triangles = compute.triangleCount(eye);
  pass.draw_calls += compute.dispatchCount(eye);
  pass.triangles += triangles;
  if (pass.vertex_invocations) *pass.vertex_invocations += 3 * triangles;
}

/// Those of `people` for whom `is_computed` holds, and the others.
template <class IsComputed>
void divide(const std::vector<std::uint32_t>& people, const IsComputed& is_computed,
            std::vector<std::uint32_t>& computed, std::vector<std::uint32_t>& others) {
  computed.clear();
  others.clear();
  for (const std::uint32_t person : people) (is_computed(person) ? computed : others).push_back(person);
}

/// The viewport is the whole picture's, also where a tile is drawn.
void refuseBeyondViewport(const gpu::Device& device, const View& view) {
  const auto& most = device.limits().maxViewportDimensions;
  if (view.width <= most[0] && view.height <= most[1]) return;
  throw SystemError(
      {.file = {},
       .where = "Vulkan device " + device.name(),
       .what = fmt::format("a picture of {} x {} pixels is larger than the {} x {} that it can place",
                           view.width, view.height, most[0], most[1]),
       .mend = "make the picture smaller"});
}

}  // namespace

FrameLoop::FrameLoop(gpu::Device& device, const CrowdAssets& assets, CrowdState& state,
                     const EnvironmentAssets* environment, std::optional<CrowdExtents> extents,
                     const FrameLimits& limits)
    : device_(device),
      assets_(assets),
      state_(state),
      environment_(environment),
      limits_(limits),
      layout_(device, assets),
      shadow_pass_(device, layout_, assets),
      color_pass_(device, layout_, assets),
      post_pass_(device),
      main_queues_(device, layout_, assets, state),
      shadow_queues_(device, layout_, assets, state),
      counter_(device, kPassCount),
      timer_(device),
      shadow_sampler_(makeShadowSampler(device)) {
  if (extents) {
    extents_ = std::move(*extents);
    compute_ =
        std::make_unique<ComputeRaster>(device, layout_, assets, state, extents_,
                                        ComputeRasterOptions{.pose_cache_bytes = limits.pose_cache_bytes,
                                                             .work_bytes = limits.raster_work_bytes,
                                                             .max_buffer_bytes = limits.max_buffer_bytes});
  }
  can_cull_on_device_ = DeviceCulling::isPossible(device, assets, state, limits.max_buffer_bytes);
  extents_.longest_edges.resize(state.characterCount(), 0.0f);
  for (const CrowdChunk& chunk : state.chunks()) first_of_chunk_.push_back(chunk.first);
  for (std::vector<std::uint32_t>* list :
       {&visible_, &casters_, &near_, &computed_, &near_casters_, &computed_casters_, &skinned_})
    list->reserve(state.characterCount());
  if (environment_) {
    environment_pass_ = std::make_unique<EnvironmentPass>(device, layout_, *environment_);
    main_environment_ = environment_pass_->makeQueue();
    shadow_environment_ = environment_pass_->makeQueue();
  }
  pool_ = ENSEMBLE_VK(vk::raii::CommandPool(
      device.handle(), vk::CommandPoolCreateInfo{.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer,
                                                 .queueFamilyIndex = device.queueFamily()}));
  commands_ = std::move(ENSEMBLE_VK(vk::raii::CommandBuffers(device.handle(),
                                                             vk::CommandBufferAllocateInfo{
                                                                 .commandPool = *pool_,
                                                                 .level = vk::CommandBufferLevel::ePrimary,
                                                                 .commandBufferCount = 1}))
                            .front());
  fence_ = ENSEMBLE_VK(vk::raii::Fence(device.handle(), vk::FenceCreateInfo{}));
}

void FrameLoop::render(std::span<const View> views, double seconds, std::span<Picture> pictures) {
  ENSEMBLE_CHECK(views.size() == pictures.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const View& view = views[i];
    Picture& picture = pictures[i];
    ENSEMBLE_CHECK(view.samples == 1u || view.samples == 4u);
    ENSEMBLE_CHECK(view.width > 0u && view.height > 0u);
    const Clock::time_point start = Clock::now();
    if (i == 0) state_.setTime(seconds);
    if (view.debug == DebugKind::kNone) {
      drawView(view, start, picture);
    } else {
      drawDebugged(view, start, picture);
    }
  }
}

void FrameLoop::drawDebugged(const View& view, Clock::time_point start, Picture& picture) {
  if (view.debug == DebugKind::kOverdraw) {
    overdraw_.assign(std::size_t{view.width} * view.height, 0);
    drawView(view, start, picture);
    showOverdraw(overdraw_, picture.color);
    return;
  }
  View with_people = view;
  with_people.aovs.add(Aov::kCharacter);
  drawView(with_people, start, picture);
  const auto color_of = [&](std::uint32_t person) {
    return view.debug == DebugKind::kPose ? colorOfPose(shown_.key(person))
                                          : colorOfRasteriser(shown_.isComputed(person));
  };
  tintPeople(picture.character, color_of, picture.color);
  if (!view.aovs.has(Aov::kCharacter)) picture.character.clear();
}

void FrameLoop::drawView(const View& view, Clock::time_point start, Picture& picture) {
  refuseBeyondViewport(device_, view);
  const ShadowFit fit = fitShadowMap(view, state_.bounds(), environment_ ? environment_->bounds() : Box());
  const TileGrid grid(view.width, view.height, limits_.tiles, view.samples);
  Slot& slot = slotFor(view, grid, fit.size);
  if (view.raster == RasterKind::kCompute) requireCompute();
  FrameStats stats;
  stats.gpu_mesh_bytes = assets_.meshBytes();
  stats.environment_bytes = environment_ ? environment_->meshBytes() : 0;
  if (compute_) compute_->beginFrame();
  culls_on_device_ = cullsOnDevice(view);
  if (culls_on_device_ && !culling_)
    culling_ = std::make_unique<DeviceCulling>(device_, layout_, assets_, state_);
  stats.culled_on_device = culls_on_device_;
  choosePeople(view, fit);
  stats.characters_drawn = static_cast<std::uint32_t>(visible_.size());
  stats.characters_computed = static_cast<std::uint32_t>(computed_.size());
  if (!arrangeTiles(view, grid)) stats.characters_computed = 0;
  buildShadowQueues(view, fit);
  picture.coverage.assign(view.coverage ? state_.characterCount() : 0, 0);
  for (std::uint32_t i = 0; i < grid.count(); ++i) {
    // The shadow map that the first tile leaves behind serves the others.
    const bool is_first = i == 0;
    if (!is_first) start = Clock::now();
    slot.targets.tile = grid[i];
    buildQueues(view, slot.targets.tile);
    slot.view_buffer.mapped<GpuView>()[0] = makeGpuView(view, slot.targets.tile, fit);
    if (culls_on_device_) {
      culling_->aim(view, slot.targets.tile, fit, is_first);
    } else {
      stats.characters_posed += queuePoses(near_, computed_);
      if (is_first) stats.characters_posed += queuePoses(near_casters_, computed_casters_);
    }
    prepareCompute(view, slot);
    record(view, slot, is_first);
    stats.cpu_ms += millisecondsSince(start);
    submitAndWait();
    readColor(slot.targets, view, picture);
    stats.frame_ms += millisecondsSince(start);
    addStats(is_first, stats);
    if (culls_on_device_) {
      if (is_first) stats.characters_drawn = culling_->peopleInPicture();
      stats.characters_posed += culling_->peoplePosed();
    }
    timer_.addTo(stats.parts_ms);
    if (!view.aovs.empty()) recordAovs(view, slot);
    readAovs(slot.targets, view, picture);
    if (view.debug == DebugKind::kOverdraw) countOverdraw(view, slot);
    if (view.coverage) countCoverage(view, slot, picture.coverage);
  }
  picture.stats = stats;
}

void FrameLoop::requireCompute() const {
  if (compute_) return;
  throw SystemError({.file = {},
                     .where = "Vulkan device " + device_.name(),
                     .what = "it can't rasterise in compute shaders: it has no 64-bit atomics in buffers, or "
                             "no shuffles in subgroups",
                     .mend = "set raster to auto"});
}

bool FrameLoop::cullsOnDevice(const View& view) const {
  if (view.culling == CullingKind::kHost || view.coverage || view.debug != DebugKind::kNone) return false;
  if (view.culling == CullingKind::kAuto && device_.isCpu()) return false;  // the cores are the same
  return can_cull_on_device_ && !ViewPeople::mayCompute(view, state_.characterCount(), mostComputed());
}

void FrameLoop::choosePeople(const View& view, const ShadowFit& fit) {
  if (culls_on_device_) {
    for (std::vector<std::uint32_t>* list : {&visible_, &casters_, &near_, &computed_}) list->clear();
    return;
  }
  findVisible(frustumOf(view), state_.bounds(), visible_);
  if (view.light.shadows) {
    findCasters(fit, state_.bounds(), casters_);
  } else {
    casters_.clear();
  }
  const PeopleAtTime people{.characters = state_.characters(),
                            .bounds = state_.bounds(),
                            .heights = state_.heights(),
                            .longest_edges = extents_.longest_edges};
  shown_.choose(view, fit, state_.keyFrames(), people, visible_, casters_, mostComputed());
  const auto is_computed = [&](std::uint32_t person) { return shown_.isComputed(person); };
  divide(visible_, is_computed, computed_, near_);
}

FrameLoop::Slot& FrameLoop::slotFor(const View& view, const TileGrid& grid, std::uint32_t shadow_size) {
  const TargetSize size{grid.tileWidth(), grid.tileHeight(), view.samples, shadow_size};
  auto found = std::find_if(slots_.begin(), slots_.end(),
                            [&](const auto& slot) { return slot->targets.size == size; });
  if (found == slots_.end()) {
    if (slots_.size() == kMostSlots) slots_.erase(slots_.begin());
    color_pass_.prepare(view.samples);
    if (environment_pass_) environment_pass_->prepare(view.samples);
    auto slot = std::make_unique<Slot>(
        Slot{.targets = ViewTargets(device_, size, limits_.max_buffer_bytes),
             .view_buffer = gpu::Buffer(device_, sizeof(GpuView), vk::BufferUsageFlagBits::eUniformBuffer,
                                        gpu::Buffer::Kind::kUpload, "a view"),
             .view_set = layout_.makeViewSets(device_, 1),
             .post_set = {},
             .computed = {},
             .computed_shadow = {},
             .computed_aovs = {},
             .computed_overdraw = {}});
    slot->post_set = post_pass_.makeSet(device_, slot->targets);
    gpu::writeBuffer(device_, slot->view_set[0], ENSEMBLE_BINDING_VIEW, slot->view_buffer,
                     vk::DescriptorType::eUniformBuffer);
    gpu::writeImage(device_, slot->view_set[0], ENSEMBLE_BINDING_SHADOW_MAP, slot->targets.shadow_map,
                    &shadow_sampler_, vk::ImageLayout::eShaderReadOnlyOptimal);
    slots_.push_back(std::move(slot));
    found = slots_.end() - 1;
  }
  if (view.linear) (*found)->targets.addLinearReadback(device_, limits_.max_buffer_bytes);
  if (!view.aovs.empty() || view.coverage) (*found)->targets.addAovs(device_, limits_.max_buffer_bytes);
  if (!view.aovs.empty()) {
    if (!aov_pass_) aov_pass_ = std::make_unique<AovPass>(device_, layout_, assets_);
    if (environment_pass_) environment_pass_->prepareAovs();
  }
  if (view.debug == DebugKind::kOverdraw) {
    (*found)->targets.addOverdraw(device_, limits_.max_buffer_bytes);
    if (!overdraw_pass_) overdraw_pass_ = std::make_unique<OverdrawPass>(device_, layout_, assets_);
  }
  if (view.coverage && !coverage_pass_)
    coverage_pass_ = std::make_unique<CoveragePass>(device_, layout_, assets_);
  return **found;
}

bool FrameLoop::arrangeTile(const View& view, const Tile& tile) {
  if (!culls_on_device_ && tile != wholeOf(view)) {  // else choosePeople() has found them
    findVisible(frustumOf(view, tile), state_.bounds(), visible_);
    divide(
        visible_, [&](std::uint32_t person) { return shown_.isComputed(person); }, computed_, near_);
  }
  return !compute_ ||
         compute_->arrange(ComputeRaster::Eye::kCamera, cameraRows(view, tile), state_, shown_, computed_,
                           {.is_on = view.occlusion, .drawn_hides = environment_pass_ || !near_.empty()});
}

bool FrameLoop::arrangeTiles(const View& view, const TileGrid& grid) {
  for (std::uint32_t i = 0; i < grid.count(); ++i) {
    if (arrangeTile(view, grid[i])) continue;
    leaveToPipeline(view, visible_, computed_, near_);
    shown_.computeNobody();
    return false;
  }
  return true;
}

void FrameLoop::buildQueues(const View& view, const Tile& tile) {
  if (tile != wholeOf(view)) ENSEMBLE_CHECK(arrangeTile(view, tile));
  if (compute_)
    compute_->plan(ComputeRaster::Eye::kCamera, cameraRows(view, tile), state_, shown_, computed_);
  if (!culls_on_device_) main_queues_.build(assets_, state_, near_);
  if (!environment_pass_) return;
  const Frustum frustum = frustumOf(view, tile);
  environment_pass_->fill([&](const Box& box) { return frustum.touches(box); }, main_environment_);
}

void FrameLoop::leaveToPipeline(const View& view, const std::vector<std::uint32_t>& people,
                                std::vector<std::uint32_t>& computed,
                                std::vector<std::uint32_t>& others) const {
  if (view.raster != RasterKind::kAuto) compute_->refuseWork();
  computed.clear();
  others = people;
}

void FrameLoop::buildShadowQueues(const View& view, const ShadowFit& fit) {
  divide(
      casters_, [&](std::uint32_t person) { return shown_.castsComputed(person); }, computed_casters_,
      near_casters_);
  if (compute_) {
    constexpr auto kSun = ComputeRaster::Eye::kSun;
    if (!compute_->arrange(kSun, sunRows(fit), state_, shown_, computed_casters_, {}))
      leaveToPipeline(view, casters_, computed_casters_, near_casters_);
    compute_->plan(kSun, sunRows(fit), state_, shown_, computed_casters_);
  }
  if (!culls_on_device_) shadow_queues_.build(assets_, state_, near_casters_);
  if (!environment_pass_) return;
  environment_pass_->fill([&](const Box& box) { return view.light.shadows && mayCast(fit, box); },
                          shadow_environment_);
}

std::uint32_t FrameLoop::queuePoses(const std::vector<std::uint32_t>& drawn,
                                    const std::vector<std::uint32_t>& computed) {
  skinned_.clear();
  for (const std::uint32_t person : computed) {
    if (shown_.key(person) == ViewPeople::kExact && PosePool::needsPalette(state_, person))
      skinned_.push_back(person);
  }
  return state_.queuePoses(drawn, shown_) + state_.queuePoses(skinned_, shown_);
}

void FrameLoop::prepareCompute(const View& view, Slot& slot) {
  using Eye = ComputeRaster::Eye;
  using Drawn = ComputeRaster::Pass;
  const auto prepare = [&](Drawn pass, ComputeRaster::Target& target) {
    if (target.width == 0) target = compute_->makeTarget(pass, slot.targets);
    compute_->prepare(slot.targets, target);
  };
  if (computes(Eye::kCamera)) prepare(Drawn::kPicture, slot.computed);
  if (computes(Eye::kCamera) && !view.aovs.empty()) prepare(Drawn::kAovs, slot.computed_aovs);
  if (computes(Eye::kSun)) prepare(Drawn::kShadow, slot.computed_shadow);
}

void FrameLoop::record(const View& view, const Slot& slot, bool draws_shadows) {
  ENSEMBLE_VK(commands_.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit}));
  counter_.reset(commands_);
  timer_.begin(commands_);
  if (culls_on_device_) culling_->record(commands_);
  timer_.end(commands_, FramePart::kCulling);
  state_.recordPoses(commands_);
  if (compute_) compute_->recordPoses(commands_);
  timer_.end(commands_, FramePart::kPoses);
  if (draws_shadows) recordShadows(view, slot);
  timer_.end(commands_, FramePart::kShadows);
  const CrowdDraw draw{.assets = &assets_,
                       .layout = &layout_,
                       .queues = &main_queues_,
                       .view_set = slot.view_set[0],
                       .device_queues = culls_on_device_ ? &culling_->main() : nullptr,
                       .environment = {environment_pass_.get(), &main_environment_, kEnvironmentMain}};
  const bool computed = computes(ComputeRaster::Eye::kCamera);
  color_pass_.record(commands_, draw, slot.targets, view, counter_, kMain, computed);
  timer_.end(commands_, FramePart::kPipeline);
  const float near_plane = view.camera.near_plane;
  if (computed) compute_->record(commands_, draw.view_set, slot.computed, near_plane);
  timer_.end(commands_, FramePart::kRaster);
  if (computed) compute_->recordColor(commands_, draw.view_set, slot.targets, slot.computed, view);
  timer_.end(commands_, FramePart::kShading);
  post_pass_.record(commands_, slot.targets, slot.post_set[0], view.linear);
  timer_.end(commands_, FramePart::kPost);
  ENSEMBLE_VK(commands_.end());
}

void FrameLoop::recordShadows(const View& view, const Slot& slot) {
  using Eye = ComputeRaster::Eye;
  const CrowdDraw draw{.assets = &assets_,
                       .layout = &layout_,
                       .queues = &shadow_queues_,
                       .view_set = slot.view_set[0],
                       .device_queues = culls_on_device_ ? &culling_->shadow() : nullptr,
                       .environment = {environment_pass_.get(), &shadow_environment_, kEnvironmentShadow}};
  std::function<void()> fill;
  if (computes(Eye::kSun)) {
    compute_->record(commands_, draw.view_set, slot.computed_shadow, view.camera.near_plane);
    fill = [&] { ComputeRaster::recordShadowMap(commands_, slot.targets, slot.computed_shadow); };
  }
  shadow_pass_.record(commands_, draw, slot.targets, counter_, kShadow, fill);
}

void FrameLoop::recordAovs(const View& view, const Slot& slot) {
  ENSEMBLE_VK(commands_.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit}));
  const CrowdDraw draw{.assets = &assets_,
                       .layout = &layout_,
                       .queues = &main_queues_,
                       .view_set = slot.view_set[0],
                       .device_queues = culls_on_device_ ? &culling_->main() : nullptr,
                       .environment = {environment_pass_.get(), &main_environment_, kEnvironmentMain}};
  const auto draw_computed = [&] {
    compute_->record(commands_, draw.view_set, slot.computed_aovs, view.camera.near_plane);
    compute_->recordAovs(commands_, draw.view_set, slot.computed_aovs, view.camera.near_plane);
  };
  std::function<void()> more;  // by reference: a copy would allocate
  if (computes(ComputeRaster::Eye::kCamera)) more = std::cref(draw_computed);
  aov_pass_->record(commands_, draw, slot.targets, view, more);
  ENSEMBLE_VK(commands_.end());
  submitAndWait();
}

void FrameLoop::countCoverage(const View& view, const Slot& slot, std::vector<std::uint32_t>& pixels) {
  const CrowdDraw draw{
      .assets = &assets_, .layout = &layout_, .queues = &main_queues_, .view_set = slot.view_set[0]};
  // Everybody is drawn by the graphics pipeline here.
  main_queues_.build(assets_, state_, visible_);
  state_.queuePoses(visible_, shown_);
  coverage_pass_->plan(main_queues_);
  for (std::size_t group = 0; group < coverage_pass_->groupCount(); ++group) {
    ENSEMBLE_VK(commands_.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit}));
    if (group == 0) state_.recordPoses(commands_);
    coverage_pass_->record(commands_, draw, slot.targets, view, group);
    ENSEMBLE_VK(commands_.end());
    submitAndWait();
    coverage_pass_->collect(device_, first_of_chunk_, group, pixels);
  }
}

void FrameLoop::countOverdraw(const View& view, Slot& slot) {
  using Stage = vk::PipelineStageFlagBits2;
  const bool computed = computes(ComputeRaster::Eye::kCamera);
  ComputeRaster::Target& target = slot.computed_overdraw;
  if (computed) {
    if (target.width == 0) target = compute_->makeTarget(ComputeRaster::Pass::kOverdraw, slot.targets);
    compute_->prepare(slot.targets, target);
  }
  ENSEMBLE_VK(commands_.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit}));
  const CrowdDraw draw{
      .assets = &assets_, .layout = &layout_, .queues = &main_queues_, .view_set = slot.view_set[0]};
  if (computed) {
    compute_->record(commands_, draw.view_set, target, view.camera.near_plane);
    gpu::recordBarrier(commands_, Stage::eComputeShader, vk::AccessFlagBits2::eShaderStorageWrite,
                       Stage::eHost, vk::AccessFlagBits2::eHostRead);
  }
  overdraw_pass_->record(commands_, draw, slot.targets, view);
  ENSEMBLE_VK(commands_.end());
  submitAndWait();
  std::span<const std::uint32_t> counted;
  if (computed) counted = target.visible.mapped<std::uint32_t>();
  OverdrawPass::collect(slot.targets, view, counted, overdraw_);
}

void FrameLoop::submitAndWait() {
  const vk::CommandBufferSubmitInfo submitted{.commandBuffer = *commands_};
  ENSEMBLE_VK(device_.queue().submit2(
      vk::SubmitInfo2{.commandBufferInfoCount = 1, .pCommandBufferInfos = &submitted}, *fence_));
  const vk::Result result =
      ENSEMBLE_VK(device_.handle().waitForFences(*fence_, true, std::numeric_limits<std::uint64_t>::max()));
  if (result != vk::Result::eSuccess) gpu::throwVulkanError(result, "waitForFences", __FILE__, __LINE__);
  ENSEMBLE_VK(device_.handle().resetFences(*fence_));
}

void FrameLoop::addStats(bool drew_shadows, FrameStats& stats) const {
  const auto add = [&](const DrawCounts& counts, Pass number, PassStats& pass) {
    pass.draw_calls += counts.draw_calls;
    pass.triangles += counts.triangles;
    const std::optional<std::uint64_t> invocations = counter_.result(device_, number);
    if (invocations) pass.vertex_invocations = pass.vertex_invocations.value_or(0) + *invocations;
  };
  const auto add_environment = [&](const EnvironmentQueue& queue, Pass number, PassStats& pass) {
    add(queue.counts, number, pass);
    add(queue.counts, number, stats.environment);
  };
  const DrawCounts drawn = culls_on_device_ ? culling_->main().counts() : main_queues_.counts();
  add(drawn, kMain, stats.main);
  stats.people_triangles += drawn.triangles;
  if (compute_) {
    const std::uint64_t computed = compute_->triangleCount(ComputeRaster::Eye::kCamera);
    addComputed(*compute_, ComputeRaster::Eye::kCamera, stats.main);
    stats.people_triangles += computed;
    stats.triangles_computed += computed;
    stats.triangles_hidden += compute_->hiddenTriangleCount(ComputeRaster::Eye::kCamera);
    const PoseCacheStats& poses = compute_->poses().stats();
    stats.poses = {.kept = poses.hits,
                   .skinned = poses.misses,
                   .own = compute_->poses().own().count(),
                   .skinned_vertices = compute_->poses().skinnedVertices(),
                   .kept_bytes = poses.kept_vertices * 2 * sizeof(std::uint32_t)};
  }
  add_environment(main_environment_, kEnvironmentMain, stats.main);
  if (!drew_shadows) return;
  add(culls_on_device_ ? culling_->shadow().counts() : shadow_queues_.counts(), kShadow, stats.shadow);
  if (compute_) addComputed(*compute_, ComputeRaster::Eye::kSun, stats.shadow);
  add_environment(shadow_environment_, kEnvironmentShadow, stats.shadow);
}

}  // namespace ensemble
