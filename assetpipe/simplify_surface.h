// Fewer triangles for a mesh made from a field.
#pragma once

#include <cstddef>
#include <functional>

#include "assetpipe/field_mesher.h"

namespace ensemble {

struct SimplifySurfaceOptions {
  std::size_t target_faces = 1000;
  /// How much an error at a position counts, 1 = normally; unset: 1 everywhere.
  std::function<float(const Vec3&)> importance;
  /// Keeps triangles compact: an edge of length L counts like an error of this much L.
  float compactness = 0.035f;
  int relax_rounds = 2;  ///< rounds of evening out vertices along the surface afterwards
};

/// Collapses edges in the order of their quadric error until `target_faces` are left or no collapse
/// is allowed. Stays a manifold; borders, lines between labels and the plane x = 0 stay where they
/// are, and no face turns over. Vertices lie on the surface of `field`. Deterministic.
FieldMesh simplifySurface(const FieldMesh& mesh, const Field& field, const SimplifySurfaceOptions& options);

}  // namespace ensemble
