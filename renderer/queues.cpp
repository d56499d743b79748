// Lister, Laycock and Day, "Geometric Diversity for Crowds on the GPU", section 4 and table 1.
//
// Departure: the paper appends to a list per sub-mesh. Counting first gives every queue its place
// in one array, and counting combinations instead of sub-meshes leaves one increment a character.
#include "renderer/queues.h"

#include <algorithm>
#include <limits>

#include "core/check.h"

namespace ensemble {

void RenderQueues::setShown(std::span<const std::vector<SubMeshId>> shown, std::size_t sub_mesh_count) {
  is_counted_ = false;
  shown_.clear();
  shown_begin_.assign(1, 0);
  for (const std::vector<SubMeshId>& sub_meshes : shown) {
    for (std::size_t i = 0; i < sub_meshes.size(); ++i) {
      ENSEMBLE_CHECK(sub_meshes[i].value < sub_mesh_count);
      if (i > 0) ENSEMBLE_CHECK(sub_meshes[i - 1].value < sub_meshes[i].value);
      shown_.push_back(sub_meshes[i].value);
    }
    shown_begin_.push_back(static_cast<std::uint32_t>(shown_.size()));
  }
  combination_counts_.assign(shown.size(), 0);
  lengths_.assign(sub_mesh_count, 0);
  offsets_.assign(sub_mesh_count, 0);
  cursors_.assign(sub_mesh_count, 0);
  entry_count_ = 0;
}

void RenderQueues::startCounting(std::span<const std::uint32_t> combination_of_character) {
  is_counted_ = false;
  combination_of_character_ = combination_of_character;
  std::fill(combination_counts_.begin(), combination_counts_.end(), 0u);
  std::fill(lengths_.begin(), lengths_.end(), 0u);
}

void RenderQueues::finishCounting() {
  for (std::size_t c = 0; c < combination_counts_.size(); ++c) {
    const std::uint32_t wearers = combination_counts_[c];
    if (wearers == 0) continue;
    for (std::uint32_t i = shown_begin_[c]; i < shown_begin_[c + 1]; ++i) lengths_[shown_[i]] += wearers;
  }
  std::uint64_t sum = 0;
  for (std::size_t s = 0; s < lengths_.size(); ++s) {
    offsets_[s] = static_cast<std::uint32_t>(sum);
    sum += lengths_[s];
  }
  ENSEMBLE_CHECK(sum <= std::numeric_limits<std::uint32_t>::max());
  entry_count_ = static_cast<std::uint32_t>(sum);
  is_counted_ = true;
}

void RenderQueues::count(std::span<const std::uint32_t> combination_of_character,
                         std::span<const std::uint32_t> visible) {
  startCounting(combination_of_character);
  const std::size_t combination_count = combination_counts_.size();
  std::uint64_t next = 0;  // the least number that the next visible character may have
  for (const std::uint32_t character : visible) {
    if (character < next || character >= combination_of_character.size()) [[unlikely]] {
      ENSEMBLE_CHECK(character >= next);  // ascending, each once
      ENSEMBLE_CHECK(character < combination_of_character.size());
    }
    next = std::uint64_t{character} + 1;
    const std::uint32_t combination = combination_of_character[character];
    if (combination >= combination_count) [[unlikely]]
      ENSEMBLE_CHECK(combination < combination_count);
    ++combination_counts_[combination];
  }
  visible_ = visible;
  all_visible_ = false;
  finishCounting();
}

void RenderQueues::countAll(std::span<const std::uint32_t> combination_of_character) {
  startCounting(combination_of_character);
  const std::size_t combination_count = combination_counts_.size();
  for (const std::uint32_t combination : combination_of_character) {
    if (combination >= combination_count) [[unlikely]]
      ENSEMBLE_CHECK(combination < combination_count);
    ++combination_counts_[combination];
  }
  visible_ = {};
  all_visible_ = true;
  finishCounting();
}

template <bool kAll>
void RenderQueues::append(std::span<std::uint32_t> entries) {
  const std::size_t count = kAll ? combination_of_character_.size() : visible_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t character = kAll ? static_cast<std::uint32_t>(i) : visible_[i];
    const std::uint32_t combination = combination_of_character_[character];
    const std::uint32_t end = shown_begin_[combination + 1];
    for (std::uint32_t s = shown_begin_[combination]; s < end; ++s) {
      entries[cursors_[shown_[s]]++] = character;
    }
  }
}

void RenderQueues::fill(std::span<std::uint32_t> entries) {
  ENSEMBLE_CHECK(is_counted_);
  ENSEMBLE_CHECK(entries.size() == entry_count_);
  is_counted_ = false;
  std::copy(offsets_.begin(), offsets_.end(), cursors_.begin());
  if (all_visible_) {
    append<true>(entries);
  } else {
    append<false>(entries);
  }
}

std::span<const std::uint32_t> RenderQueues::build(std::span<const std::uint32_t> combination_of_character,
                                                   std::span<const std::uint32_t> visible) {
  count(combination_of_character, visible);
  if (own_entries_.size() < entry_count_) own_entries_.resize(entry_count_);
  const std::span<std::uint32_t> entries(own_entries_.data(), entry_count_);
  fill(entries);
  return entries;
}

}  // namespace ensemble
