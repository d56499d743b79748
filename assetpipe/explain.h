// `tag --explain`: why a body face is kept or left out under an outfit.
#pragma once

#include <filesystem>

#include "assetpipe/hidden_faces.h"
#include "assetpipe/painted_faces.h"

namespace ensemble {

/// What an outfit's author says of the template's faces, #F.
struct AuthoredFaces {
  PerFace<std::uint8_t> visible;  ///< 1 for what is in the outfit's body
  PerFace<Paint> painted;
};

/// Writes FOLDER/NAME.png, the body at rest from in front, its left, behind and its right, in colours
/// (kExplainColors in the source, docs/wardrobe.md), and FOLDER/NAME.json:
/// {"schema": "ensemble.explain/1", "outfit", "tolerance_mm", "hole_share", "hole_mm2",
///  "regions": [{"name", "kept", "hidden", "faces": [{"face": number in the template file's own order within
///  the region, "verdict": "kept" | "hole" | "pinhole" | "bare region" | "painted", "clip", "seconds",
///  "share", "mm2"}]}]}.
/// "kept" names the clip and the time that show most of the face; "hole" is a face that is left out though a
/// little of it could be seen there, "pinhole" one that is kept because those around it are, "bare region"
/// one that is kept because clothes hide nothing of its region, and "painted" one of which `_HIDE` says
/// ("paint": "hide" | "keep") whether it shows; what shows most of it follows, if anything does.
/// @param item with its visible faces
/// @throws SystemError
void explainHiddenFaces(const std::filesystem::path& folder, const TemplateBody& body, const Item& item,
                        const AuthoredFaces& authored, const FaceHoles& holes,
                        const HiddenFaceOptions& options);

}  // namespace ensemble
