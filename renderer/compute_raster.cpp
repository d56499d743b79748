#include "renderer/compute_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/input_error.h"
#include "renderer/crowd_pipeline.h"
#include "spirv/raster.comp.h"
#include "spirv/raster_aov.comp.h"
#include "spirv/raster_bins.comp.h"
#include "spirv/raster_color.comp.h"
#include "spirv/raster_list.comp.h"
#include "spirv/raster_list_samples.comp.h"
#include "spirv/raster_resolve.comp.h"
#include "spirv/raster_sort.comp.h"

namespace ensemble {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;

constexpr auto kStorage = vk::DescriptorType::eStorageBuffer;
constexpr auto kTexels = vk::DescriptorType::eUniformTexelBuffer;
constexpr auto kSampled = vk::DescriptorType::eCombinedImageSampler;
constexpr auto kImage = vk::DescriptorType::eStorageImage;
/// In the order of ENSEMBLE_BINDING_RASTER_...
constexpr std::initializer_list<vk::DescriptorType> kBindings = {
    kTexels,  kTexels,  kStorage, kStorage, kStorage,  // people, who, entries, work, groups
    kStorage, kTexels,  kTexels,  kTexels,             // target, indices, poses, vertices
    kTexels,  kTexels,  kTexels,  kTexels,  kTexels,   // items, shown, table of poses, materials, tints
    kStorage, kStorage, kSampled, kImage,              // pixels, bins, depth, picture
    kSampled, kStorage, kTexels,  kTexels};            // drawn, shaded, seen, listed
constexpr std::initializer_list<vk::DescriptorType> kAovBindings = {kImage, kImage, kImage, kImage, kImage};

constexpr std::uint64_t kVisibleBytes = 8, kListedBytes = 16, kShadedBytes = 8;

/// Pixels that are listed and shaded at a time.
std::uint32_t bandPixels(std::uint32_t samples) { return ENSEMBLE_RASTER_BAND / samples; }

std::uint32_t listGroups(std::uint32_t pixels) {
  return (pixels + ENSEMBLE_GROUP_PIXELS - 1) / ENSEMBLE_GROUP_PIXELS;
}

/// Where the device writes the groups that it picks of a batch of the second round.
std::uint32_t firstPickedGroup(const RasterPlan& plan, const PlanBatch& batch) {
  return static_cast<std::uint32_t>(plan.groups().size()) + batch.first_group - plan.firstLateGroup();
}

}  // namespace

/// As raster_sets.glsl has it.
struct ComputeRaster::Push {
  std::uint32_t first_group = 0, group_count = 0, face_bits = 0, width = 0, height = 0;
  float near_plane = 0.0f;
  std::uint32_t bin = 0, bin_count = 0, first_pixel = 0, pixel_count = 0, wide_indices = 0;
};

ComputeRaster::ComputeRaster(gpu::Device& device, const CrowdLayout& layout, const CrowdAssets& assets,
                             const CrowdState& state, const CrowdExtents& extents,
                             const ComputeRasterOptions& options)
    : device_(device),
      layout_(layout),
      assets_(assets),
      options_(options),
      poses_(device, assets, state, options.pose_cache_bytes, options.max_buffer_bytes),
      items_(device, assets, poses_),
      occlusion_(device) {
  materials_view_ = assets.materials().makeTexelView(device, vk::Format::eR32G32B32A32Uint);
  tints_view_ = assets.tints().makeTexelView(device);
  boxes_ = gpu::uploadBuffer(device, std::as_bytes(std::span(extents.boxes)),
                             vk::BufferUsageFlagBits::eUniformTexelBuffer, "the boxes of runs of triangles");
  boxes_view_ = boxes_.makeTexelView(device);
  createPipelines();
  camera_.eye = Eye::kCamera;
  sun_work_.eye = Eye::kSun;
  for (Work* work : {&camera_, &sun_work_}) {
    work->plan = std::make_unique<RasterPlan>(items_.planItems(extents, work->eye == Eye::kSun),
                                              items_.shown(work->eye == Eye::kSun),
                                              device.subgroupSize() * ENSEMBLE_RASTER_RUN);
  }
}

