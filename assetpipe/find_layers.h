// What items hide of one another (design 4): made when first needed, and kept in the wardrobe.
#pragma once

#include <span>

#include "assetpipe/hidden_faces.h"
#include "core/wardrobe.h"

namespace ensemble {

/// The faces of an inner item's garments that no one sees while an outer one is worn over it, over all clips.
/// A part of a garment of which the outer item hides nothing that shows without it stays whole.
/// @param alone findHolesOf the inner item
HiddenGarmentFaces findHiddenUnder(const Item& inner, const Item& outer, const TemplateBody& body,
                                   const FaceHoles& alone, const HiddenFaceOptions& options);

/// Fills Wardrobe::hidden_under for some pairs, of those that are not in it: from the wardrobe's folder where
/// they are kept; else they are found, and kept there. Where that can't be written, one warning says so.
/// @throws SystemError if Embree can't be started
void findLayers(Wardrobe& wardrobe, std::span<const ItemPair> pairs, const HiddenFaceOptions& options = {});

}  // namespace ensemble
