// Animations. Private to gltf_file.h's implementation.
#pragma once

#include <vector>

#include "core/gltf_document.h"
#include "core/gltf_material.h"
#include "core/gltf_skeleton.h"
#include "core/raw_asset.h"

namespace ensemble {

/// All animations that move a bone. Channels of other nodes and of morph targets are dropped.
/// @throws InputError for times that do not ascend, keys and values that do not match, a property
/// animated twice, quaternions of zero length, and more keys than allowed.
std::vector<RawClip> readClips(const GltfDocument& document, const GltfSkeleton& skeleton,
                               const GltfNodes& tree, DroppedList& dropped);

}  // namespace ensemble
