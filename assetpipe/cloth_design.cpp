#include "assetpipe/cloth_design.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace ensemble {
namespace {

constexpr float kNowhere = 1.0e3f;

/// Where the solids of a frame stand: an origin, and what scales their millimetres.
struct SolidFrame {
  Vec3 origin{0.0f}, scale{1.0f};
  float size = 1.0f;
};

SolidFrame frameOf(const TailorFrame& frame, SolidRecipe::Frame kind, std::size_t side) {
  if (kind == SolidRecipe::Frame::kHead)
    return {frame.fromHead(Vec3(0.0f)), frame.headScales(), frame.headScale()};
  const Vec3 origin = kind == SolidRecipe::Frame::kNeck ? frame.marks().at(Landmark::kNeck)
                                                        : frame.marks().at(Landmark::kAnkle, side);
  return {origin, Vec3(frame.scale()), frame.scale()};
}

Mat3 tiltOf(const SolidRecipe& recipe) {
  return Mat3(glm::mat3_cast(glm::angleAxis(radians(recipe.tilt_degrees), Vec3(1, 0, 0))));
}

void addSolid(const SolidFrame& at, const SolidRecipe& recipe, float mirror, SolidGroup& group) {
  const Vec3 flip(mirror, 1.0f, 1.0f);
  const float blend = recipe.blend * at.size;
  if (recipe.shape == SolidRecipe::Shape::kCone) {
    const Vec3 from = at.origin + recipe.from * flip * at.scale, to = at.origin + recipe.to * flip * at.scale;
    const float r0 = recipe.ends[0] * at.size, r1 = recipe.ends[1] * at.size;
    // On a flat head one end may come to lie inside the other.
    const bool is_ball = glm::distance(from, to) < 1.001f * std::abs(r0 - r1);
    group.join(is_ball ? Solid::ellipsoid(r0 > r1 ? from : to, Vec3(std::max(r0, r1)), Mat3(1.0f))
                       : Solid::roundCone(from, to, r0, r1),
               blend);
    return;
  }
  group.join(
      Solid::ellipsoid(at.origin + recipe.center * flip * at.scale, recipe.radii * at.scale, tiltOf(recipe)),
      blend);
}

/// A flat oval with a round rim: an ellipsoid's would be too sharp for the grid that cloth is meshed on.
Field discField(const SolidFrame& at, const SolidRecipe& recipe, float mirror) {
  const Vec3 center = at.origin + recipe.center * Vec3(mirror, 1.0f, 1.0f) * at.scale;
  const Vec3 radii = recipe.radii * at.scale;
  return [center, radii, local_from_world = glm::transpose(tiltOf(recipe))](const Vec3& p) {
    const Vec3 q = local_from_world * (p - center);
    const float beyond =
        (glm::length(Vec2(q.x / radii.x, q.z / radii.z)) - 1.0f) * std::min(radii.x, radii.z);
    return std::hypot(std::max(beyond + radii.y, 0.0f), q.y) - radii.y;
  };
}

/// How far inside a trim a point is, metres.
class TrimField {
 public:
  TrimField(const TailorFrame& frame, const TrimRecipe& recipe, Field edge)
      : frame_(frame), recipe_(recipe), edge_(std::move(edge)), scale_(frame.scale()) {}

  float operator()(const Vec3& p) const {
    float value = 1.0f;
    if (!recipe_.of.empty()) value = std::min(value, edge_(p) + recipe_.width * scale_);
    if (recipe_.level) {
      value = std::min(
          {value, p.y - frame_.heightOf(recipe_.level->from), frame_.heightOf(recipe_.level->to) - p.y});
      if (!recipe_.arm) value = std::min(value, frame_.offArms(p));
    }
    if (recipe_.arm) {
      value = std::min({value, frame_.beyondArmPlace(p, recipe_.arm->from),
                        -frame_.beyondArmPlace(p, recipe_.arm->to), -frame_.offArms(p)});
    }
    if (recipe_.across) value = std::min(value, across(p));
    if (recipe_.side == "front") value = std::min(value, p.z - middle(p.y).z);
    if (recipe_.side == "back") value = std::min(value, middle(p.y).z - p.z);
    if (recipe_.side == "outside") value = std::min(value, outside(p));
    return value;
  }

 private:
  Vec3 middle(float y) const { return 0.5f * (frame_.legMiddle(0, y) + frame_.legMiddle(1, y)); }

  float across(const Vec3& p) const {
    const float from_y = recipe_.level ? frame_.heightOf(recipe_.level->from) : frame_.heightOf(0.0f);
    const float out = recipe_.slant * (p.y - from_y);
    // A slanting trim goes outwards on its own side.
    const bool is_right = recipe_.across->from + recipe_.across->to < 0.0f;
    const float x = p.x - middle(p.y).x + (is_right ? out : -out);
    return std::min(x - recipe_.across->from * scale_, recipe_.across->to * scale_ - x);
  }

