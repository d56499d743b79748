// What is known of the people in a picture: boxes, visible shares, joints (interfaces.md, --annotations).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/wardrobe.h"
#include "renderer/crowd.h"
#include "renderer/view.h"

namespace ensemble {

/// A camera as computer vision writes it: x right, y down, z forward; pixels from the picture's upper
/// left corner, the first pixel's centre at (0.5, 0.5). In double precision, row by row.
struct PinholeCamera {
  std::array<std::array<double, 3>, 3> intrinsics{};         ///< pixels
  std::array<std::array<double, 4>, 4> camera_from_world{};  ///< metres

  /// Where a point of the world falls. None on the camera's plane or behind it.
  std::optional<glm::dvec2> project(Vec3 world) const;
};
PinholeCamera pinholeOf(const View& view);

/// Pixels from (x, y) on; COCO's order.
struct PixelBox {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};

/// A joint in the picture.
struct PictureJoint {
  std::optional<glm::dvec2> place;  ///< none behind the camera; may lie outside the picture
  bool shows = false;               ///< the pixel where it falls shows its person
};

/// Somebody of whom a picture shows one pixel at least.
struct PersonTruth {
  std::uint32_t number = 0;  ///< in the crowd
  PixelBox box;              ///< of the pixels that show
  /// Of the whole person's vertices, also where it leaves the picture or is hidden; none if it reaches
  /// behind the near plane.
  std::optional<PixelBox> whole_box;
  std::uint32_t visible_pixels = 0;
  std::uint32_t pixels_alone = 0;  ///< pixels of the picture that it would cover if nothing stood in front
  /// The box of its body and garments at rest on its heading: axes x, y, z of the person (left, up,
  /// forward), turned about +Y by heading; world space, metres.
  Vec3 center{0.0f}, size{0.0f};
  float heading = 0.0f;  ///< radians
  std::uint32_t clip = 0;
  std::vector<Vec3> joints;  ///< world space, metres, #joints of the template
  std::vector<PictureJoint> picture_joints;

  double visibleShare() const { return double{static_cast<double>(visible_pixels)} / pixels_alone; }
};

/// By number, ascending.
/// @param wardrobes those of the crowd's scene
/// @param picture of the view at that time, with AOV character and coverage
std::vector<PersonTruth> truthOf(const Crowd& crowd, std::span<const Wardrobe> wardrobes, const View& view,
                                 const Picture& picture, double seconds);

}  // namespace ensemble
