// The order in which a mesh's vertices go as it gets coarser, one by one, each onto a neighbour
// (core/collapse.h).
//
// Topology lives on positions, attributes on wedges (design 2): all wedges of a position go together, each
// onto the wedge of the neighbour that continues its side. So what parts wedges (UV seams, regions,
// materials) stays a line at every level, and both sides of it get coarser alike.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/raw_asset.h"

namespace ensemble {

/// A mesh, and how it moves.
struct CollapseMesh {
  /// Per pose that counts all distinct positions, #poses x #P, metres. At least one pose.
  std::vector<std::vector<Vec3>> poses;
  std::vector<std::uint32_t> position_of_vertex;  ///< per vertex (wedge), index into a pose
  std::vector<SkinBinding> skins;                 ///< per position, or empty: what moves it
  std::vector<Triangle> faces;                    ///< of vertices
};

/// Vertices in one place are wedges of one position, moved by what moves the first of them.
/// @param poses skinning matrices per pose (body_motion.h), beside the bind pose
CollapseMesh makeCollapseMesh(std::span<const RawVertex> vertices, std::span<const Triangle> faces,
                              std::span<const std::vector<Mat4>> poses);

struct CollapseOptions {
  std::uint32_t levels = 12;     ///< at most; level 0 shows all
  float coarsest_share = 0.04f;  ///< of the positions, in the coarsest level, where the mesh allows it
  /// Keeps triangles compact: an edge of length L counts like an error of this much L.
  float compactness = 0.02f;
  /// Keeps weights that differ apart in poses that nobody looked at: an edge of length L between positions
  /// whose weights have nothing in common counts like an error of this much L.
  float skin_weight = 0.1f;
};

/// When each vertex goes, and where to (core/collapse.h): what costs least over all poses goes first. All of
/// one level can go in any order, since their targets outlast the level. What can't go stays: corners of
/// seams, edges of more than two faces, meshes of a few triangles. Never fails, whatever the mesh is;
/// deterministic.
/// @pre indices are valid; poses have one size @return #V
std::vector<VertexCollapse> findCollapseOrder(const CollapseMesh& mesh, const CollapseOptions& options);

}  // namespace ensemble
