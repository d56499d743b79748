// Which faces of a body no one can see under its clothes, found with rays (design 4; --occlusion auto).
#pragma once

#include <cstdint>
#include <mutex>
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
  std::uint32_t patch = 6;    ///< so few faces that differ from all around them go with those
  std::uint32_t samples = 8;  ///< points of a face, in each pose others
  std::uint32_t scouts = 0;   ///< where so many points show nothing in a pose, the others are left; 0: never
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
  float share = 0.0f;              ///< HiddenFaceOptions::hole_share, of the pose where it is largest
  float area = 0.0f;               ///< HiddenFaceOptions::hole_area, over the poses looked at
  std::uint32_t pose = kNoPose;    ///< where the share is largest; kNoPose: there is no hole in any
  bool is_kept = false;            ///< too large a hole, a pinhole, or of a bare region
  bool is_in_bare_region = false;  ///< kept only because clothes hide nothing of its region
  /// Much too large a hole; no further pose was looked at then.
  bool is_plain = false;

  bool operator==(const FaceHole&) const = default;
};

struct FaceHoles {
  std::vector<ViewedPose> poses;
  PerFace<FaceHole> faces;  ///< of what was looked at: #F of the template, or of an item's garments
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

/// The same of an item's garments, worn on the body, alone or under another item (design 4): it would be
/// missed if no cloth of the other lies close under it. Both sides of double-sided cloth are looked at; a
/// hole is then that of both together.
/// @return faces are numbered through all parts of all garments
FaceHoles findHolesOf(const Item& inner, const TemplateBody& body, const HiddenFaceOptions& options);
/// @param alone what the line above gives: faces that no one sees without the outer item are not looked at
/// again
FaceHoles findHolesUnder(const Item& inner, const Item& outer, const TemplateBody& body,
                         const FaceHoles& alone, const HiddenFaceOptions& options);

/// The holes of a body that wears nothing: looked for once, by the first who asks, from any thread.
class BareBody {
 public:
  /// @param body outlives this
  BareBody(const TemplateBody& body, const HiddenFaceOptions& options) : body_(body), options_(options) {}
  const FaceHoles& holes();

 private:
  const TemplateBody& body_;
  HiddenFaceOptions options_;
  std::once_flag looked_;
  FaceHoles holes_;
};

}  // namespace ensemble
