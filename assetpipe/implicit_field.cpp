#include "assetpipe/implicit_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"

namespace ensemble {

float smoothMin(float a, float b, float radius) {
  const float overlap = radius - std::abs(a - b);
  if (overlap <= 0.0f) return std::min(a, b);
  return std::min(a, b) - overlap * overlap / (4.0f * radius);
}

float smoothMax(float a, float b, float radius) { return -smoothMin(-a, -b, radius); }

float smoothStep(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

Vec3 fieldGradient(const Field& field, const Vec3& position, float step) {
  Vec3 gradient(0.0f);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 offset(0.0f);
    offset[axis] = step;
    gradient[axis] = (field(position + offset) - field(position - offset)) / (2.0f * step);
  }
  return gradient;
}

Vec3 fieldNormal(const Field& field, const Vec3& position, float step) {
  const Vec3 gradient = fieldGradient(field, position, step);
  const float length = glm::length(gradient);
  return length > 1e-6f ? gradient / length : Vec3(0.0f, 1.0f, 0.0f);
}

Vec3 projectToSurface(const Field& field, const Vec3& position, float limit) {
  Vec3 result = position;
  for (int step = 0; step < 4; ++step) {
    const float value = field(result);
    if (std::abs(value) < 2e-6f) break;
    const Vec3 gradient = fieldGradient(field, result);
    result -= gradient * (value / std::max(glm::dot(gradient, gradient), 0.25f));
  }
  return glm::distance(result, position) <= limit ? result : position;
}

LoftFrame loftFrame(const Vec3& from, const Vec3& to, const Vec3& front) {
  const Vec3 along = glm::normalize(to - from);
  const Vec3 side = glm::normalize(glm::cross(along, front));
  return {from, Mat3(side, along, glm::cross(side, along))};
}

Solid Solid::roundCone(const Vec3& a, const Vec3& b, float radius_a, float radius_b) {
  Solid solid;
  solid.kind_ = Kind::kRoundCone;
  solid.a_ = a;
  solid.length_ = glm::distance(a, b);
  ENSEMBLE_CHECK(solid.length_ > std::abs(radius_a - radius_b));
  solid.axis_ = (b - a) / solid.length_;
  solid.radius_a_ = radius_a;
  solid.radius_b_ = radius_b;
  solid.center_ = 0.5f * (a + b);
  solid.radius_ = 0.5f * solid.length_ + std::max(radius_a, radius_b);
  return solid;
}

Solid Solid::ellipsoid(const Vec3& center, const Vec3& radii, const Mat3& world_from_local) {
  Solid solid;
  solid.kind_ = Kind::kEllipsoid;
  solid.a_ = solid.center_ = center;
  solid.radii_ = radii;
  solid.local_from_world_ = glm::transpose(world_from_local);
  solid.radius_ = std::max({radii.x, radii.y, radii.z});
  return solid;
}

namespace {

/// Slopes of one column of rows for cubic Hermite interpolation: central, flattened at the ends
/// and at extrema so that nothing overshoots.
void columnSlopes(const std::vector<LoftRow>& rows, float LoftRow::*column, std::vector<LoftRow>& slopes) {
  const std::size_t count = rows.size();
  const auto chord = [&](std::size_t i) {
    return (rows[i + 1].*column - rows[i].*column) / (rows[i + 1].along - rows[i].along);
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (i == 0 || i + 1 == count) {
      slopes[i].*column = i == 0 ? chord(0) : chord(count - 2);
      continue;
    }
    const float before = chord(i - 1), after = chord(i);
    const float central =
        (rows[i + 1].*column - rows[i - 1].*column) / (rows[i + 1].along - rows[i - 1].along);
    const float limit = 3.0f * std::min(std::abs(before), std::abs(after));
    slopes[i].*column = before * after <= 0.0f ? 0.0f : std::clamp(central, -limit, limit);
  }
}

/// Cubic Hermite interpolation of one column between rows i and i + 1.
float hermite(const LoftRow& row, const LoftRow& next, const LoftRow& slope, const LoftRow& next_slope,
              float LoftRow::*column, float along) {
  const float span = next.along - row.along;
  const float t = (along - row.along) / span;
  const float t2 = t * t, t3 = t2 * t;
  return (2.0f * t3 - 3.0f * t2 + 1.0f) * row.*column + (t3 - 2.0f * t2 + t) * span * slope.*column +
         (3.0f * t2 - 2.0f * t3) * next.*column + (t3 - t2) * span * next_slope.*column;
}

}  // namespace

Solid Solid::loft(const LoftFrame& frame, std::vector<LoftRow> rows, float boxiness) {
  ENSEMBLE_CHECK(rows.size() >= 2u);
  Solid solid;
  solid.kind_ = Kind::kLoft;
  solid.a_ = frame.origin;
  solid.local_from_world_ = glm::transpose(frame.world_from_local);
  solid.boxiness_ = boxiness;
  solid.slopes_.resize(rows.size());
  for (const auto column :
       {&LoftRow::center_x, &LoftRow::center_z, &LoftRow::side, &LoftRow::front, &LoftRow::back}) {
    columnSlopes(rows, column, solid.slopes_);
  }
  float widest = 0.0f;
  for (const LoftRow& row : rows) {
    widest = std::max({widest, row.side + std::abs(row.center_x), row.front + std::abs(row.center_z),
                       row.back + std::abs(row.center_z)});
  }
  const float half = 0.5f * (rows.back().along - rows.front().along);
  solid.center_ = frame.origin + frame.world_from_local[1] * (rows.front().along + half);
  solid.radius_ = half + 1.5f * widest;
  solid.length_ = 2.0f * half;
  solid.axis_ = frame.world_from_local[1];
  solid.widest_ = 1.5f * widest;
  solid.rows_ = std::move(rows);
  return solid;
}

float Solid::lowerBound(const Vec3& position) const {
  if (kind_ != Kind::kLoft) return glm::distance(position, center_) - radius_;
  // A capsule around the loft is much tighter than a sphere.
  const Vec3 offset = position - center_;
  const float half = 0.5f * length_;
  const float along = std::clamp(glm::dot(offset, axis_), -half, half);
  return glm::length(offset - along * axis_) - widest_;
}

float Solid::distance(const Vec3& position) const {
  switch (kind_) {
    case Kind::kRoundCone:
      return roundConeDistance(position);
    case Kind::kEllipsoid:
      return ellipsoidDistance(position);
    case Kind::kLoft:
      return loftDistance(position);
  }
  return 0.0f;
}

float Solid::roundConeDistance(const Vec3& position) const {
  // In the plane through the axis: the cone's side is the common tangent of both end circles.
  const Vec3 offset = position - a_;
  const float along = glm::dot(offset, axis_);
  const float radial = std::sqrt(std::max(glm::dot(offset, offset) - along * along, 0.0f));
  const float sine = (radius_a_ - radius_b_) / length_;
  const float cosine = std::sqrt(std::max(1.0f - sine * sine, 0.0f));
  const float foot = along * cosine - radial * sine;
  if (foot <= 0.0f) return std::hypot(along, radial) - radius_a_;
  if (foot >= length_ * cosine) return std::hypot(along - length_, radial) - radius_b_;
  return radial * cosine + along * sine - radius_a_;
}

float Solid::ellipsoidDistance(const Vec3& position) const {
  const Vec3 scaled = (local_from_world_ * (position - a_)) / radii_;
  const float level = glm::length(scaled);
  const float slope = glm::length(scaled / radii_);
  if (slope < 1e-4f) return -std::min({radii_.x, radii_.y, radii_.z});
  return level * (level - 1.0f) / slope;
}

float Solid::loftDistance(const Vec3& position) const {
  const Vec3 local = local_from_world_ * (position - a_);
  const float along = std::clamp(local.y, rows_.front().along, rows_.back().along);
  std::size_t i = 0;
  while (i + 2 < rows_.size() && along > rows_[i + 1].along) ++i;
  const auto at = [&](float LoftRow::*column) {
    return hermite(rows_[i], rows_[i + 1], slopes_[i], slopes_[i + 1], column, along);
  };
  const float side = at(&LoftRow::side);
  const float z = local.z - at(&LoftRow::center_z);
  const float front = at(&LoftRow::front), back = at(&LoftRow::back);
  const float depth = z > 0.0f ? front : back;
  const float x = std::abs(local.x - at(&LoftRow::center_x)) / side;
  const float w = std::abs(z) / depth;
  const float cap = std::min(side, 0.5f * (front + back));
  const float y = std::abs(local.y - along) / cap;
  // A mean of the 2-norm (an ellipse) and the 4-norm (a rounded rectangle); its level is 1 on the
  // surface, and divided by its gradient it is a distance.
  const float x2 = x * x, w2 = w * w;
  const float round = std::sqrt(x2 + w2);
  float ring = round, slope_x = x, slope_w = w;
  if (boxiness_ > 0.0f && round > 1e-6f) {
    const float box = std::sqrt(std::sqrt(x2 * x2 + w2 * w2));
    const float box_cube = box * box * box;
    ring = std::lerp(round, box, boxiness_);
    slope_x = ring * std::lerp(x / round, x2 * x / box_cube, boxiness_);
    slope_w = ring * std::lerp(w / round, w2 * w / box_cube, boxiness_);
  }
  const float level = std::sqrt(ring * ring + y * y);
  const float slope = glm::length(Vec3(slope_x / side, slope_w / depth, y / cap));
  if (slope < 1e-4f || level < 1e-4f) return -cap;
  return level * (level - 1.0f) / slope;
}

SolidGroup& SolidGroup::join(Solid solid, float blend) {
  // A smooth union bulges by at most a quarter of its blend.
  const auto [center, radius] = solid.bounds();
  low_ = glm::min(low_, center - radius - 0.25f * blend);
  high_ = glm::max(high_, center + radius + 0.25f * blend);
  parts_.push_back({std::move(solid), blend, false});
  return *this;
}

SolidGroup& SolidGroup::carve(Solid solid, float blend) {
  parts_.push_back({std::move(solid), blend, true});
  return *this;
}

float SolidGroup::lowerBound(const Vec3& position) const {
  return glm::length(glm::max(glm::max(low_ - position, position - high_), Vec3(0.0f)));
}

float SolidGroup::distance(const Vec3& position) const {
  // A part farther than its blend from the surface so far changes nothing, so it is skipped.
  float value = 1e9f;
  for (const Part& part : parts_) {
    const float bound = part.solid.lowerBound(position);
    if (part.carved) {
      if (bound < part.blend - value) value = smoothMax(value, -part.solid.distance(position), part.blend);
    } else if (bound < value + part.blend) {
      value = smoothMin(value, part.solid.distance(position), part.blend);
    }
  }
  return value;
}

}  // namespace ensemble
