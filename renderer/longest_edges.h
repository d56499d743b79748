// How long a mesh's edges get in a clip: what bounds a triangle's size on the screen. No Vulkan.
#pragma once

#include <cstdint>
#include <vector>

#include "core/sub_mesh_lists.h"
#include "renderer/animation.h"

namespace ensemble {

/// The longest edge of each mesh over all keys of each clip of its wardrobe, metres in model space; exact for
/// poses at key frames. Index: mesh * clips of the wardrobe + clip. On all cores.
std::vector<float> longestEdges(const SubMeshLists& lists, const Animation& animation,
                                std::uint32_t wardrobe);

}  // namespace ensemble
