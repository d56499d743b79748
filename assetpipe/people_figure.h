// A person's measures: where the joints are, and how thick the body is around them.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "assetpipe/implicit_field.h"
#include "core/raw_asset.h"

namespace ensemble {

enum class Sex : std::uint8_t { kFemale, kMale };
/// About 14, 30 and 75 years.
enum class AgeGroup : std::uint8_t { kYoung, kAdult, kOld };

/// The joints of a person, in the skin's order; the same names and order for everybody. Of paired
/// joints this names the left one, the right one follows at +kRightArm or +kRightLeg.
enum BodyJoint : std::uint16_t {
  kRoot,
  kPelvis,
  kSpine1,
  kSpine2,
  kSpine3,
  kClavicle,
  kUpperArm,
  kLowerArm,
  kHand,
  kIndex1,
  kIndex2,
  kIndex3,
  kMiddle1,
  kMiddle2,
  kMiddle3,
  kPinky1,
  kPinky2,
  kPinky3,
  kRing1,
  kRing2,
  kRing3,
  kThumb1,
  kThumb2,
  kThumb3,
  kNeck = kThumb3 + 20,
  kHead,
  kThigh,
  kCalf,
  kFoot,
  kBall,
  kBodyJointCount = kBall + 5
};
inline constexpr std::uint16_t kRightArm = 19;  ///< kClavicle + kRightArm is clavicle_r
inline constexpr std::uint16_t kRightLeg = 4;

std::string_view jointName(std::uint16_t joint);
std::int32_t jointParent(std::uint16_t joint);  ///< -1 for kRoot

/// What a person is made from.
struct FigureOptions {
  Sex sex = Sex::kFemale;
  float height = 1.68f;  ///< metres, 1.40 .. 2.10
  float build = 0.0f;    ///< the frame: -1 narrow and slight .. +1 broad and muscular
  float girth = 0.0f;    ///< the flesh on it: -1 thin .. +1 heavy
  AgeGroup age = AgeGroup::kAdult;
};

/// The body as fields, one for each region; left and right alike. Each holds the whole limb's end,
/// so that neighbours overlap: regions are cut by the border functions of people_body.h.
struct Figure {
  FigureOptions options;
  float scale = 1.0f;                          ///< of this person to the reference figure
  float trunk = 1.0f, limb = 1.0f;             ///< thickness of trunk and limbs to the reference man's
  Vec3 head_center{0.0f};                      ///< between the ears, metres
  float head_size = 1.0f;                      ///< of this head to the reference man's
  std::array<Vec3, kBodyJointCount> joints{};  ///< metres, at rest
  Vec3 head_top{0.0f}, hand_end{0.0f}, toe_end{0.0f};  ///< where the last bones end (left)
  std::array<Vec3, 5> finger_ends{};                   ///< index, middle, ring, pinky, thumb (left)
  SolidGroup head_solids, neck_solids, torso_solids, arm_solids, hand_solids, leg_solids, foot_solids;

  float head(const Vec3& p) const;
  float torso(const Vec3& p) const;
  float arm(const Vec3& p) const;
  float hand(const Vec3& p) const;
  float leg(const Vec3& p) const;
  float foot(const Vec3& p) const;
  float body(const Vec3& p) const;  ///< all of them, smoothly joined

  Vec3 armAxis() const;  ///< unit, from the left shoulder to the left elbow
  bool isFemale() const { return options.sex == Sex::kFemale; }
};

Figure makeFigure(const FigureOptions& options);

/// Joints with Y along the bone at rest, and the inverse bind matrices.
RawSkeleton makeSkeleton(const Figure& figure);

}  // namespace ensemble
