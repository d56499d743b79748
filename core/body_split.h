// Lists of a body part that many visible bodies show differently: what all of them show is listed once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/wardrobe.h"

namespace ensemble {

/// Faces of a body part that are drawn from lists of their own, in draw order.
struct DrawPart {
  std::size_t part = 0;              ///< index into TemplateBody::parts
  std::vector<std::uint32_t> faces;  ///< FaceIds
};

/// Whether a part is split: a second draw is worth 16 KiB of 16-bit indices and more.
/// @param partial_sets distinct sets that show some of its faces @param core_faces shown whenever it shows
inline bool isSplit(std::size_t partial_sets, std::size_t core_faces) {
  constexpr std::size_t kLeastSavedFaces = (16 << 10) / 6;
  return partial_sets > 1 && (partial_sets - 1) * core_faces > kLeastSavedFaces;
}

/// The parts in order; one that is split comes as its core, then the rest, each in the order given. It
/// depends on what is worn alone, so that all techniques draw in one order.
/// @param orders per part its FaceIds in draw order @param visible_sets 1 per visible face of the template
std::vector<DrawPart> splitBody(const TemplateBody& body, std::vector<std::vector<std::uint32_t>> orders,
                                std::span<const std::vector<std::uint8_t>> visible_sets);

}  // namespace ensemble
