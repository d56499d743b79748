// From a view to what its shaders read, and to the people whom it needs. Pure functions, no Vulkan.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/box.h"
#include "renderer/sphere.h"
#include "renderer/tile_grid.h"
#include "renderer/view.h"
#include "shaders/shared/crowd_types.h"

namespace ensemble {

/// Right-handed camera frame in the world.
struct CameraFrame {
  Vec3 right, up, forward;
};
CameraFrame cameraFrame(const SceneCamera& camera);

/// Reversed depth without a far plane: depth is near_plane / distance along the view axis.
Mat4 clipFromWorld(const View& view);

inline Tile wholeOf(const View& view) { return {0, 0, view.width, view.height}; }

/// Pixels that a length of one metre, one metre before the camera, has in the picture's middle.
float pixelsPerTangent(const View& view);

/// Who is less than View::snap_below pixels tall on the screen, by the distance of its middle: to the last
/// bit as shaders have it.
struct SmallPeople {
  Vec4 eye{0.0f};  ///< the camera; w: near plane squared
  float pixels = 0.0f, below_squared = 0.0f;
  /// @param feet where somebody stands @param height metres
  bool hold(const Vec3& feet, float height) const;
};
SmallPeople smallPeopleOf(const View& view);

/// The planes that bound a picture; a point is inside where all dot(plane, (p, 1)) >= 0.
struct Frustum {
  Vec4 planes[5];  ///< unit normals: left, right, bottom, top, near
  bool touches(const Sphere& sphere) const;
  bool touches(const Box& box) const;
};
Frustum frustumOf(const View& view);
/// Those that bound a tile of it.
Frustum frustumOf(const View& view, const Tile& tile);

/// Numbers of the people whose bounds touch the picture, ascending. Appends nothing twice.
void findVisible(const Frustum& frustum, std::span<const Sphere> bounds, std::vector<std::uint32_t>& visible);

/// An orthographic shadow map over the people who matter to a view: who is seen, or whose shadow on
/// the ground is, no farther away than three times the nearest, but 50 metres at least.
/// Its size moves in steps and its place by whole texels, so that shadows do not swim.
///
/// An environment takes part by its box: what of it may be seen no farther away than that has shadows
/// too, as far as the map then is at most twice as coarse as people alone have it, or 40 metres wide.
struct ShadowFit {
  Mat4 shadow_from_world{1.0f};  ///< x, y in -1 .. 1; depth 1 towards the sun
  float texel_side = 0.0f;       ///< metres
  std::uint32_t size = 0;        ///< texels a side
};
ShadowFit fitShadowMap(const View& view, std::span<const Sphere> bounds, const Box& environment = {});

/// How far balls are from a shadow map, in its clip space.
struct CasterRule {
  Vec4 across_x{0.0f}, across_y{0.0f};  ///< rows of shadow_from_world
  float scale = 0.0f;                   ///< of a length
};
CasterRule casterRuleOf(const ShadowFit& fit);

/// Numbers of the people who may cast into a shadow map, ascending.
void findCasters(const ShadowFit& fit, std::span<const Sphere> bounds, std::vector<std::uint32_t>& casters);

/// Whether a box may cast into a shadow map.
bool mayCast(const ShadowFit& fit, const Box& box);

/// What the shaders read of a view when they draw a tile of it.
GpuView makeGpuView(const View& view, const Tile& tile, const ShadowFit& fit);

}  // namespace ensemble
