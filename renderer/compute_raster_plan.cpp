// ComputeRaster's work on the host: who is drawn in which pose, and what shaders read of it.
#include <fmt/format.h>

#include <algorithm>

#include "core/input_error.h"
#include "renderer/compute_raster.h"

namespace ensemble {
namespace {

using Usage = vk::BufferUsageFlagBits;

}  // namespace

bool ComputeRaster::arrange(Eye eye, const ScreenRows& rows, const CrowdState& state, const ViewPeople& shown,
                            std::span<const std::uint32_t> numbers, const Occlusion& occlusion) {
  Work& work = workOf(eye);
  work.people.clear();
  work.own.clear();
  const auto key_count = static_cast<std::uint32_t>(state.keyFrames().keys.size());
  for (const std::uint32_t number : numbers) {
    std::uint32_t key = shown.key(number);
    if (key == ViewPeople::kExact) {
      key = key_count + static_cast<std::uint32_t>(work.own.size());
      work.own.push_back({number, state.combinations()[number], {}});
    }
    work.people.push_back({state.combinations()[number], key});
  }
  if (work.people.empty()) return true;
  work.drawn_hides = occlusion.drawn_hides;
  if (occlusion.is_on) chooseRounds(work, rows, state, numbers);
  work.plan->arrange(work.people, key_count + static_cast<std::uint32_t>(work.own.size()),
                     work.plan->faceBits());
  const bool fits = workBytes(work) <= options_.work_bytes;
  if (!fits) work.people.clear();
  return fits;
}

void ComputeRaster::plan(Eye eye, const ScreenRows& rows, const CrowdState& state, const ViewPeople& shown,
                         std::span<const std::uint32_t> numbers) {
  Work& work = workOf(eye);
  if (work.people.empty()) return;
  placeWork(work, state);
  upload(work, rows, state, numbers);
  uploadOccludees(work, rows, state, shown, numbers);
}

std::uint64_t ComputeRaster::workBytes(const Work& work) const {
  const RasterPlan& plan = *work.plan;
  return std::max({(plan.entries().size() + plan.pickedCount()) * sizeof(std::uint32_t),
                   plan.work().size() * sizeof(GpuRasterWork),
                   (plan.groupCount() + plan.lateGroupCount()) * sizeof(GpuRasterGroup),
                   work.people.size() * std::max({sizeof(GpuRasterPerson), sizeof(GpuRasterWho),
                                                  plan.lateGroupCount() > 0 ? sizeof(GpuOccludee) : 0})});
}

void ComputeRaster::refuseWork() const {
  throw SystemError({.file = {},
                     .where = "Vulkan device " + device_.name(),
                     .what = fmt::format("the work of the compute rasteriser needs more than the {} that one "
                                         "buffer holds",
                                         gpu::describeBytes(options_.work_bytes)),
                     .mend = "use fewer people, or set raster to auto"});
}

void ComputeRaster::chooseRounds(Work& work, const ScreenRows& rows, const CrowdState& state,
                                 std::span<const std::uint32_t> numbers) {
  distances_.clear();
  for (const std::uint32_t number : numbers) {
    const Vec3& center = state.bounds()[number].center;
    distances_.push_back(static_cast<float>(glm::dot(rows.z, glm::dvec4(glm::dvec3(center), 1.0))));
  }
  sorted_distances_.assign(distances_.begin(), distances_.end());
  const float from = secondRoundDistance(sorted_distances_);
  for (std::size_t i = 0; i < numbers.size(); ++i) work.people[i].is_late = distances_[i] > from;
}

void ComputeRaster::placeWork(Work& work, const CrowdState& state) {
  for (OwnPerson& own : work.own) own.pose = poses_.requireOwn(own.number);
  const auto key_count = static_cast<std::uint32_t>(state.keyFrames().keys.size());
  const auto pose_of = [&](std::uint32_t mesh, std::uint32_t key) -> PlanPose {
    if (key < key_count) return poses_.require(mesh, key);
    const OwnPerson& own = work.own[key - key_count];
    return {own.pose.buffer, own.pose.first_vertex + poses_.firstOwnVertex(own.combination, mesh)};
  };
  work.plan->place(pose_of);
}

bool ComputeRaster::grow(Work& work, gpu::Buffer& buffer, std::uint64_t bytes, vk::BufferUsageFlags usage) {
  if (buffer && bytes <= buffer.size()) return false;
  ++work.number;
  const std::uint64_t with_spare = std::min(bytes + bytes / 2, options_.work_bytes);
  buffer = gpu::Buffer(device_, std::max(bytes, with_spare), usage, gpu::Buffer::Kind::kUpload,
                       "the work of the rasteriser");
  return true;
}

void ComputeRaster::upload(Work& work, const ScreenRows& rows, const CrowdState& state,
                           std::span<const std::uint32_t> numbers) {
  const auto copy = [&](gpu::Buffer& buffer, const auto& values, std::size_t room) {
    using Value = typename std::remove_cvref_t<decltype(values)>::value_type;
    grow(work, buffer, room * sizeof(Value), Usage::eStorageBuffer | Usage::eTransferDst);
    std::copy(values.begin(), values.end(), buffer.mapped<Value>().begin());
  };
  // With a second round the device writes behind these what it picks.
  const RasterPlan& plan = *work.plan;
  copy(work.entries, plan.entries(), plan.entries().size() + plan.pickedCount());
  copy(work.work, plan.work(), plan.work().size());
  copy(work.groups, plan.groups(), 2 * plan.groups().size() - plan.firstLateGroup());
  if (grow(work, work.rows, numbers.size() * sizeof(GpuRasterPerson), Usage::eUniformTexelBuffer))
    work.rows_view = work.rows.makeTexelView(device_);
  if (grow(work, work.who, numbers.size() * sizeof(GpuRasterWho), Usage::eUniformTexelBuffer))
    work.who_view = work.who.makeTexelView(device_, vk::Format::eR32G32B32A32Uint);
  const std::span<GpuRasterPerson> all_rows = work.rows.mapped<GpuRasterPerson>();
  const std::span<GpuRasterWho> all_who = work.who.mapped<GpuRasterWho>();
  const KeyFrames& frames = state.keyFrames();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const GpuCharacter& character = state.characters()[numbers[i]];
    std::uint32_t pose = work.people[i].key;
    if (pose < frames.keys.size()) {
      const KeptBox& box = frames.boxes[frames.keys[pose].clip];
      all_rows[i] = makeRasterPerson(rows, character.world_from_model, box);
    } else {
      const PlanPose& own = work.own[pose - frames.keys.size()].pose;
      pose = ENSEMBLE_OWN_POSE | own.buffer << ENSEMBLE_POSE_OFFSET_BITS | own.first_vertex;
      const PosePool::OwnPlace place = poses_.ownPlace(numbers[i]);
      all_rows[i] = makeRasterPerson(rows, place.world_from_box, place.box);
    }
    all_who[i] = {character.combination, pose, character.tint_seed, character.number};
  }
}

