// ComputeRaster's work on the host: who is drawn in which pose, and what shaders read of it.
#include <fmt/format.h>

#include <algorithm>

#include "core/input_error.h"
#include "renderer/compute_raster.h"

namespace ensemble {

void ComputeRaster::plan(Eye eye, const ScreenRows& rows, const CrowdState& state, const ViewPeople& shown,
                         std::span<const std::uint32_t> numbers) {
  Work& work = workOf(eye);
  work.people.clear();
  work.own.clear();
  const auto key_count = static_cast<std::uint32_t>(state.keyFrames().keys.size());
  for (const std::uint32_t number : numbers) {
    std::uint32_t key = shown.key(number);
    if (key == ViewPeople::kExact) {
      key = key_count + static_cast<std::uint32_t>(work.own.size());
      work.own.push_back({state.combinations()[number], poses_.requireOwn(number)});
    }
    work.people.push_back({state.combinations()[number], key});
  }
  if (work.people.empty()) return;
  planWork(work, state);
  upload(work, rows, state, numbers);
}

void ComputeRaster::planWork(Work& work, const CrowdState& state) {
  const auto key_count = static_cast<std::uint32_t>(state.keyFrames().keys.size());
  const auto pose_of = [&](std::uint32_t mesh, std::uint32_t key) -> PlanPose {
    if (key < key_count) return poses_.require(mesh, key);
    const OwnPerson& own = work.own[key - key_count];
    return {own.pose.buffer, own.pose.first_vertex + poses_.firstOwnVertex(own.combination, mesh)};
  };
  work.plan->build(work.people, key_count + static_cast<std::uint32_t>(work.own.size()),
                   work.plan->faceBits(), pose_of);
}

void ComputeRaster::upload(Work& work, const ScreenRows& rows, const CrowdState& state,
                           std::span<const std::uint32_t> numbers) {
  using Usage = vk::BufferUsageFlagBits;
  const auto grow = [&](gpu::Buffer& buffer, std::uint64_t bytes, vk::BufferUsageFlags usage) {
    if (buffer && bytes <= buffer.size()) return false;
    const std::uint64_t most = device_.limits().maxStorageBufferRange;
    if (bytes > most) {
      throw SystemError(
          {.file = {},
           .where = "Vulkan device " + device_.name(),
           .what = fmt::format("the work of the compute rasteriser needs {}, one buffer holds {}",
                               gpu::describeBytes(bytes), gpu::describeBytes(most)),
           .mend = "use fewer people, or set raster to pipeline"});
    }
    ++work.number;
    buffer = gpu::Buffer(device_, std::min(bytes + bytes / 2, most), usage, gpu::Buffer::Kind::kUpload,
                         "the work of the rasteriser");
    return true;
  };
  const auto copy = [&](gpu::Buffer& buffer, const auto& values) {
    using Value = typename std::remove_cvref_t<decltype(values)>::value_type;
    grow(buffer, values.size() * sizeof(Value), Usage::eStorageBuffer);
    std::copy(values.begin(), values.end(), buffer.mapped<Value>().begin());
  };
  copy(work.entries, work.plan->entries());
  copy(work.work, work.plan->work());
  copy(work.groups, work.plan->groups());
  if (grow(work.rows, numbers.size() * sizeof(GpuRasterPerson), Usage::eUniformTexelBuffer))
    work.rows_view = work.rows.makeTexelView(device_);
  if (grow(work.who, numbers.size() * sizeof(GpuRasterWho), Usage::eUniformTexelBuffer))
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

}  // namespace ensemble
