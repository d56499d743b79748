// Cloth that a coarse mesh let sink into the body, lifted out again.
#pragma once

#include <optional>

#include "assetpipe/body_surface.h"
#include "assetpipe/field_mesher.h"

namespace ensemble {

/// Moves vertices outwards until they, the middles of edges and faces keep `clearance` metres off the body,
/// and no corner or edge of the body pokes through a face that covers it. A few rounds; what is left after
/// them countPokes tells.
void fitOverBody(FieldMesh& cloth, const BodySurface& body, float clearance);

/// The same over another cloth: only what `cloth` covers of it counts, since it has edges and no inside.
void fitOverCloth(FieldMesh& cloth, const BodySurface& under, float clearance);

/// How far a point of the body stands in front of the cloth that covers it (negative: behind), and where.
struct Cover {
  float ahead = 0.0f;  ///< metres
  NearestPoint at;     ///< on the cloth
  Vec3 normal{0.0f};   ///< of the cloth there
};
/// Nothing where no cloth lies near over the point, facing as its `normal` does, or only an edge.
std::optional<Cover> coverOf(const BodySurface& cloth, const Vec3& point, const Vec3& normal);

/// What still sticks through, by more than `tolerance` metres.
struct Pokes {
  std::size_t cloth_in_body = 0;  ///< vertices of the cloth inside the body
  std::size_t body_in_front = 0;  ///< vertices of the body in front of cloth that covers them
};
Pokes countPokes(const FieldMesh& cloth, const BodySurface& body, float tolerance);

}  // namespace ensemble