void ComputeRaster::uploadOccludees(Work& work, const ScreenRows& rows, const CrowdState& state,
                                    const ViewPeople& shown, std::span<const std::uint32_t> numbers) {
  const std::size_t people = work.plan->hasSecondRound() ? numbers.size() : 0;
  if (grow(work, work.occludees, std::max<std::size_t>(people, 1) * sizeof(GpuOccludee),
           Usage::eUniformTexelBuffer))
    work.occludees_view = work.occludees.makeTexelView(device_);
  grow(work, work.batches, work.plan->batches().size() * sizeof(GpuRasterBatch),
       Usage::eStorageBuffer | Usage::eIndirectBuffer);
  const std::span<GpuOccludee> all = work.occludees.mapped<GpuOccludee>();
  const KeyFrames& frames = state.keyFrames();
  for (std::size_t i = 0; i < people; ++i) {
    const GpuCharacter& character = state.characters()[numbers[i]];
    // Legs that are bent may leave the boxes.
    const bool holds_feet = shown.key(numbers[i]) == ViewPeople::kExact &&
                            (character.feet[0].w > 0.0f || character.feet[1].w > 0.0f);
    const auto next =
        std::upper_bound(frames.clip_of_wardrobe.begin(), frames.clip_of_wardrobe.end(), character.clip);
    const ClipRange clips{*(next - 1), *next - *(next - 1)};
    all[i] = makeOccludee(rows, character, clips, !holds_feet);
  }
}

}  // namespace ensemble
