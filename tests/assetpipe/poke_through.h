// How much skin comes through the clothes that cover it at rest, vertex by vertex, at rest and in motion.
#pragma once

#include <cstddef>

#include "core/raw_asset.h"

namespace ensemble::testing {

/// A vertex that lies under cloth at rest pokes when it stands out of it by more than 2 mm.
struct PokeThrough {
  std::size_t at_rest = 0;    ///< vertices that do without any motion
  std::size_t looked_at = 0;  ///< covered vertices, times key frames of all clips
  std::size_t poking = 0;     ///< of these
};

/// Hair and hats left out. @param person the template with its clips @param outfit its first node is the body
PokeThrough countPokeThrough(const RawAsset& person, const RawAsset& outfit);

}  // namespace ensemble::testing
