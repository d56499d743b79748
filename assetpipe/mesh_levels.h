// Levels of detail of a wardrobe's meshes: the template's once for all outfits (design 1), each garment's
// own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/wardrobe.h"

namespace ensemble {

/// Finds the template's collapses over the bind pose and its clips; what it had before is replaced.
void findLevels(TemplateBody& body);

/// Finds a garment's collapses, over all its parts at once: where parts meet, both get coarser alike.
/// @param poses skinning matrices per pose (body_motion.h), beside the bind pose
void findLevels(Garment& garment, std::span<const std::vector<Mat4>> poses);

/// Takes faces from a garment that has more than `most`, by the same collapses, and the vertices that no face
/// shows then. Its collapses are gone too. @return the faces that are left: more than `most` where its seams
/// and borders allow no less
std::uint32_t reduceFaces(Garment& garment, std::uint32_t most, std::span<const std::vector<Mat4>> poses);

}  // namespace ensemble