void ComputeRaster::createPipelines() {
  constexpr auto kCompute = vk::ShaderStageFlagBits::eCompute;
  sampler_ = ENSEMBLE_VK(vk::raii::Sampler(device_.handle(), vk::SamplerCreateInfo{}));  // texelFetch only
  set_layout_ = gpu::makeSetLayout(device_, kBindings, kCompute);
  aov_layout_ = gpu::makeSetLayout(device_, kAovBindings, kCompute);
  const auto make_layout = [&](vk::DescriptorSetLayout last) {
    return gpu::makePipelineLayout(
        device_, std::array{*layout_.viewLayout(), *set_layout_, *layout_.assetLayout(), last}, sizeof(Push));
  };
  pipeline_layout_ = make_layout(*assets_.textures().layout());
  aov_pipeline_layout_ = make_layout(*aov_layout_);

  struct Constants {
    std::uint32_t lanes;
    vk::Bool32 to_sun = false, textured = false;
    std::int32_t samples = 1;
    vk::Bool32 cut_out = false, hides_faces = false, shadows = true, counts = false;
  };
  constexpr std::array<vk::SpecializationMapEntry, 8> kEntries = {{
      {ENSEMBLE_CONSTANT_LANES, offsetof(Constants, lanes), sizeof(std::uint32_t)},
      {ENSEMBLE_CONSTANT_TO_SUN, offsetof(Constants, to_sun), sizeof(vk::Bool32)},
      {ENSEMBLE_CONSTANT_TEXTURED, offsetof(Constants, textured), sizeof(vk::Bool32)},
      {ENSEMBLE_CONSTANT_SAMPLES, offsetof(Constants, samples), sizeof(std::int32_t)},
      {ENSEMBLE_CONSTANT_CUT_OUT, offsetof(Constants, cut_out), sizeof(vk::Bool32)},
      {ENSEMBLE_CONSTANT_HIDE_FACES, offsetof(Constants, hides_faces), sizeof(vk::Bool32)},
      {ENSEMBLE_CONSTANT_SHADOWS, offsetof(Constants, shadows), sizeof(vk::Bool32)},
      {ENSEMBLE_CONSTANT_COUNTS, offsetof(Constants, counts), sizeof(vk::Bool32)},
  }};
  const auto make = [&](const vk::raii::PipelineLayout& layout, std::span<const std::uint32_t> spirv,
                        Constants constants) {
    const vk::SpecializationInfo info{.mapEntryCount = kEntries.size(),
                                      .pMapEntries = kEntries.data(),
                                      .dataSize = sizeof constants,
                                      .pData = &constants};
    return gpu::makeComputePipeline(device_, layout, spirv, &info);
  };
  const std::uint32_t lanes = device_.subgroupSize();
  const auto make_one = [&](std::span<const std::uint32_t> spirv, const Constants& constants) {
    return make(pipeline_layout_, spirv, constants);
  };
  for (const std::int32_t samples : {1, 4}) {
    Sampled& own = sampled_[samples > 1 ? 1 : 0];
    const Constants plain{.lanes = lanes, .samples = samples};
    Constants cut_out = plain;
    cut_out.cut_out = true;
    own.raster = make_one(kRasterComp, plain);
    own.cut_out_raster = make_one(kRasterComp, cut_out);
    own.list = samples > 1 ? make_one(kRasterListSamplesComp, plain) : make_one(kRasterListComp, plain);
    for (std::uint32_t i = 0; i < own.color.size(); ++i) {
      Constants color = plain;
      color.textured = i & 1u;
      color.shadows = i >> 1;
      own.color[i] = make_one(kRasterColorComp, color);
    }
  }
  for (std::uint32_t i = 0; i < sun_.size(); ++i) {
    sun_[i] =
        make_one(kRasterComp, {.lanes = lanes, .to_sun = true, .cut_out = i & 1u, .hides_faces = i >> 1});
  }
  for (std::uint32_t i = 0; i < overdraw_.size(); ++i)
    overdraw_[i] = make_one(kRasterComp, {.lanes = lanes, .cut_out = i, .counts = true});
  count_bins_ = make_one(kRasterBinsComp, {.lanes = lanes});
  sort_ = make_one(kRasterSortComp, {.lanes = lanes});
  resolve_ = make_one(kRasterResolveComp, {.lanes = lanes, .samples = 4});
  aov_ = make(aov_pipeline_layout_, kRasterAovComp, {.lanes = lanes});
}

