// What rays look at: the faces of a body, or of an item's garments.
#pragma once

#include <cstdint>
#include <vector>

#include "core/wardrobe.h"

namespace ensemble {

/// A face as it is drawn.
struct FaceKind {
  bool is_two_sided = false;  ///< its back is drawn, too
  bool is_opaque = true;      ///< false: an alpha mask may cut it out, so that it hides nothing
};

/// Triangles in the bind pose, model space.
struct ViewedSurface {
  std::vector<RawVertex> vertices;
  std::vector<Triangle> faces;  ///< indices into vertices
  std::vector<FaceKind> kinds;  ///< per face
};

/// Faces are numbered as the body's. A body is closed: its backs are never looked at.
ViewedSurface surfaceOf(const TemplateBody& body);
/// Faces are numbered through all parts of all garments (Wardrobe::hidden_under).
ViewedSurface surfaceOf(const Item& item);

}  // namespace ensemble
