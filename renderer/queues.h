// Render queues: for each sub-mesh the characters that show it (design 5).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ids.h"

namespace ensemble {

/// Builds the queues of one view's frame on the CPU, in two passes, so that the second can write
/// straight into mapped memory:
///
///     queues.setShown(lists.shown, lists.sub_meshes.size());   // once per scene
///     queues.count(combination_of_character, visible);          // each frame and view
///     queues.fill(mapped.first(queues.entryCount()));
///     // queue of sub-mesh s: entries[offsets()[s] .. offsets()[s] + lengths()[s])
///
/// Each queue holds character numbers ascending, so that a picture never depends on how the queues
/// were made (design 8). Costs O(characters + combinations x sub-meshes + entries). Buffers only
/// grow: nothing is allocated once the largest counts have been seen. Not thread-safe; one object
/// per view.
class RenderQueues {
 public:
  /// @param shown per combination its sub-meshes, each ascending and below `sub_mesh_count`
  void setShown(std::span<const std::vector<SubMeshId>> shown, std::size_t sub_mesh_count);

  /// Counts. Both arrays must stay as they are until fill().
  /// @param combination_of_character #characters, each an index into `shown`
  /// @param visible numbers of the characters to draw, ascending, each once
  void count(std::span<const std::uint32_t> combination_of_character, std::span<const std::uint32_t> visible);
  /// The same with every character visible.
  void countAll(std::span<const std::uint32_t> combination_of_character);

  /// Writes all queues one after the other, each word once. @pre count() came before, and
  /// `entries` has entryCount() words.
  void fill(std::span<std::uint32_t> entries);

  /// count() and fill() into storage of its own, which lives until the next build().
  std::span<const std::uint32_t> build(std::span<const std::uint32_t> combination_of_character,
                                       std::span<const std::uint32_t> visible);

  std::uint32_t entryCount() const { return entry_count_; }            ///< sum of all lengths
  std::span<const std::uint32_t> lengths() const { return lengths_; }  ///< #sub-meshes
  /// Exclusive prefix sums of lengths(), #sub-meshes: where each queue begins.
  std::span<const std::uint32_t> offsets() const { return offsets_; }
  /// Visible characters of each combination, #combinations.
  std::span<const std::uint32_t> charactersPerCombination() const { return combination_counts_; }

 private:
  void startCounting(std::span<const std::uint32_t> combination_of_character);
  void finishCounting();
  template <bool kAll>
  void append(std::span<std::uint32_t> entries);

  // What each combination shows, in one array: shown_[shown_begin_[c] .. shown_begin_[c + 1]).
  std::vector<std::uint32_t> shown_begin_{0};
  std::vector<std::uint32_t> shown_;
  std::vector<std::uint32_t> combination_counts_, lengths_, offsets_, cursors_;
  std::vector<std::uint32_t> own_entries_;
  std::uint32_t entry_count_ = 0;

  // What count() saw, for fill().
  std::span<const std::uint32_t> combination_of_character_, visible_;
  bool all_visible_ = false, is_counted_ = false;
};

}  // namespace ensemble