const vk::raii::Pipeline& ComputeRaster::rasterPipeline(const Target& target,
                                                        const RasterItems::State& state) const {
  if (target.pass == Pass::kShadow) return sun_[(state.cut_out ? 1u : 0u) + (state.hides_faces ? 2u : 0u)];
  if (target.pass == Pass::kOverdraw) return overdraw_[state.cut_out ? 1 : 0];
  return state.cut_out ? sampled(target).cut_out_raster : sampled(target).raster;
}

std::uint64_t ComputeRaster::triangleCount(Eye eye) const {
  return hasWork(eye) ? workOf(eye).plan->triangleCount() - hiddenTriangleCount(eye) : 0;
}

std::uint64_t ComputeRaster::hiddenTriangleCount(Eye eye) const {
  const Work& work = workOf(eye);
  if (work.people.empty() || !work.plan->hasSecondRound()) return 0;
  std::uint64_t hidden = work.plan->lateTriangleCount();
  const std::span<const GpuRasterBatch> batches = work.batches.mapped<GpuRasterBatch>();
  for (std::size_t i = 0; i < work.plan->batches().size(); ++i) hidden -= batches[i].triangle_count;
  return hidden;
}

std::uint32_t ComputeRaster::binCount() const {
  return static_cast<std::uint32_t>(items_.bins().size() * std::max<std::size_t>(poses_.buffers().size(), 1));
}

void ComputeRaster::refuseTooManyBins() const {
  constexpr std::uint32_t kMost = 1u << (32 - ENSEMBLE_LISTED_ITEM_BITS);
  if (binCount() <= kMost) return;
  throw SystemError(
      {.file = {},
       .where = "Vulkan device " + device_.name(),
       .what = fmt::format("{} buffers of poses by {} sets of meshes and textures are more than "
                           "the {} that the compute rasteriser tells apart",
                           poses_.buffers().size(), items_.bins().size(), kMost),
       .mend = "use fewer people, or set raster to pipeline"});
}

ComputeRaster::Target ComputeRaster::makeTarget(Pass pass, const ViewTargets& targets) {
  using Usage = vk::BufferUsageFlagBits;
  Target target;
  const bool to_sun = pass == Pass::kShadow, counts = pass == Pass::kOverdraw;
  target.pass = pass;
  target.width = to_sun ? targets.size.shadow_size : targets.size.width;
  target.height = to_sun ? targets.size.shadow_size : targets.size.height;
  target.samples = pass == Pass::kPicture ? targets.size.samples : 1;
  const std::uint64_t pixels = std::uint64_t{target.width} * target.height;
  const std::uint64_t band =
      to_sun || counts ? 0 : std::min<std::uint64_t>(pixels, bandPixels(target.samples));
  const auto buffer = [&](std::uint64_t bytes, const char* what,
                          gpu::Buffer::Kind kind = gpu::Buffer::Kind::kDevice) {
    return gpu::Buffer(
        device_, bytes,
        Usage::eStorageBuffer | Usage::eUniformTexelBuffer | Usage::eTransferDst | Usage::eTransferSrc, kind,
        what);
  };
  const std::uint64_t pixel_bytes = to_sun   ? sizeof(float)
                                    : counts ? sizeof(std::uint32_t)
                                             : target.samples * kVisibleBytes;
  target.visible = buffer(pixels * pixel_bytes, "the rasteriser's samples",
                          counts ? gpu::Buffer::Kind::kReadback : gpu::Buffer::Kind::kDevice);
  target.pixels = buffer(band * target.samples * 2 * kListedBytes, "the rasteriser's list of pixels");
  target.shaded =
      buffer(target.samples > 1 ? band * target.samples * kShadedBytes : 0, "the rasteriser's colours");
  target.seen_view = target.visible.makeTexelView(device_, vk::Format::eR32G32Uint);
  target.listed_view = target.pixels.makeTexelView(device_, vk::Format::eR32G32B32A32Uint);
  if (!to_sun) target.occlusion = occlusion_.makeTarget(target.width, target.height, target.samples);
  if (pass != Pass::kAovs) return target;
  target.aov_set = gpu::DescriptorSets(device_, aov_layout_, kAovBindings, 1);
  for (std::uint32_t i = 0; i < targets.aovs.size(); ++i)
    gpu::writeImage(device_, target.aov_set[0], i, targets.aovs[i], nullptr, vk::ImageLayout::eGeneral);
  return target;
}

