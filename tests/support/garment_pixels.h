// Which item's garment a pixel of an AOV picture shows.
#pragma once

#include <optional>
#include <span>

#include "renderer/renderer.h"

namespace ensemble::testing {

struct GarmentPixel {
  ItemId item;
  std::size_t face = 0;  ///< numbered through all parts of all garments (Wardrobe::hidden_under)
};

/// @param aovs with character, region and face @pre names of garments that are worn together differ
inline std::optional<GarmentPixel> garmentAt(const Picture& aovs, std::size_t pixel, const Renderer& renderer,
                                             std::span<const Wardrobe> wardrobes) {
  const AovNumbers& numbers = renderer.aovNumbers();
  if (aovs.character[pixel] == 0 || aovs.region[pixel] < numbers.first_garment) return std::nullopt;
  const std::string& name = numbers.garments[aovs.region[pixel] - numbers.first_garment];
  const Character& person = renderer.crowd().characters[aovs.character[pixel] - 1];
  const Wardrobe& wardrobe = wardrobes[person.wardrobe];
  for (const ItemId item : renderer.crowd().combinations[person.combination].items) {
    std::size_t first = 0;
    for (const Garment& garment : wardrobe.items[item].garments) {
      if (garment.name == name) return GarmentPixel{item, first + aovs.face[pixel] - 1};
      for (const ItemPart& part : garment.parts) first += part.faces.size();
    }
  }
  return std::nullopt;
}

}  // namespace ensemble::testing
