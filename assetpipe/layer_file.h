// layers/INNER-OUTER-KEY.json: what one item hides of another, kept in the wardrobe's folder (design 4).
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "assetpipe/hidden_faces.h"
#include "core/wardrobe.h"

namespace ensemble {

/// What else than the two items a pair's hidden faces depend on, as 12 hex digits: the template with its
/// clips, and how faces are looked at. @param template_sha256 hex
std::string layerKey(const std::string& template_sha256, const HiddenFaceOptions& options);

/// Where a pair is kept, relative to the wardrobe's folder; the digits are of the files' SHA-256.
/// @pre both items have files
std::filesystem::path layerFileName(const Wardrobe& wardrobe, ItemPair pair,
                                    const HiddenFaceOptions& options);

/// What is kept of a pair; nothing where there is no such file, or none that holds.
std::optional<HiddenGarmentFaces> readLayer(const Wardrobe& wardrobe, ItemPair pair,
                                            const HiddenFaceOptions& options);

/// Keeps a pair: atomically, under the writers' lock. @throws SystemError
void writeLayer(const Wardrobe& wardrobe, ItemPair pair, const HiddenGarmentFaces& hidden,
                const HiddenFaceOptions& options);

/// Removes the files of pairs with another key, or with an item that is gone; errors are ignored.
/// @param items the first 12 hex digits of the SHA-256 of those that are there @pre the lock is held
void clearLayers(const std::filesystem::path& folder, const std::set<std::string>& items,
                 const std::string& key);

}  // namespace ensemble
