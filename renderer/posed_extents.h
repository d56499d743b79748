// How far meshes extend in a clip, and how long their edges get: what bounds triangles on the screen. No
// Vulkan.
#pragma once

#include <cstdint>
#include <vector>

#include "core/box.h"
#include "core/sub_mesh_lists.h"
#include "renderer/animation.h"

namespace ensemble {

/// Of a wardrobe's meshes over all keys of each clip, model space, metres. Between two keys nothing is
/// outside of the boxes, nor any edge longer than at one of both, since skinning is linear in its matrices.
struct PosedExtents {
  std::size_t clip_count = 0;        ///< of the wardrobe
  std::vector<float> longest_edges;  ///< per mesh and clip: mesh * clip_count + clip
  std::vector<std::vector<Box>>
      run_boxes;  ///< per index list, run of triangles and clip: run * clip_count + clip
};

/// @param triangles_per_run consecutive triangles of an index list that share a box. On all cores.
PosedExtents posedExtents(const SubMeshLists& lists, const Animation& animation, std::uint32_t wardrobe,
                          std::uint32_t triangles_per_run);

}  // namespace ensemble
