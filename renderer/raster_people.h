// From people and views to what the compute rasteriser reads of them, and to whom it can draw. Pure
// functions.
#pragma once

#include "renderer/key_frames.h"
#include "renderer/view_setup.h"
#include "shaders/shared/raster_types.h"

namespace ensemble {

/// From the world to sub-pixels of a target, counted from the centre of its first pixel. Double precision,
/// since a person's matrix is multiplied in.
struct ScreenRows {
  glm::dvec4 x, y;
  glm::dvec4 z;  ///< to the camera: w; to the sun: depth
};
/// Of a view's tile: x and y still to be divided by w.
ScreenRows cameraRows(const View& view, const Tile& tile);
ScreenRows sunRows(const ShadowFit& fit);

/// Row of a product with a matrix given by its rows, the last of which is 0 0 0 1.
glm::dvec4 times(const glm::dvec4& row, const glm::dvec4 (&rows)[3]);

/// @param world_from_box rows: from what the box is in, a person's model space or the world, to the world
GpuRasterPerson makeRasterPerson(const ScreenRows& rows, const vec4 (&world_from_box)[3], const KeptBox& box);

/// Whether no triangle of somebody can get too large for fixed-point edge functions, nor comes near the
/// camera's plane. @param longest_edge of the triangles, metres, scale included
bool fitsCamera(const View& view, const Sphere& bounds, float longest_edge);
bool fitsSun(const ShadowFit& fit, float longest_edge);

}  // namespace ensemble
