#include "renderer/raster_people.h"

#include <algorithm>
#include <cmath>

namespace ensemble {
namespace {

constexpr double kSubpixels = 1 << ENSEMBLE_SUBPIXEL_BITS;
/// Pixels that a triangle may reach along an axis: edge functions of 2^15 sub-pixels squared fill 31 bits.
constexpr float kMostReach = 126.0f;
constexpr float kMostCoordinate = 4.0e6f;  ///< pixels from the picture's middle, in 32 bits of sub-pixels

glm::dvec4 rowOf(const Mat4& m, int row) { return {m[0][row], m[1][row], m[2][row], m[3][row]}; }

}  // namespace

glm::dvec4 times(const glm::dvec4& row, const glm::dvec4 (&rows)[3]) {
  return row.x * rows[0] + row.y * rows[1] + row.z * rows[2] + glm::dvec4(0.0, 0.0, 0.0, row.w);
}

ScreenRows cameraRows(const View& view, const Tile& tile) {
  const Mat4 clip = clipFromWorld(view);
  const glm::dvec4 w = rowOf(clip, 3);
  const auto to_pixels = [&](int row, std::uint32_t size, std::uint32_t first) {
    const double half = 0.5 * size;
    return kSubpixels * (half * rowOf(clip, row) + (half - first - 0.5) * w);
  };
  return {to_pixels(0, view.width, tile.x), to_pixels(1, view.height, tile.y), w};
}

ScreenRows sunRows(const ShadowFit& fit) {
  const double half = 0.5 * fit.size;
  const auto to_texels = [&](int row) {
    return kSubpixels * (half * rowOf(fit.shadow_from_world, row) + glm::dvec4(0.0, 0.0, 0.0, half - 0.5));
  };
  return {to_texels(0), to_texels(1), rowOf(fit.shadow_from_world, 2)};
}

GpuRasterPerson makeRasterPerson(const ScreenRows& rows, const vec4 (&world_from_box)[3],
                                 const KeptBox& box) {
  GpuRasterPerson person{};
  glm::dvec4 world[3];
  for (int i = 0; i < 3; ++i) {
    const glm::dvec4 row(world_from_box[i]);
    const double offset = glm::dot(glm::dvec3(row), glm::dvec3(box.low)) + row.w;
    world[i] = glm::dvec4(glm::dvec3(row) * double{box.step}, offset);
    person.world_from_kept[i] = world[i];
  }
  person.screen_from_kept[0] = times(rows.x, world);
  person.screen_from_kept[1] = times(rows.y, world);
  person.screen_from_kept[2] = times(rows.z, world);
  return person;
}

bool fitsCamera(const View& view, const Sphere& bounds, float longest_edge) {
  const CameraFrame frame = cameraFrame(view.camera);
  const Vec3 to = bounds.center - view.camera.position;
  const float nearest = glm::dot(to, frame.forward) - bounds.radius;
  if (!(nearest > 1.001f * view.camera.near_plane)) return false;
  const float aside =
      (std::max(std::abs(glm::dot(to, frame.right)), std::abs(glm::dot(to, frame.up))) + bounds.radius) /
      nearest;
  const float pixels = pixelsPerTangent(view);
  // |x1/z1 - x2/z2| <= (|x1 - x2| + |x2/z2| |z1 - z2|) / z1.
  return pixels * aside < kMostCoordinate && pixels * longest_edge * (1.0f + aside) / nearest < kMostReach;
}

bool fitsSun(const ShadowFit& fit, float longest_edge) { return longest_edge / fit.texel_side < kMostReach; }

}  // namespace ensemble
