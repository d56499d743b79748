// A scene's environment, a static set, as triangles in pieces that are drawn or left out as a whole.
//
// Nodes do not matter to a set that never moves: its faces go by material, and within one by place, so
// that few draws show all of it and what is out of sight is left out in large parts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/box.h"
#include "core/raw_asset.h"
#include "core/scene.h"
#include "shaders/shared/vertex.h"

namespace ensemble {

/// Faces of one material that lie near each other.
struct EnvironmentPiece {
  std::uint32_t material = 0;  ///< index into EnvironmentMesh::materials
  Box bounds;                  ///< world
  std::vector<GpuStaticVertex> vertices;
  std::vector<std::uint16_t> indices;  ///< 3 per face, in vertex-cache order
};

struct EnvironmentMesh {
  std::string file;  ///< for messages
  std::vector<RawMaterial> materials;
  std::vector<RawImage> images;
  std::vector<EnvironmentPiece> pieces;        ///< by material; at least one
  Box bounds;                                  ///< of all pieces
  std::vector<std::string> dropped, warnings;  ///< as RawAsset's
};

/// Cuts an asset into pieces of at most 8192 faces. Equal vertices of a material become one.
/// Deterministic. Skinned meshes stand as they are bound.
/// @throws InputError if it has no triangles, or reaches farther than 1,000,000 metres from the origin
EnvironmentMesh buildEnvironmentMesh(RawAsset asset, const std::string& file);

/// Reads the environment of a scene. @pre the scene has one
/// @throws InputError at the scene's key for what is no glTF file, else at its place in the glTF file;
/// SystemError if it can't be read
EnvironmentMesh loadEnvironmentMesh(const Scene& scene);

}  // namespace ensemble
