// Shapes as signed fields: negative inside, zero on the surface, metres nearby.
//
// Fields are made of simple solids joined by smooth unions, so that limbs flow into each other.
// They are exact distances for round cones and first-order distances for the elliptic solids.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "core/math.h"

namespace ensemble {

/// A solid as a function of position: negative inside, gradient of length about 1 at the surface.
using Field = std::function<float(const Vec3&)>;

/// Smooth minimum (union) and maximum (intersection): equal to min and max where |a - b| >= radius,
/// rounded by at most radius / 4 between. radius >= 0.
float smoothMin(float a, float b, float radius);
float smoothMax(float a, float b, float radius);

/// 0 below `from`, 1 above `to`, smooth between.
float smoothStep(float from, float to, float x);

/// The gradient by central differences over 2 * step metres, not normalised; and the unit outward
/// normal. A longer step smooths over details that the triangles can't show.
Vec3 fieldGradient(const Field& field, const Vec3& position, float step = 1e-3f);
Vec3 fieldNormal(const Field& field, const Vec3& position, float step = 1e-3f);

/// Moves a point near the surface onto it (Newton along the gradient), by at most `limit` metres.
Vec3 projectToSurface(const Field& field, const Vec3& position, float limit);

/// A cross-section of a loft at `along` metres from its origin: an ellipse about (center_x,
/// center_z) of half-width `side`, and half-depths to the front (+z) and to the back.
struct LoftRow {
  float along = 0.0f;
  float center_x = 0.0f, center_z = 0.0f;
  float side = 0.0f, front = 0.0f, back = 0.0f;
};

/// A local frame: columns x (side), y (along), z (front) are orthonormal.
struct LoftFrame {
  Vec3 origin{0.0f};
  Mat3 world_from_local{1.0f};
};

/// The frame with y from `from` to `to` and z as near to `front` as can be.
LoftFrame loftFrame(const Vec3& from, const Vec3& to, const Vec3& front);

/// One solid of a field, built by the functions below.
class Solid {
 public:
  float distance(const Vec3& position) const;
  /// No point of the solid is nearer than this (up to the error of the first-order distances).
  float lowerBound(const Vec3& position) const;
  /// Centre and radius of a ball that holds the solid.
  std::pair<Vec3, float> bounds() const { return {center_, radius_}; }

  /// A sphere swept from a to b while its radius goes from radius_a to radius_b.
  static Solid roundCone(const Vec3& a, const Vec3& b, float radius_a, float radius_b);
  static Solid ellipsoid(const Vec3& center, const Vec3& radii, const Mat3& world_from_local = Mat3(1.0f));
  /// Elliptic cross-sections interpolated smoothly, at least two, `along` ascending. `boxiness` goes
  /// from 0, an ellipse, to 1, nearly a rectangle. Beyond its ends it closes with half-ellipsoids.
  static Solid loft(const LoftFrame& frame, std::vector<LoftRow> rows, float boxiness = 0.0f);

 private:
  enum class Kind : std::uint8_t { kRoundCone, kEllipsoid, kLoft };
  float roundConeDistance(const Vec3& position) const;
  float ellipsoidDistance(const Vec3& position) const;
  float loftDistance(const Vec3& position) const;

  Kind kind_ = Kind::kRoundCone;
  Vec3 center_{0.0f};    // of the bounding sphere
  float radius_ = 0.0f;  // of the bounding sphere
  Vec3 a_{0.0f};         // round cone: start; the others: origin
  Vec3 axis_{0.0f};      // round cone: unit axis
  float length_ = 0.0f, radius_a_ = 0.0f, radius_b_ = 0.0f;
  Vec3 radii_{1.0f};  // ellipsoid
  Mat3 local_from_world_{1.0f};
  std::vector<LoftRow> rows_;
  std::vector<LoftRow> slopes_;  // d row / d along, for the cubic interpolation
  float boxiness_ = 0.0f;
  float widest_ = 0.0f;
};

/// Solids joined one after the other by smooth unions, or carved out.
class SolidGroup {
 public:
  SolidGroup& join(Solid solid, float blend);
  SolidGroup& carve(Solid solid, float blend);
  float distance(const Vec3& position) const;
  /// No point of the group is nearer than this: the distance to a box around it. Costs next to nothing.
  float lowerBound(const Vec3& position) const;
  bool empty() const { return parts_.empty(); }

 private:
  struct Part {
    Solid solid;
    float blend;
    bool carved;
  };
  std::vector<Part> parts_;
  Vec3 low_{1e9f}, high_{-1e9f};
};

}  // namespace ensemble
