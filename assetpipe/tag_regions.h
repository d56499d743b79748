// The tagging of Lister, Laycock and Day: which regions of the template show under an outfit.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "assetpipe/hidden_faces.h"
#include "assetpipe/outfit_properties.h"
#include "core/raw_asset.h"
#include "core/wardrobe.h"

namespace ensemble {

inline constexpr float kDefaultTolerance = 0.0002f;  ///< metres
inline constexpr double kMaxUnmatchedShare = 0.02;   ///< of the embedded body's faces (design 3)

struct TagOptions {
  float tolerance = kDefaultTolerance;  ///< metres: how far a corner may be from the template's
  std::string body_node;  ///< take this node alone as the body; empty: whatever has a region's material
  Occlusion occlusion = Occlusion::kAuthored;
  HiddenFaceOptions hidden;  ///< for kAuto and kBoth
  /// Of the same template and options, shared by its outfits; null: looked for anew.
  BareBody* bare = nullptr;
  /// Garments with more faces are brought down to as many before all else (mesh_levels.h); 0: they stay.
  std::uint32_t garment_faces = 0;
  std::filesystem::path explain;  ///< folder for what explain.h writes; empty: not wanted
};

/// Turns an outfit as an artist exported it into an item: tells body from garments, brings joints
/// to the template's (by name, bind positions within 1 mm or five tolerances), matches the body's
/// faces and tags every region. `extras` of the scene may give `{"ensemble": {"slot", "layer", "occlusion",
/// "keep", "hide"}}`, and the attribute `_HIDE` of the body paints faces (docs/wardrobe.md).
/// @param name the item's name, see isValidItemName
/// @param warnings whole sentences for the user
/// @throws InputError: no body, no garment and nothing hidden, unskinned garments, a joint that the
/// template lacks or has elsewhere, more than 2 % unmatched body faces (median and maximum distance
/// are told).
Item tagOutfit(const RawAsset& outfit, const TemplateBody& body, const TagOptions& options,
               const std::string& name, const std::string& file, std::vector<std::string>& warnings);

/// Classes from a set of visible template faces: all full, none hidden, else partial; extra body
/// faces count as visible and make their region partial.
PerRegion<RegionTag> tagRegions(const TemplateBody& body, const PerFace<std::uint8_t>& visible,
                                const std::vector<ExtraBodyPart>& extra_body);

}  // namespace ensemble
