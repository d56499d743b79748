// Which faces of a body no one can see under its clothes, found with rays (design 4; --occlusion auto).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/wardrobe.h"

namespace ensemble {

/// One set for all files.
struct HiddenFaceOptions {
  /// Skin through which cloth pokes counts as covered while the cloth lies at most so far under it; metres.
  float tolerance = 0.01f;
  /// A face is kept if leaving it out would open a larger hole than these: in some pose, more than this
  /// share of the face, as it is seen from all sides together;
  float hole_share = 0.25f;
  /// or more than this area, as it is seen on average from all sides and in all poses; square metres.
  float hole_area = 12.0e-6f;
  std::uint32_t patch = 6;        ///< so few faces that differ from all around them go with those
  std::uint32_t samples = 8;      ///< points of a face, in each pose others
  std::uint32_t directions = 24;  ///< in which each is looked for, over the hemisphere
  std::uint32_t poses = 12;       ///< of each clip at most, evenly over its time, between key frames too
  unsigned jobs = 0;              ///< threads; 0: one for each core
};

/// A pose in which a body is looked at.
struct ViewedPose {
  std::uint32_t clip = 0;
  float key = 0.0f;  ///< key frames from the clip's first; may lie between two
};

/// The hole that a face would leave behind.
struct FaceHole {
  static constexpr std::uint32_t kNoPose = 0xffffffffu;
  float share = 0.0f;            ///< HiddenFaceOptions::hole_share, of the pose where it is largest
  float area = 0.0f;             ///< HiddenFaceOptions::hole_area, over the poses looked at
  std::uint32_t pose = kNoPose;  ///< where the share is largest; kNoPose: there is no hole in any
  bool is_kept = false;          ///< too large a hole, or a pinhole
  /// Much too large a hole; no further pose was looked at then.
  bool is_plain = false;

  bool operator==(const FaceHole&) const = default;
};

struct FaceHoles {
  std::vector<ViewedPose> poses;
  PerFace<FaceHole> faces;  ///< #F of the template
};

/// Looks at a dressed body in all its clips (in the bind pose, where there are none). From points of every
/// face rays go out over the hemisphere. Where one meets neither cloth nor body, the point is seen; it
/// would be missed if no cloth lies close under it, be it along the normal or along the ray. The shares of
/// such rays, weighted by the cosine to the normal as areas in pictures are, make the hole.
/// Up to options.patch faces that are kept, none of them plainly, amid left out ones are left out too; as few
/// left out amid kept ones are kept.
/// Deterministic, whatever the number of threads.
FaceHoles findHoles(const TemplateBody& body, std::span<const Item* const> items,
                    const HiddenFaceOptions& options);

}  // namespace ensemble
