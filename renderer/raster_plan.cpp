#include "renderer/raster_plan.h"

#include <algorithm>
#include <bit>

#include "core/check.h"

namespace ensemble {

RasterPlan::RasterPlan(std::vector<PlanItem> items, std::vector<std::vector<ShownItem>> shown,
                       std::uint32_t triangles_per_group)
    : items_(std::move(items)),
      shown_(std::move(shown)),
      triangles_per_group_(triangles_per_group),
      item_first_(items_.size()),
      item_count_(items_.size()) {
  ENSEMBLE_CHECK(triangles_per_group > 0);
  std::uint32_t most_faces = 1;
  for (const std::vector<ShownItem>& items_of_one : shown_) {
    if (items_of_one.empty()) continue;
    const ShownItem& last = items_of_one.back();
    most_faces = std::max(most_faces, last.first_face + items_[last.item].work.triangle_count);
  }
  face_bits_ = std::max<std::uint32_t>(1, static_cast<std::uint32_t>(std::bit_width(most_faces - 1)));
}

void RasterPlan::sortByKey(std::span<const PlanPerson> people, std::uint32_t key_count) {
  // The second round's keys follow the first one's.
  const auto block_of = [&](const PlanPerson& person) {
    return person.is_late ? key_count + person.key : person.key;
  };
  const bool has_late = std::any_of(people.begin(), people.end(), [](const auto& p) { return p.is_late; });
  key_cursors_.assign(has_late ? 2 * std::size_t{key_count} : key_count, 0u);
  for (const PlanPerson& person : people) ++key_cursors_[block_of(person)];
  blocks_.clear();
  std::uint32_t first = 0;
  for (std::uint32_t key = 0; key < key_cursors_.size(); ++key) {
    const std::uint32_t count = key_cursors_[key];
    if (count > 0) blocks_.push_back({key, first, count});
    key_cursors_[key] = first;
    first += count;
  }
  by_key_.resize(people.size());
  for (std::uint32_t i = 0; i < people.size(); ++i) by_key_[key_cursors_[block_of(people[i])]++] = i;
}

void RasterPlan::arrange(std::span<const PlanPerson> people, std::uint32_t key_count,
                         std::uint32_t face_bits) {
  sortByKey(people, key_count);
  beginWork();
  for (const Block& block : blocks_) {
    const bool is_late = block.key >= key_count;
    gather(block, people, face_bits);
    for (const std::uint32_t item : touched_)
      addWork(item, is_late ? block.key - key_count : block.key, is_late);
  }
}

void RasterPlan::beginWork() {
  entries_.clear();
  work_.clear();
  work_from_.clear();
  work_batch_.clear();
  group_count_ = 0;
  late_group_count_ = 0;
  picked_count_ = 0;
  triangle_count_ = 0;
  late_triangle_count_ = 0;
}

void RasterPlan::gather(const Block& block, std::span<const PlanPerson> people, std::uint32_t face_bits) {
  touched_.clear();
  const auto for_each_shown = [&](const auto& take) {
    for (std::uint32_t i = block.first; i < block.first + block.count; ++i) {
      for (const ShownItem& shown : shown_[people[by_key_[i]].combination]) take(by_key_[i], shown);
    }
  };
  for_each_shown([&](std::uint32_t, const ShownItem& shown) {
    if (item_count_[shown.item]++ == 0) touched_.push_back(shown.item);
  });
  std::sort(touched_.begin(), touched_.end());
  auto next = static_cast<std::uint32_t>(entries_.size());
  for (const std::uint32_t item : touched_) {
    item_first_[item] = next;
    next += item_count_[item];
    item_count_[item] = 0;
  }
  entries_.resize(next);
  for_each_shown([&](std::uint32_t person, const ShownItem& shown) {
    entries_[item_first_[shown.item] + item_count_[shown.item]++] = person << face_bits | shown.first_face;
  });
}

void RasterPlan::addWork(std::uint32_t item, std::uint32_t key, bool is_late) {
  const PlanItem& from = items_[item];
  const std::uint32_t people = std::exchange(item_count_[item], 0u);
  GpuRasterWork& work = work_.emplace_back(from.work);
  work.first_entry = item_first_[item];
  work.entry_count = people;
  const std::uint32_t group_count = (work.triangle_count + triangles_per_group_ - 1) / triangles_per_group_;
  work_from_.push_back({from.mesh, key});
  work_batch_.push_back({from.state, 0, is_late, 0, group_count});
  group_count_ += group_count;
  if (is_late) {
    late_group_count_ += group_count;
    // Counted from behind the entries: see finishWork(). Beyond 32 bits no buffer holds the work.
    work.first_picked = static_cast<std::uint32_t>(picked_count_);
    picked_count_ += std::uint64_t{people} * group_count;
  }
  triangle_count_ += std::uint64_t{people} * work.triangle_count;
  if (is_late) late_triangle_count_ += std::uint64_t{people} * work.triangle_count;
}

void RasterPlan::finishWork() {
  batches_.clear();
  const auto batch_of = [&](const PlanBatch& own) -> PlanBatch& {
    for (PlanBatch& batch : batches_) {
      if (batch.state == own.state && batch.pose_buffer == own.pose_buffer && batch.is_late == own.is_late)
        return batch;
    }
    return batches_.emplace_back(PlanBatch{own.state, own.pose_buffer, own.is_late, 0, 0});
  };
  // Work of the second round comes last, and so do its batches.
  for (const PlanBatch& own : work_batch_) batch_of(own).group_count += own.group_count;
  std::uint32_t first = 0;
  for (PlanBatch& batch : batches_) {
    batch.first_group = first;
    first += std::exchange(batch.group_count, 0u);
  }
  groups_.resize(first);
  const auto late = std::find_if(batches_.begin(), batches_.end(), [](const auto& b) { return b.is_late; });
  first_late_group_ = late == batches_.end() ? first : late->first_group;
  for (std::uint32_t w = 0; w < work_.size(); ++w) {
    PlanBatch& batch = batch_of(work_batch_[w]);
    GpuRasterWork& work = work_[w];
    work.batch = static_cast<std::uint32_t>(&batch - batches_.data());
    work.first_picked += static_cast<std::uint32_t>(entries_.size());
    for (std::uint32_t g = 0; g < work_batch_[w].group_count; ++g) {
      groups_[batch.first_group + batch.group_count++] = {.work = w,
                                                          .first_triangle = g * triangles_per_group_,
                                                          .first_entry = work.first_entry,
                                                          .entry_count = work.entry_count};
    }
  }
}

}  // namespace ensemble
