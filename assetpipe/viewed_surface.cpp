#include "assetpipe/viewed_surface.h"

namespace ensemble {

ViewedSurface surfaceOf(const TemplateBody& body) {
  return {body.vertices.raw(), body.faces.raw(), std::vector<FaceKind>(body.faces.size())};
}

ViewedSurface surfaceOf(const Item& item) {
  ViewedSurface surface;
  for (const Garment& garment : item.garments) {
    for (const ItemPart& part : garment.parts) {
      const RawMaterial& material = item.materials[part.material];
      const auto first = static_cast<std::uint32_t>(surface.vertices.size());
      surface.vertices.insert(surface.vertices.end(), part.vertices.begin(), part.vertices.end());
      for (const Triangle& face : part.faces) {
        surface.faces.push_back({first + face[0], first + face[1], first + face[2]});
        surface.kinds.push_back({material.double_sided, material.alpha_mode == AlphaMode::kOpaque});
      }
    }
  }
  return surface;
}

}  // namespace ensemble