  float outside(const Vec3& p) const {
    const Vec3 leg = frame_.legMiddle(TailorFrame::sideOf(p), p.y);
    const float stripe = 0.5f * recipe_.width * scale_ - std::abs(p.z - leg.z);
    return std::min({stripe, std::abs(p.x) - std::abs(leg.x), frame_.offArms(p)});
  }

  const TailorFrame& frame_;
  const TrimRecipe& recipe_;
  Field edge_;
  float scale_;
};

void addTrims(const TailorFrame& frame, const GarmentRecipe& recipe, ClothDesign& design) {
  for (const TrimRecipe& trim : recipe.trims) {
    Field edge = [](const Vec3&) { return -kNowhere; };
    for (const ClothEdge& known : design.edges) {
      if (known.name == trim.of) edge = known.cut;
    }
    design.trims.push_back({TrimField(frame, trim, edge), trim.raise * frame.scale()});
  }
  const float soft = 0.003f * frame.scale();
  design.shell = [shell = design.shell, trims = design.trims, soft](const Vec3& p) {
    float raise = 0.0f;
    for (const ClothTrim& trim : trims) {
      if (trim.raise == 0.0f) continue;
      const float share = smoothStep(-soft, soft, trim.inside(p));
      raise = glm::mix(raise, trim.raise, share);
    }
    return shell(p) - raise;
  };
}

}  // namespace

Field joinedSolids(const TailorFrame& frame, const std::vector<SolidRecipe>& solids) {
  if (solids.empty()) return [](const Vec3&) { return kNowhere; };
  const auto group = std::make_shared<SolidGroup>();
  std::vector<std::pair<Field, float>> discs;
  for (const SolidRecipe& solid : solids) {
    const bool is_paired = solid.both_sides || solid.frame == SolidRecipe::Frame::kFoot;
    for (std::size_t side = 0; side < (is_paired ? 2u : 1u); ++side) {
      const SolidFrame at = frameOf(frame, solid.frame, side);
      const float mirror = side == 0 ? 1.0f : -1.0f;
      if (solid.shape == SolidRecipe::Shape::kDisc) {
        discs.emplace_back(discField(at, solid, mirror), solid.blend * at.size);
      } else {
        addSolid(at, solid, mirror, *group);
      }
    }
  }
  return [group, discs](const Vec3& p) {
    float value = group->empty() ? kNowhere : group->distance(p);
    for (const auto& [disc, blend] : discs) value = smoothMin(value, disc(p), blend);
    return value;
  };
}

std::vector<Landmark> requiredLandmarks(const GarmentRecipe& recipe) {
  std::vector<Landmark> marks;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const auto mark = static_cast<Landmark>(i);
    const bool of_arm = mark == Landmark::kShoulder || mark == Landmark::kElbow || mark == Landmark::kWrist;
    const bool of_leg = mark == Landmark::kHip || mark == Landmark::kKnee || mark == Landmark::kAnkle;
    const bool of_trunk = mark == Landmark::kPelvis || mark == Landmark::kNeck || mark == Landmark::kHead;
    if (of_leg || (of_trunk && recipe.kind != GarmentKind::kShoes) ||
        (of_arm && recipe.kind == GarmentKind::kBody)) {
      marks.push_back(mark);
    }
  }
  return marks;
}

ClothDesign designCloth(const TailorFrame& frame, const GarmentRecipe& recipe) {
  ClothDesign design = recipe.kind == GarmentKind::kBody    ? designBodyCloth(frame, recipe)
                       : recipe.kind == GarmentKind::kShoes ? designShoes(frame, recipe)
                                                            : designHeadwear(frame, recipe);
  if (!recipe.cuts.empty()) {
    design.edges.push_back({"", [cut = joinedSolids(frame, recipe.cuts)](const Vec3& p) { return -cut(p); }});
  }
  if (recipe.avoid) {
    for (std::size_t r = 0; r < frame.body().body().regions.size(); ++r) {
      if (frame.body().body().regions[RegionId(r)].name != recipe.avoid->value) continue;
      design.edges.push_back(
          {"", [&frame, r](const Vec3& p) { return -frame.body().regionBorder(RegionId(r), p); }});
    }
  }
  design.opening = [edges = design.edges](const Vec3& p) {
    float value = -kNowhere;
    for (const ClothEdge& edge : edges) {
      if (edge.is_opening) value = std::max(value, edge.cut(p));
    }
    return value;
  };
  addTrims(frame, recipe, design);
  return design;
}

}  // namespace ensemble
