// Which faces of a body no one can see under its clothes, found with rays (design 4; --occlusion auto).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/wardrobe.h"

namespace ensemble {

/// One set for all files.
struct HiddenFaceOptions {
  /// Skin through which cloth pokes counts as hidden by it while the cloth lies at most so far under it;
  /// metres.
  float tolerance = 0.01f;
  float threshold = 0.25f;    ///< a face is kept if in some pose more than this share of its samples is seen
  std::uint32_t samples = 8;  ///< points of a face, in each pose others
  std::uint32_t directions = 24;  ///< in which each is looked for, over the hemisphere
  std::uint32_t poses = 12;       ///< of each clip at most, evenly over its time, between key frames too
  unsigned jobs = 0;              ///< threads; 0: one for each core
};

/// A pose in which a body is looked at.
struct ViewedPose {
  std::uint32_t clip = 0;
  float key = 0.0f;  ///< key frames from the clip's first; may lie between two
};

struct FaceSightings {
  static constexpr std::uint32_t kNever = 0xffffffffu;
  std::vector<ViewedPose> poses;
  PerFace<std::uint32_t>
      first_pose;  ///< per face of the template: the first of `poses` that shows it, or kNever
};

/// Looks at a dressed body in all its clips (in the bind pose, where there are none). From points of every
/// face rays go out over the hemisphere; a face is seen where one meets neither cloth nor body. What only
/// hidden faces hide counts as seen. Deterministic, whatever the number of threads.
FaceSightings findSightings(const TemplateBody& body, std::span<const Item* const> items,
                            const HiddenFaceOptions& options);

}  // namespace ensemble
