#include "renderer/frame_loop.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "core/check.h"

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

template <class T>
void readChannel(const Readback& readback, const View& view, std::vector<T>& values) {
  values.resize(std::size_t{view.width} * view.height);
  readback.forEachRow([&](std::uint32_t row, std::span<const std::byte> bytes) {
    std::memcpy(values.data() + std::size_t{row} * view.width, bytes.data(), bytes.size());
  });
}

/// RGBA32F to three floats a pixel.
void readNormals(const Readback& readback, const View& view, std::vector<float>& values) {
  values.resize(std::size_t{3} * view.width * view.height);
  readback.forEachRow([&](std::uint32_t row, std::span<const std::byte> bytes) {
    float* to = values.data() + std::size_t{3} * row * view.width;
    for (std::uint32_t x = 0; x < view.width; ++x) {
      std::memcpy(to + std::size_t{3} * x, bytes.data() + std::size_t{16} * x, 3 * sizeof(float));
    }
  });
}

void readColor(const Readback& readback, const View& view, Image8& image) {
  image.width = view.width;
  image.height = view.height;
  image.rgba.resize(std::size_t{4} * view.width * view.height);
  readback.forEachRow([&](std::uint32_t row, std::span<const std::byte> bytes) {
    std::memcpy(image.rgba.data() + std::size_t{4} * row * view.width, bytes.data(), bytes.size());
  });
}

void readAovs(const ViewTargets& targets, const View& view, Picture& picture) {
  const auto readback = [&](Aov aov) -> const Readback& {
    return targets.aov_readbacks[static_cast<std::size_t>(aov)];
  };
  const auto wanted = [&](Aov aov, auto& values) {
    if (!view.aovs.has(aov)) values.clear();
    return view.aovs.has(aov);
  };
  if (wanted(Aov::kCharacter, picture.character))
    readChannel(readback(Aov::kCharacter), view, picture.character);
  if (wanted(Aov::kRegion, picture.region)) readChannel(readback(Aov::kRegion), view, picture.region);
  if (wanted(Aov::kFace, picture.face)) readChannel(readback(Aov::kFace), view, picture.face);
  if (wanted(Aov::kDepth, picture.depth)) readChannel(readback(Aov::kDepth), view, picture.depth);
  if (wanted(Aov::kNormal, picture.normal)) readNormals(readback(Aov::kNormal), view, picture.normal);
}

}  // namespace

FrameLoop::FrameLoop(gpu::Device& device, const CrowdAssets& assets, CrowdState& state,
                     std::uint64_t max_buffer_bytes)
    : device_(device),
      assets_(assets),
      state_(state),
      max_buffer_bytes_(max_buffer_bytes),
      layout_(device, assets),
      shadow_pass_(device, layout_, assets),
      color_pass_(device, layout_, assets),
      post_pass_(device),
      main_queues_(device, layout_, assets, state),
      shadow_queues_(device, layout_, assets, state),
      counter_(device, kPassCount),
      shadow_sampler_(makeShadowSampler(device)) {
  visible_.reserve(state.characterCount());
  casters_.reserve(state.characterCount());
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
    const ShadowFit fit = fitShadowMap(view, state_.bounds());
    Slot& slot = slotFor(view, fit.size);
    buildQueues(view, fit);
    slot.view_buffer.mapped<GpuView>()[0] = makeGpuView(view, fit);
    picture.stats.characters_posed = state_.queuePoses(visible_) + state_.queuePoses(casters_);
    record(view, slot);
    picture.stats.cpu_ms = millisecondsSince(start);
    submitAndWait();
    readColor(slot.targets.readback, view, picture.color);
    picture.stats.frame_ms = millisecondsSince(start);
    readStats(view, picture.stats);
    if (!view.aovs.empty()) recordAovs(view, slot);
    readAovs(slot.targets, view, picture);
  }
}

