// What a crowd's meshes, clips and clothes say of how large its people and their triangles are. No Vulkan.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/sub_mesh_lists.h"
#include "renderer/animation.h"
#include "renderer/crowd.h"
#include "shaders/shared/raster_types.h"

namespace ensemble {

struct CrowdExtents {
  /// Per person: the longest edge of any triangle of body and clothes at any key of any clip; metres, scale
  /// included.
  std::vector<float> longest_edges;
  /// Of each run of triangles of each index list, in each clip of its wardrobe, vertices rounded as poses
  /// keep them.
  std::vector<GpuRunBox> boxes;
  std::vector<std::vector<std::uint32_t>>
      first_box;  ///< per wardrobe and index list; then by run, then by clip
};

/// @param lists per wardrobe @param combinations per combination of the crowd: wardrobe, number in its lists
/// @param triangles_per_run of the boxes
CrowdExtents extentsOfCrowd(const Crowd& crowd, std::span<const SubMeshLists> lists,
                            std::span<const std::pair<std::uint32_t, std::uint32_t>> combinations,
                            const Animation& animation, std::uint32_t triangles_per_run);

}  // namespace ensemble
