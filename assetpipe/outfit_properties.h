// What an artist says about an outfit in the custom properties of its scene (glTF `extras`).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/raw_asset.h"
#include "core/wardrobe.h"

namespace ensemble {

/// Where the faces come from that clothes hide.
enum class Occlusion : std::uint8_t {
  kAuthored,  ///< the outfit's author has removed them from its body
  kAuto,      ///< found by rays (hidden_faces.h); what the author removed does not matter
  kBoth,      ///< those of the author and those found
};

struct OutfitProperties {
  Slot slot = Item().slot;
  int layer = Item().layer;
  Occlusion occlusion = Occlusion::kAuthored;
  std::vector<RegionId> keep, hide;  ///< regions that show, or don't, whatever else is found
};

/// Reads `{"ensemble": {"slot", "layer", "occlusion", "keep", "hide"}}`, all optional.
/// @param occlusion what holds where the outfit asks for none
/// @throws InputError: a wrong type or value, a region that the template lacks, one both kept and hidden
OutfitProperties readOutfitProperties(const RawAsset& outfit, const TemplateBody& body, Occlusion occlusion,
                                      const std::string& file);

}  // namespace ensemble