FrameLoop::Slot& FrameLoop::slotFor(const View& view, std::uint32_t shadow_size) {
  const TargetSize size{view.width, view.height, view.samples, shadow_size};
  auto found = std::find_if(slots_.begin(), slots_.end(),
                            [&](const auto& slot) { return slot->targets.size == size; });
  if (found == slots_.end()) {
    if (slots_.size() == kMostSlots) slots_.erase(slots_.begin());
    color_pass_.prepare(view.samples);
    auto slot = std::make_unique<Slot>(
        Slot{.targets = ViewTargets(device_, size, max_buffer_bytes_),
             .view_buffer = gpu::Buffer(device_, sizeof(GpuView), vk::BufferUsageFlagBits::eUniformBuffer,
                                        gpu::Buffer::Kind::kUpload, "a view"),
             .view_set = layout_.makeViewSets(device_, 1),
             .post_set = {}});
    slot->post_set = post_pass_.makeSet(device_, slot->targets);
    gpu::writeBuffer(device_, slot->view_set[0], ENSEMBLE_BINDING_VIEW, slot->view_buffer,
                     vk::DescriptorType::eUniformBuffer);
    gpu::writeImage(device_, slot->view_set[0], ENSEMBLE_BINDING_SHADOW_MAP, slot->targets.shadow_map,
                    &shadow_sampler_, vk::ImageLayout::eShaderReadOnlyOptimal);
    slots_.push_back(std::move(slot));
    found = slots_.end() - 1;
  }
  if (!view.aovs.empty()) {
    (*found)->targets.addAovs(device_, max_buffer_bytes_);
    if (!aov_pass_) aov_pass_ = std::make_unique<AovPass>(device_, layout_, assets_);
  }
  return **found;
}

void FrameLoop::buildQueues(const View& view, const ShadowFit& fit) {
  findVisible(frustumOf(view), state_.bounds(), visible_);
  if (view.light.shadows) {
    findCasters(fit, state_.bounds(), casters_);
  } else {
    casters_.clear();
  }
  main_queues_.build(assets_, state_, visible_);
  shadow_queues_.build(assets_, state_, casters_);
}

void FrameLoop::record(const View& view, const Slot& slot) {
  ENSEMBLE_VK(commands_.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit}));
  counter_.reset(commands_);
  state_.recordPoses(commands_);
  CrowdDraw draw{
      .assets = &assets_, .layout = &layout_, .queues = &shadow_queues_, .view_set = slot.view_set[0]};
  shadow_pass_.record(commands_, draw, slot.targets, counter_, kShadow);
  draw.queues = &main_queues_;
  color_pass_.record(commands_, draw, slot.targets, view, counter_, kMain);
  post_pass_.record(commands_, slot.targets, slot.post_set[0]);
  ENSEMBLE_VK(commands_.end());
}

void FrameLoop::recordAovs(const View& view, const Slot& slot) {
  ENSEMBLE_VK(commands_.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit}));
  const CrowdDraw draw{
      .assets = &assets_, .layout = &layout_, .queues = &main_queues_, .view_set = slot.view_set[0]};
  aov_pass_->record(commands_, draw, slot.targets, view);
  ENSEMBLE_VK(commands_.end());
  submitAndWait();
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

void FrameLoop::readStats(const View& view, FrameStats& stats) const {
  stats.characters_drawn = static_cast<std::uint32_t>(visible_.size());
  stats.gpu_mesh_bytes = assets_.meshBytes();
  const auto pass = [&](const QueueBuffers& queues, Pass number) {
    return PassStats{.draw_calls = queues.counts().draw_calls,
                     .triangles = queues.counts().triangles,
                     .vertex_invocations = counter_.result(device_, number)};
  };
  stats.main = pass(main_queues_, kMain);
  stats.shadow = pass(shadow_queues_, kShadow);
  if (!view.light.shadows && stats.shadow.vertex_invocations) stats.shadow.vertex_invocations = 0;
}

}  // namespace ensemble