void ComputeRaster::prepare(const ViewTargets& targets, Target& target) {
  poses_.prepare();
  const Work& work = workOf(eyeOf(target.pass));
  const auto pose_buffers = static_cast<std::uint32_t>(poses_.buffers().size());
  if (target.pose_buffers != pose_buffers) {
    refuseTooManyBins();
    const std::uint64_t bins = binCount() + 1;
    target.bins =
        gpu::Buffer(device_, bins * sizeof(GpuRasterBin),
                    vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst |
                        vk::BufferUsageFlagBits::eIndirectBuffer,
                    gpu::Buffer::Kind::kDevice, "the rasteriser's bins");
    target.sets = gpu::DescriptorSets(device_, set_layout_, kBindings,
                                      static_cast<std::uint32_t>(items_.pairs().size()) * pose_buffers);
  } else if (target.work_number == work.number) {
    return;
  }
  target.pose_buffers = pose_buffers;
  target.work_number = work.number;
  writeSets(work, targets, target);
}

void ComputeRaster::writeSets(const Work& work, const ViewTargets& targets, Target& target) const {
  const gpu::Image& depth = target.pass == Pass::kAovs ? targets.aov_depth : targets.depth;
  if (target.pass != Pass::kShadow) {
    occlusion_.writeSet(target.occlusion, {.seen = target.seen_view,
                                           .occludees = work.occludees_view,
                                           .boxes = boxes_view_,
                                           .depth = depth,
                                           .entries = work.entries,
                                           .work = work.work,
                                           .groups = work.groups,
                                           .batches = work.batches});
  }
  for (std::size_t i = 0; i < target.sets.size(); ++i) {
    const vk::DescriptorSet set = target.sets[i];
    const RasterItems::Pair& pair = items_.pairs()[i % items_.pairs().size()];
    const auto buffer = [&](std::uint32_t binding, const gpu::Buffer& bound) {
      gpu::writeBuffer(device_, set, binding, bound);
    };
    const auto texels = [&](std::uint32_t binding, const vk::raii::BufferView& view) {
      gpu::writeTexelBuffer(device_, set, binding, view);
    };
    texels(ENSEMBLE_BINDING_RASTER_PEOPLE, work.rows_view);
    texels(ENSEMBLE_BINDING_RASTER_WHO, work.who_view);
    buffer(ENSEMBLE_BINDING_RASTER_ENTRIES, work.entries);
    buffer(ENSEMBLE_BINDING_RASTER_WORK, work.work);
    buffer(ENSEMBLE_BINDING_RASTER_GROUPS, work.groups);
    buffer(ENSEMBLE_BINDING_RASTER_TARGET, target.visible);
    texels(ENSEMBLE_BINDING_RASTER_INDICES, assets_.indexChunk(pair.index_chunk).texels);
    texels(ENSEMBLE_BINDING_RASTER_POSES, poses_.buffers()[i / items_.pairs().size()].texels);
    texels(ENSEMBLE_BINDING_RASTER_VERTICES, assets_.vertexChunk(pair.vertex_chunk).texels);
    texels(ENSEMBLE_BINDING_RASTER_ITEMS, items_.view());
    texels(ENSEMBLE_BINDING_RASTER_SHOWN, items_.shownView());
    texels(ENSEMBLE_BINDING_RASTER_POSE_TABLE, poses_.table());
    texels(ENSEMBLE_BINDING_RASTER_MATERIALS, materials_view_);
    texels(ENSEMBLE_BINDING_RASTER_TINTS, tints_view_);
    buffer(ENSEMBLE_BINDING_RASTER_PIXELS, target.pixels);
    buffer(ENSEMBLE_BINDING_RASTER_BINS, target.bins);
    const auto readable = vk::ImageLayout::eShaderReadOnlyOptimal;
    gpu::writeImage(device_, set, ENSEMBLE_BINDING_RASTER_DEPTH, depth, &sampler_, readable);
    const gpu::Image& drawn = targets.samples ? targets.samples : targets.linear;
    gpu::writeImage(device_, set, ENSEMBLE_BINDING_RASTER_DRAWN, drawn, &sampler_, readable);
    buffer(ENSEMBLE_BINDING_RASTER_SHADED, target.shaded);
    texels(ENSEMBLE_BINDING_RASTER_SEEN, target.seen_view);
    texels(ENSEMBLE_BINDING_RASTER_LISTED, target.listed_view);
    gpu::writeImage(device_, set, ENSEMBLE_BINDING_RASTER_PICTURE, targets.linear, nullptr,
                    vk::ImageLayout::eGeneral);
  }
}

