// Clips from other files of the same skeleton (`--clips`): one clip a file is how Mixamo exports.
#pragma once

#include <filesystem>

#include "core/raw_asset.h"
#include "core/wardrobe.h"

namespace ensemble {

/// Appends the clips of `asset` to the template's. Bones are matched by name. Bone axes may differ
/// (Blender turns them): what is carried over is each bone's motion from the bind pose in model
/// space. A clip without a name, named as one that is there, or by a tool ("mixamo.com", or with a "|", as
/// Blender names what it imports) takes the file's.
/// @throws InputError if there is no clip, or a moving bone that the template lacks or has elsewhere
void transferClips(const RawAsset& asset, const std::filesystem::path& file, TemplateBody& body);

}  // namespace ensemble
