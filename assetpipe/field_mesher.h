// From a field to triangles.
#pragma once

#include <vector>

#include "assetpipe/implicit_field.h"
#include "core/raw_asset.h"

namespace ensemble {

/// Triangles with one label each (a region); counter-clockwise seen from outside.
struct FieldMesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
  std::vector<std::uint8_t> labels;  ///< #F
};

struct FieldMesherOptions {
  Vec3 low{0.0f}, high{0.0f};  ///< box that holds the surface, metres
  float cell = 0.003f;         ///< edge of the grid's cells, metres
  /// Only x >= 0 is meshed: the surface ends on the plane x = 0 with vertices exactly on it.
  bool half = false;
};

/// The surface of a field by marching tetrahedra: always a manifold, closed unless `half` or the
/// box cuts it. Vertices lie on the surface up to the error of a linear interpolation within a cell.
/// Finds every piece that is larger than four cells. The same field gives the same mesh.
FieldMesh meshField(const Field& field, const FieldMesherOptions& options);

/// Cuts a mesh along the zero set of `border` by moving the vertices next to it onto it (and back to
/// the surface of `field`), so that no face lies on both sides by more than a rounding error, but where a
/// face would turn over for that: there the cut is as rough as the grid.
void snapToBorder(FieldMesh& mesh, const Field& field, const Field& border, float cell);

/// A half mesh and its mirror image in x = 0, welded along the plane.
FieldMesh mirrored(const FieldMesh& half);

/// Drops faces where `keep` is 0, and unused vertices.
FieldMesh keepFaces(const FieldMesh& mesh, const std::vector<std::uint8_t>& keep);

}  // namespace ensemble