ComputeRaster::Push ComputeRaster::pushFor(const Target& target, float near_plane) const {
  return {.face_bits = workOf(eyeOf(target.pass)).plan->faceBits(),
          .width = target.width,
          .height = target.height,
          .near_plane = near_plane,
          .bin = static_cast<std::uint32_t>(items_.bins().size()),
          .bin_count = binCount()};
}

std::uint32_t ComputeRaster::hasWideIndices(std::uint32_t pair) const {
  return assets_.indexChunk(items_.pairs()[pair].index_chunk).type == vk::IndexType::eUint32 ? 1u : 0u;
}

void ComputeRaster::record(const vk::raii::CommandBuffer& commands, vk::DescriptorSet view_set,
                           const Target& target, float near_plane) {
  const bool to_sun = target.pass == Pass::kShadow;
  Work& work = workOf(eyeOf(target.pass));
  const std::vector<PlanBatch>& batches = work.plan->batches();
  gpu::recordBarrier(commands, Stage::eComputeShader | Stage::eTransfer, {}, Stage::eTransfer,
                     Access::eTransferWrite);
  commands.fillBuffer(target.visible.handle(), 0, VK_WHOLE_SIZE, 0);
  const std::uint64_t groups = work.plan->groups().size();
  if (work.plan->hasSecondRound()) {
    commands.fillBuffer(work.groups.handle(), groups * sizeof(GpuRasterGroup),
                        (groups - work.plan->firstLateGroup()) * sizeof(GpuRasterGroup), ENSEMBLE_NO_WORK);
  }
  gpu::recordBarrier(commands, Stage::eTransfer, Access::eTransferWrite, Stage::eComputeShader,
                     Access::eShaderStorageRead | Access::eShaderStorageWrite);
  Push push = pushFor(target, to_sun ? kShadowSlopeBias : near_plane);
  std::size_t next = 0;
  for (; next < batches.size() && !batches[next].is_late; ++next) {
    recordBatch(commands, view_set, target, batches[next], push);
    gpu::recordDispatch(commands, batches[next].group_count);
  }
  if (next < batches.size()) recordOcclusion(commands, target, near_plane, work);
  for (; next < batches.size(); ++next) {
    PlanBatch picked = batches[next];
    picked.first_group = firstPickedGroup(*work.plan, picked);
    recordBatch(commands, view_set, target, picked, push);
    commands.dispatchIndirect(work.batches.handle(),
                              next * sizeof(GpuRasterBatch) + offsetof(GpuRasterBatch, groups_x));
  }
  gpu::recordBarrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite,
                     Stage::eComputeShader | Stage::eTransfer | Stage::eHost,
                     Access::eShaderStorageRead | Access::eTransferRead | Access::eHostRead);
}

