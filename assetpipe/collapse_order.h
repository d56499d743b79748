// The order in which a mesh's vertices go as it gets coarser, one by one, each onto a neighbour: levels of
// detail without new vertices (Dong and Peng, "Character creation", the order stored as an array).
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
  std::uint32_t levels = 12;     ///< at most; the finest shows all
  float coarsest_share = 0.04f;  ///< of the positions, in the coarsest level, where the mesh allows it
  /// Keeps triangles compact: an edge of length L counts like an error of this much L.
  float compactness = 0.02f;
  /// Keeps weights that differ apart in poses that nobody looked at: an edge of length L between positions
  /// whose weights have nothing in common counts like an error of this much L.
  float skin_weight = 0.1f;
};

/// Bands of vertices, coarse to fine: level l shows bands 0 to l, and the last level all.
struct CollapseOrder {
  /// Per vertex the one that it moves onto, always of a coarser band; itself where it never goes. So within
  /// a band any order is valid.
  std::vector<std::uint32_t> target;
  std::vector<std::uint8_t> band;  ///< per vertex
  std::uint32_t levels = 1;
};

/// Collapses what costs least over all poses first. What can't go stays: corners of seams, edges of more than
/// two faces, meshes of a few triangles. Never fails, whatever the mesh is; deterministic.
/// @pre indices are valid; poses have one size
CollapseOrder findCollapseOrder(const CollapseMesh& mesh, const CollapseOptions& options);

/// Where a level shows each vertex: one of its own bands.
std::vector<std::uint32_t> verticesAtLevel(const CollapseOrder& order, std::uint32_t level);

/// The faces that are left at a level, with the vertices that it shows, in the order given.
/// @param position_of_vertex as in CollapseMesh: faces that have two corners in one place are gone
std::vector<Triangle> facesAtLevel(const CollapseOrder& order,
                                   std::span<const std::uint32_t> position_of_vertex,
                                   std::span<const Triangle> faces, std::uint32_t level);

}  // namespace ensemble
