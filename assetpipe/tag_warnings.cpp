#include "assetpipe/tag_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "core/box.h"

namespace ensemble {
namespace {

constexpr float kFarGarment = 0.25f;  // metres from the body's box

std::ptrdiff_t hiddenFaces(const FaceHoles& found) {
  return std::count_if(found.faces.begin(), found.faces.end(),
                       [](const FaceHole& face) { return !face.is_kept || face.is_in_bare_region; });
}

/// Whether single-sided clothes look the wrong way.
bool wouldHideWithItsBacks(const Item& item, const TemplateBody& body, const FaceHoles& found,
                           const HiddenFaceOptions& options) {
  Item both_sided = item;
  bool is_other = false;
  for (const Garment& garment : item.garments) {
    for (const ItemPart& part : garment.parts) {
      RawMaterial& material = both_sided.materials[part.material];
      is_other = is_other || !material.double_sided;
      material.double_sided = true;
    }
  }
  if (!is_other) return false;
  const Item* const worn = &both_sided;
  return hiddenFaces(findHoles(body, std::span(&worn, 1), options)) > hiddenFaces(found);
}

std::string completeBody(const Item& item, const TemplateBody& body, Occlusion occlusion,
                         const FaceHoles* found, const HiddenFaceOptions& options) {
  if (occlusion == Occlusion::kAuthored) {
    return "its body is complete, so nothing is hidden under the clothes; remove the faces that they hide "
           "before exporting, or let --auto-occlusion find them";
  }
  if (found != nullptr && wouldHideWithItsBacks(item, body, *found, options)) {
    return "its clothes hide no face of the body, but would if the backs of their faces were drawn; turn the "
           "faces to the outside, or make the materials double-sided";
  }
  return "its clothes hide no face of the body";
}

void warnOfFarGarments(const Item& item, const TemplateBody& template_body,
                       std::vector<std::string>& warnings) {
  Box body;
  for (const RawVertex& vertex : template_body.vertices) body.add(vertex.position);
  for (const Garment& garment : item.garments) {
    Box box;
    for (const ItemPart& part : garment.parts) {
      for (const RawVertex& vertex : part.vertices) box.add(vertex.position);
    }
    if (box.empty()) continue;
    const Vec3 gap = glm::max(glm::max(box.low - body.high, body.low - box.high), Vec3(0.0f));
    const float distance = glm::length(gap);
    if (distance < kFarGarment) continue;
    warnings.push_back(
        fmt::format("garment '{}' lies {:.2f} m from the body; is it in other units, or elsewhere?",
                    garment.name, distance));
  }
}

}  // namespace

void warnAbout(const Item& item, const TemplateBody& body, Occlusion occlusion, const FaceHoles* found,
               const HiddenFaceOptions& options, std::vector<std::string>& warnings) {
  const bool is_complete =
      std::all_of(item.visible.begin(), item.visible.end(), [](std::uint8_t v) { return v != 0; });
  if (is_complete) warnings.push_back(completeBody(item, body, occlusion, found, options));
  if (item.visibleBodyFaceCount() == 0)
    warnings.push_back("nothing of the body shows under it; if that is not meant, look at --explain");
  warnOfFarGarments(item, body, warnings);
}

}  // namespace ensemble
