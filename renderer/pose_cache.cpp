#include "renderer/pose_cache.h"

#include <iterator>

#include "core/check.h"

namespace ensemble {

void PoseCache::beginFrame() {
  ++frame_;
  stats_.hits = stats_.misses = 0;
  while (stats_.kept_vertices > limits_.budget_vertices) dropOldest();
}

void PoseCache::clear() {
  while (!by_use_.empty()) dropOldest();
}

KeptPose PoseCache::require(std::uint32_t pose, std::uint32_t vertex_count) {
  ENSEMBLE_CHECK(vertex_count > 0 && vertex_count <= limits_.buffer_vertices);
  const auto [found, is_new] = entries_.try_emplace(pose);
  Entry& entry = found->second;
  if (is_new) {
    ++stats_.misses;
    entry.count = vertex_count;
    // Of what earlier frames left only as much as is in the way goes.
    const auto has_old = [&] { return !by_use_.empty() && entries_.at(by_use_.front()).frame < frame_; };
    const auto within_budget = [&] { return stats_.kept_vertices + vertex_count <= limits_.budget_vertices; };
    while (!within_budget() && has_old()) dropOldest();
    if (!place(entry)) {
      free_.push_back({{0u, limits_.buffer_vertices}});
      ENSEMBLE_CHECK(place(entry));
    }
    stats_.kept_vertices += vertex_count;
    entry.use = by_use_.insert(by_use_.end(), pose);
  } else {
    ENSEMBLE_CHECK(entry.count == vertex_count);
    if (entry.frame != frame_) ++stats_.hits;
    by_use_.splice(by_use_.end(), by_use_, entry.use);
  }
  entry.frame = frame_;
  return {entry.buffer, entry.first, is_new};
}

bool PoseCache::place(Entry& entry) {
  for (std::uint32_t buffer = 0; buffer < free_.size(); ++buffer) {
    FreeRanges& ranges = free_[buffer];
    for (auto range = ranges.begin(); range != ranges.end(); ++range) {
      const auto [first, count] = *range;
      if (count < entry.count) continue;
      ranges.erase(range);
      if (count > entry.count) ranges.emplace(first + entry.count, count - entry.count);
      entry.buffer = buffer;
      entry.first = first;
      return true;
    }
  }
  return false;
}

void PoseCache::dropOldest() {
  const auto found = entries_.find(by_use_.front());
  const Entry& entry = found->second;
  FreeRanges& ranges = free_[entry.buffer];
  auto range = ranges.emplace(entry.first, entry.count).first;
  const auto next = std::next(range);
  if (next != ranges.end() && range->first + range->second == next->first) {
    range->second += next->second;
    ranges.erase(next);
  }
  if (range != ranges.begin()) {
    const auto before = std::prev(range);
    if (before->first + before->second == range->first) {
      before->second += range->second;
      ranges.erase(range);
    }
  }
  stats_.kept_vertices -= entry.count;
  by_use_.pop_front();
  entries_.erase(found);
}

}  // namespace ensemble
