// The person as OGRE holds it: a skinned mesh, a skeleton with one clip, and the material that instances it.
#pragma once

#include <string>

#include "bench/peers/peer_scene.h"

namespace ensemble::peers {

inline constexpr char kGroup[] = "General", kPersonMesh[] = "person", kPersonClip[] = "clip";
inline constexpr char kPersonMaterial[] = "person";

/// Makes the mesh with its skeleton.
///
/// Each joint is a bone without parent whose key frames are the skinning matrices themselves: so OGRE, too,
/// is spared the walk down the hierarchy, and moves the person as the others do.
void makeOgrePerson(const PeerScene& scene);

/// Makes the material of instances that look their bone matrices up in a vertex texture.
/// @param shares_poses the texture holds poses, and each instance brings its place; else it holds an
/// instance's matrices, place included
void makeOgreMaterial(const PeerScene& scene, bool shares_poses);

}  // namespace ensemble::peers
