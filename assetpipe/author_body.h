// A template body as a tailor sees it: where its limbs and heights are, and how far a point is from it.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "assetpipe/body_motion.h"
#include "assetpipe/body_surface.h"
#include "assetpipe/implicit_field.h"
#include "core/wardrobe.h"

namespace ensemble {

/// What a face belongs to, by the joint that moves it most.
enum class BodyZone : std::uint8_t { kHead, kHands, kFeet, kArms, kTorso, kLegs };
inline constexpr std::size_t kBodyZoneCount = 6;

/// Joints that recipes measure from. Of paired ones there is a left (+X) and a right one.
enum class Landmark : std::uint8_t {
  kPelvis,
  kNeck,
  kHead,
  kShoulder,
  kElbow,
  kWrist,
  kHip,
  kKnee,
  kAnkle,
  kBall
};
inline constexpr std::size_t kLandmarkCount = 10;
/// As recipes name them: "pelvis", "neck", "head", "shoulder", ...
const std::array<const char*, kLandmarkCount>& landmarkNames();

/// A field sampled on a grid when it is first asked for, and smoothed by cubic B-splines: details smaller
/// than a cell are gone, so cloth bridges them. Not for several threads.
class SmoothGrid {
 public:
  SmoothGrid(Field exact, const Vec3& low, const Vec3& high, float cell);
  float at(const Vec3& position) const;

 private:
  float node(int x, int y, int z) const;

  Field exact_;
  Vec3 low_;
  float cell_;
  std::array<int, 3> count_{};
  mutable std::vector<float> values_;  // NaN where not yet asked
};

/// The body at rest, for all recipes. Not for several threads.
class AuthorBody {
 public:
  explicit AuthorBody(const TemplateBody& body);

  const TemplateBody& body() const { return body_; }
  const BodySurface& surface() const { return *surface_; }
  const std::vector<PosedBody>& poses() const { return poses_; }      ///< in the template's clips
  BodyZone zoneOf(std::uint32_t face) const { return zones_[face]; }  ///< of surface().faces()
  /// A body 1.75 m tall is 1. Recipes' millimetres are those of such a body.
  float scale() const { return scale_; }
  float ground() const { return low_.y; }
  const Vec3& low() const { return low_; }
  const Vec3& high() const { return high_; }

  /// Smoothed, metres, negative inside.
  float distance(const Vec3& p) const { return smooth_->at(p); }
  /// Smoothed distance to the faces of a zone, never far below 0; 1e3 where it has none.
  float distanceTo(BodyZone zone, const Vec3& p) const;
  /// About how far p is from the border of what is nearest to these zones; negative nearer to them.
  float border(std::initializer_list<BodyZone> zones, const Vec3& p) const;
  /// The same for a region of the template. @pre the region exists
  float regionBorder(RegionId region, const Vec3& p) const;

 private:
  const TemplateBody& body_;
  std::unique_ptr<BodySurface> surface_;
  std::vector<PosedBody> poses_;
  std::vector<BodyZone> zones_;
  std::array<std::unique_ptr<BodySurface>, kBodyZoneCount> zone_surfaces_;
  std::array<std::unique_ptr<SmoothGrid>, kBodyZoneCount> zone_grids_;
  mutable std::map<RegionId, std::pair<std::unique_ptr<BodySurface>, std::unique_ptr<BodySurface>>> regions_;
  std::unique_ptr<SmoothGrid> smooth_;
  // Shell, openings and trims ask for the same point one after the other.
  mutable Vec3 asked_point_{std::numeric_limits<float>::quiet_NaN()};
  mutable std::array<float, kBodyZoneCount> asked_distances_{};  // NaN where not yet asked
  Vec3 low_{0.0f}, high_{0.0f};
  float scale_ = 1.0f;
};

/// Where a skeleton has the joints that a recipe needs.
class Landmarks {
 public:
  /// Finds joints by the usual names of MakeHuman, Unreal, Mixamo, Rigify and DAZ.
  /// @param names landmark ("elbow") -> joint of the left side ("MyElbow_l"), where the usual names fail
  Landmarks(const RawSkeleton& skeleton, const std::map<std::string, std::string>& names);

  bool has(Landmark landmark) const;
  /// Bind position; side 0: left (+X), 1: right. Unpaired: the same for both. @pre has(landmark)
  Vec3 at(Landmark landmark, std::size_t side = 0) const;
  std::uint16_t joint(Landmark landmark, std::size_t side = 0) const;
  /// A name that would be found, for messages: "lowerarm_l".
  static const char* usualName(Landmark landmark);

 private:
  std::array<std::array<std::optional<std::uint16_t>, 2>, kLandmarkCount> joints_;
  std::array<std::array<Vec3, 2>, kLandmarkCount> positions_{};
};

/// Joint with this very name, or nothing.
std::optional<std::uint16_t> findJoint(const RawSkeleton& skeleton, const std::string& name);

}  // namespace ensemble
