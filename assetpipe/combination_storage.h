// What combinations of items store: each visible body by its regions (tagged), or whole (pre-fitted).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/slots.h"
#include "core/sub_mesh_lists.h"
#include "core/wardrobe.h"

namespace ensemble {

/// Bytes are of the lists that the renderer draws (buildSubMeshLists), added up without making them.
struct CombinationStorage {
  std::uint64_t visible_bodies = 0;        ///< distinct sets of visible body faces
  std::uint64_t dedicated_sub_meshes = 0;  ///< distinct lists of a region that shows in part
  std::uint64_t lower_bound_bytes = 0;     ///< the template and each item once
  std::uint64_t tagged_bytes = 0;          ///< and the dedicated sub-meshes
  std::uint64_t prefitted_bytes = 0;       ///< each item once, and a body for each distinct visible set

  CombinationStorage& operator+=(const CombinationStorage& other);
};

/// @pre combinations are valid; equal ones count once
CombinationStorage storeCombinations(const Wardrobe& wardrobe, std::span<const Combination> combinations);

/// All combinations that dress a person.
struct WardrobeCombinations {
  PerSlot<std::uint64_t> items;        ///< of the wardrobe, by slot
  std::optional<std::uint64_t> count;  ///< none: 2^64 or more
  /// None where there are more than kMostVisibleBodies.
  std::optional<CombinationStorage> stored;
};
inline constexpr std::size_t kMostVisibleBodies = 100'000;

/// Combinations are multiplied, not listed: what is listed are the distinct visible bodies, slot by slot.
WardrobeCombinations countWardrobe(const Wardrobe& wardrobe, std::size_t most_bodies = kMostVisibleBodies);

}  // namespace ensemble