void ComputeRaster::recordBatch(const vk::raii::CommandBuffer& commands, vk::DescriptorSet view_set,
                                const Target& target, const PlanBatch& batch, Push& push) const {
  const RasterItems::State& state = items_.states()[batch.state];
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *rasterPipeline(target, state));
  const std::array<vk::DescriptorSet, 4> sets = {
      view_set, target.sets[batch.pose_buffer * items_.pairs().size() + state.pair],
      layout_.assetSet(items_.pairs()[state.pair].index_chunk), assets_.textures().set(state.texture_set)};
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *pipeline_layout_, ENSEMBLE_SET_VIEW, sets,
                              nullptr);
  push.first_group = batch.first_group;
  push.group_count = batch.group_count;
  push.wide_indices = hasWideIndices(state.pair);
  commands.pushConstants<Push>(*pipeline_layout_, vk::ShaderStageFlagBits::eCompute, 0, push);
}

void ComputeRaster::recordOcclusion(const vk::raii::CommandBuffer& commands, const Target& target,
                                    float near_plane, Work& work) const {
  const std::span<GpuRasterBatch> batches = work.batches.mapped<GpuRasterBatch>();
  std::fill(batches.begin(), batches.end(), GpuRasterBatch{});
  for (std::size_t i = 0; i < work.plan->batches().size(); ++i)
    batches[i].first_group = firstPickedGroup(*work.plan, work.plan->batches()[i]);
  occlusion_.record(commands, target.occlusion,
                    {.plan = *work.plan,
                     .triangles_per_group = device_.subgroupSize() * ENSEMBLE_RASTER_RUN,
                     .near_plane = near_plane,
                     .hides = target.pass != Pass::kOverdraw,
                     .drawn_hides = work.drawn_hides});
}

void ComputeRaster::recordShadowMap(const vk::raii::CommandBuffer& commands, const ViewTargets& targets,
                                    const Target& target) {
  commands.copyBufferToImage(
      target.visible.handle(), targets.shadow_map.handle(), vk::ImageLayout::eTransferDstOptimal,
      vk::BufferImageCopy{
          .imageSubresource = {.aspectMask = vk::ImageAspectFlagBits::eDepth, .layerCount = 1},
          .imageExtent = {target.width, target.height, 1}});
}

void ComputeRaster::recordList(const vk::raii::CommandBuffer& commands, vk::DescriptorSet view_set,
                               const Target& target, const Push& push) const {
  gpu::recordBarrier(commands, Stage::eComputeShader | Stage::eDrawIndirect, {}, Stage::eTransfer,
                     Access::eTransferWrite);
  commands.fillBuffer(target.bins.handle(), 0, VK_WHOLE_SIZE, 0);
  gpu::recordBarrier(commands, Stage::eTransfer, Access::eTransferWrite, Stage::eComputeShader,
                     Access::eShaderStorageRead | Access::eShaderStorageWrite);
  const std::array<vk::DescriptorSet, 2> sets = {view_set, target.sets[0]};
  commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *pipeline_layout_, ENSEMBLE_SET_VIEW, sets,
                              nullptr);
  commands.pushConstants<Push>(*pipeline_layout_, vk::ShaderStageFlagBits::eCompute, 0, push);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *sampled(target).list);
  gpu::recordDispatch(commands, listGroups(push.pixel_count));
  gpu::recordComputeBarrier(commands);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *count_bins_);
  commands.dispatch(1, 1, 1);
  gpu::recordComputeBarrier(commands);
  commands.bindPipeline(vk::PipelineBindPoint::eCompute, *sort_);
  commands.dispatchIndirect(target.bins.handle(), std::uint64_t{push.bin_count} * sizeof(GpuRasterBin) +
                                                      offsetof(GpuRasterBin, groups_x));
  gpu::recordComputeBarrier(commands);
}

