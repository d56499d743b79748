// What is right in itself in a tagged item, but hardly meant.
#pragma once

#include <string>
#include <vector>

#include "assetpipe/hidden_faces.h"
#include "assetpipe/outfit_properties.h"
#include "core/wardrobe.h"

namespace ensemble {

/// Clothes that hide nothing (perhaps because they face inwards), clothes that hide all, garments far away.
/// @param found what was looked for under `options`, null if nothing was
/// @param warnings whole sentences for the user are added
void warnAbout(const Item& item, const TemplateBody& body, Occlusion occlusion, const FaceHoles* found,
               const HiddenFaceOptions& options, std::vector<std::string>& warnings);

}  // namespace ensemble
