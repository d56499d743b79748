// What an outfit's body has that the template lacks (design 3): a shoe that reshapes the foot.
#pragma once

#include <span>
#include <vector>

#include "core/wardrobe.h"

namespace ensemble {

/// The faces of an outfit's body primitive that match none of the template: a part for each region, in
/// ascending order, with the vertices that it uses. A face belongs to the region of the nearest template
/// face.
/// @param template_face per face of the primitive its match, none() where there is none
std::vector<ExtraBodyPart> unmatchedParts(const RawPrimitive& primitive,
                                          std::span<const FaceId> template_face, const TemplateBody& body);

}  // namespace ensemble