template <class Bind, class Finish>
void ComputeRaster::recordBands(const vk::raii::CommandBuffer& commands, vk::DescriptorSet view_set,
                                const Target& target, float near_plane, const Bind& bind,
                                const Finish& finish) const {
  Push push = pushFor(target, near_plane);
  const std::uint32_t pixels = target.width * target.height;
  const std::uint32_t band = bandPixels(target.samples);
  for (push.first_pixel = 0; push.first_pixel < pixels; push.first_pixel += band) {
    push.pixel_count = std::min(band, pixels - push.first_pixel);
    recordList(commands, view_set, target, push);
    Push own = push;
    for (own.bin = 0; own.bin < push.bin_count; ++own.bin) {
      const RasterItems::Bin& bin = items_.bins()[own.bin % items_.bins().size()];
      own.wide_indices = hasWideIndices(bin.pair);
      bind(bin, target.sets[own.bin / items_.bins().size() * items_.pairs().size() + bin.pair], own);
      commands.dispatchIndirect(target.bins.handle(),
                                own.bin * sizeof(GpuRasterBin) + offsetof(GpuRasterBin, groups_x));
    }
    gpu::recordComputeBarrier(commands);
    finish(push);
  }
}

void ComputeRaster::recordColor(const vk::raii::CommandBuffer& commands, vk::DescriptorSet view_set,
                                const ViewTargets& targets, const Target& target, const View& view) const {
  gpu::recordBarrier(commands, targets.linear,
                     {.from_stage = Stage::eComputeShader | Stage::eColorAttachmentOutput,
                      .to_stage = Stage::eComputeShader,
                      .from_access = Access::eColorAttachmentWrite,
                      .to_access = Access::eShaderStorageWrite,
                      .from = vk::ImageLayout::eShaderReadOnlyOptimal,
                      .to = vk::ImageLayout::eGeneral});
  const auto bind = [&](const RasterItems::Bin& bin, vk::DescriptorSet set, const Push& push) {
    const std::uint32_t pipeline = (bin.textured ? 1u : 0u) + (view.light.shadows ? 2u : 0u);
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *sampled(target).color[pipeline]);
    const std::array<vk::DescriptorSet, 4> sets = {view_set, set,
                                                   layout_.assetSet(items_.pairs()[bin.pair].index_chunk),
                                                   assets_.textures().set(bin.texture_set)};
    commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *pipeline_layout_, ENSEMBLE_SET_VIEW, sets,
                                nullptr);
    commands.pushConstants<Push>(*pipeline_layout_, vk::ShaderStageFlagBits::eCompute, 0, push);
  };
  const auto resolve = [&](const Push& push) {
    if (target.samples == 1) return;
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *resolve_);
    commands.pushConstants<Push>(*pipeline_layout_, vk::ShaderStageFlagBits::eCompute, 0, push);
    gpu::recordDispatch(commands, listGroups(push.pixel_count));
  };
  recordBands(commands, view_set, target, view.camera.near_plane, bind, resolve);
  gpu::recordBarrier(commands, targets.linear,
                     {.from_stage = Stage::eComputeShader,
                      .to_stage = Stage::eComputeShader,
                      .from_access = Access::eShaderStorageWrite,
                      .to_access = Access::eShaderSampledRead,
                      .from = vk::ImageLayout::eGeneral,
                      .to = vk::ImageLayout::eShaderReadOnlyOptimal});
}

void ComputeRaster::recordAovs(const vk::raii::CommandBuffer& commands, vk::DescriptorSet view_set,
                               const Target& target, float near_plane) const {
  const auto bind = [&](const RasterItems::Bin& bin, vk::DescriptorSet set, const Push& push) {
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, *aov_);
    const std::array<vk::DescriptorSet, 4> sets = {
        view_set, set, layout_.assetSet(items_.pairs()[bin.pair].index_chunk), target.aov_set[0]};
    commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *aov_pipeline_layout_, ENSEMBLE_SET_VIEW,
                                sets, nullptr);
    commands.pushConstants<Push>(*aov_pipeline_layout_, vk::ShaderStageFlagBits::eCompute, 0, push);
  };
  recordBands(commands, view_set, target, near_plane, bind, [](const Push&) {});
}

}  // namespace ensemble
