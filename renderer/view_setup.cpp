#include "renderer/view_setup.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/color.h"
#include "shaders/shared/culling.h"

namespace ensemble {
namespace {

constexpr float kNearestRange = 50.0f;  // metres: people this near always have shadows
constexpr float kRangeFactor = 3.0f;
constexpr float kLongestShadow = 12.0f;  // metres that a shadow on the ground may reach to matter
constexpr float kLeastWithSet = 40.0f;   // metres that the shadow map may span for an environment's sake
constexpr float kCoarserForSet = 2.0f;
constexpr float kSetDepth = 500.0f;      // metres along the light within which an environment shadows itself
constexpr float kFadeDistance = 260.0f;  // metres
constexpr float kSteps = 4.0f;           // sizes of the shadow map between one and its double

// Linear light. White cloth in the sun comes out just below white.
constexpr Vec3 kSun{1.38f, 1.26f, 1.08f};
constexpr Vec3 kAmbientUp{0.36f, 0.42f, 0.50f};
constexpr Vec3 kAmbientDown{0.20f, 0.185f, 0.165f};
constexpr Vec3 kHorizon{0.70f, 0.79f, 0.88f};
constexpr Vec3 kZenith{0.16f, 0.33f, 0.66f};

Vec3 unitOr(Vec3 v, Vec3 otherwise) {
  const float length = glm::length(v);
  return length > 0.0f ? v / length : otherwise;
}

Vec3 toSun(const SceneLight& light) { return -unitOr(light.direction, Vec3(0.0f, -1.0f, 0.0f)); }

/// Axes of the shadow map: x, y across, z towards the sun.
Mat3 lightAxes(const SceneLight& light) {
  const Vec3 z = toSun(light);
  const Vec3 helper = std::abs(z.y) < 0.99f ? Vec3(0.0f, 1.0f, 0.0f) : Vec3(0.0f, 0.0f, 1.0f);
  const Vec3 x = glm::normalize(glm::cross(helper, z));
  return {x, glm::cross(z, x), z};
}

/// A ball that holds a person and his shadow on the ground.
Sphere withShadow(const Sphere& sphere, Vec3 to_sun) {
  if (!(to_sun.y > 0.0f)) return sphere;
  const float height = std::max(sphere.center.y + sphere.radius, 0.0f);
  const float reach = std::min(height / to_sun.y, kLongestShadow);
  return {sphere.center - to_sun * (0.5f * reach), sphere.radius + 0.5f * reach};
}

std::uint32_t shadowMapSize(const View& view) {
  std::uint32_t size = 512;
  while (size < 4096 && size < std::max(view.width, view.height)) size *= 2;
  return size;
}

/// What of a box may be seen within a distance along the view axis, as a box along the light's axes.
Box seenAlongLight(const View& view, const Box& box, const Mat3& axes, float range) {
  const CameraFrame frame = cameraFrame(view.camera);
  const float tan_y = std::tan(0.5f * view.camera.fov_y);
  const float tan_x = tan_y * static_cast<float>(view.width) / static_cast<float>(view.height);
  Box seen, whole;
  seen.add(view.camera.position * axes);
  for (const float x : {-tan_x, tan_x}) {
    for (const float y : {-tan_y, tan_y}) {
      const Vec3 ray = frame.forward + frame.right * x + frame.up * y;
      seen.add((view.camera.position + ray * range) * axes);
    }
  }
  for (unsigned corner = 0; corner < 8; ++corner) whole.add(box.corner(corner) * axes);
  return {glm::max(seen.low, whole.low), glm::min(seen.high, whole.high)};
}

/// Widens the box of the people, along the light's axes, for an environment.
void addEnvironment(const Box& environment, const Mat3& axes, const Box& seen, Box& box) {
  const bool is_seen = glm::all(glm::lessThan(seen.low, seen.high));
  if (is_seen && box.empty()) {
    box = seen;
  } else if (is_seen) {
    const Vec3 extent = box.extent();
    const Vec3 reach(0.5f * std::max(kCoarserForSet * std::max(extent.x, extent.y), kLeastWithSet));
    const Box limit{box.center() - reach, box.center() + reach};
    box.low = glm::min(box.low, glm::max(seen.low, limit.low));
    box.high = glm::max(box.high, glm::min(seen.high, limit.high));
  }
  if (box.empty()) return;
  Box whole;
  for (unsigned corner = 0; corner < 8; ++corner) whole.add(environment.corner(corner) * axes);
  box.low.z = std::min(box.low.z, std::max(whole.low.z, box.low.z - kSetDepth));
  box.high.z = std::max(box.high.z, std::min(whole.high.z, box.high.z + kSetDepth));
}

}  // namespace

View viewOf(const Scene& scene, double seconds) {
  View view;
  view.camera = scene.camera.at(seconds);
  view.light = scene.light;
  view.ground = scene.ground;
  view.width = scene.output.width;
  view.height = scene.output.height;
  view.samples = scene.output.samples;
  view.raster = scene.raster;
  view.debug = scene.debug;
  view.culling = scene.culling;
  view.occlusion = scene.occlusion;
  view.snap_below = scene.poses.snap_below;
  view.background = scene.output.background;
  view.background_color = scene.output.background_color;
  return view;
}

CameraFrame cameraFrame(const SceneCamera& camera) {
  const Vec3 forward = unitOr(camera.target - camera.position, Vec3(0.0f, 0.0f, -1.0f));
  // Straight up or down the picture's top is -Z, as on a map.
  const Vec3 helper = std::abs(forward.y) < 0.9999f ? Vec3(0.0f, 1.0f, 0.0f) : Vec3(0.0f, 0.0f, -1.0f);
  const Vec3 right = glm::normalize(glm::cross(forward, helper));
  return {right, glm::cross(right, forward), forward};
}

Mat4 clipFromWorld(const View& view) {
  const CameraFrame frame = cameraFrame(view.camera);
  const Vec3 eye = view.camera.position;
  const float scale_y = 1.0f / std::tan(0.5f * view.camera.fov_y);
  const float scale_x = scale_y * static_cast<float>(view.height) / static_cast<float>(view.width);
  const auto row = [&](Vec3 axis, float scale) { return Vec4(axis * scale, -glm::dot(axis, eye) * scale); };
  // Rows of the product of projection and view; y points down in clip space.
  return glm::transpose(Mat4(row(frame.right, scale_x), row(frame.up, -scale_y),
                             Vec4(0.0f, 0.0f, 0.0f, view.camera.near_plane), row(frame.forward, 1.0f)));
}

float pixelsPerTangent(const View& view) {
  return 0.5f * static_cast<float>(view.height) / std::tan(0.5f * view.camera.fov_y);
}

bool SmallPeople::hold(const Vec3& feet, float height) const {
  return culling::isSmall(feet, height, eye, pixels, below_squared);
}

SmallPeople smallPeopleOf(const View& view) {
  const float near_plane = view.camera.near_plane;
  return {.eye = Vec4(view.camera.position, near_plane * near_plane),
          .pixels = pixelsPerTangent(view),
          .below_squared = view.snap_below * view.snap_below};
}

bool Frustum::touches(const Sphere& sphere) const {
  for (const Vec4& plane : planes) {
    if (culling::isBehind(plane, Vec4(sphere.center, sphere.radius))) return false;
  }
  return true;
}

bool Frustum::touches(const Box& box) const {
  for (const Vec4& plane : planes) {
    const Vec3 farthest = glm::mix(box.low, box.high, glm::greaterThan(Vec3(plane), Vec3(0.0f)));
    if (glm::dot(Vec3(plane), farthest) + plane.w < 0.0f) return false;
  }
  return true;
}

Frustum frustumOf(const View& view) { return frustumOf(view, wholeOf(view)); }

Frustum frustumOf(const View& view, const Tile& tile) {
  const Mat4 rows = glm::transpose(clipFromWorld(view));
  const auto ndc = [](std::uint32_t pixel, std::uint32_t size) {
    return 2.0f * static_cast<float>(pixel) / static_cast<float>(size) - 1.0f;
  };
  const float left = ndc(tile.x, view.width), right = ndc(tile.x + tile.width, view.width);
  const float top = ndc(tile.y, view.height), bottom = ndc(tile.y + tile.height, view.height);
  Frustum frustum{{rows[0] - left * rows[3], right * rows[3] - rows[0], rows[1] - top * rows[3],
                   bottom * rows[3] - rows[1], rows[3] - rows[2]}};
  for (Vec4& plane : frustum.planes) plane /= glm::length(Vec3(plane));
  return frustum;
}

void findVisible(const Frustum& frustum, std::span<const Sphere> bounds,
                 std::vector<std::uint32_t>& visible) {
  visible.clear();
  for (std::uint32_t i = 0; i < bounds.size(); ++i) {
    if (frustum.touches(bounds[i])) visible.push_back(i);
  }
}

ShadowFit fitShadowMap(const View& view, std::span<const Sphere> bounds, const Box& environment) {
  ShadowFit fit;
  fit.size = shadowMapSize(view);
  const Vec3 to_sun = toSun(view.light);
  const Mat3 axes = lightAxes(view.light);
  const Frustum frustum = frustumOf(view);
  const auto distance = [&](const Sphere& s) {
    return std::max(glm::length(s.center - view.camera.position) - s.radius, 0.0f);
  };
  float nearest = std::numeric_limits<float>::max();
  for (const Sphere& sphere : bounds) {
    if (frustum.touches(sphere)) nearest = std::min(nearest, distance(sphere));
  }
  const float range = std::max(kRangeFactor * nearest, kNearestRange);
  Box box;
  for (const Sphere& sphere : bounds) {
    if (distance(sphere) > range || !frustum.touches(withShadow(sphere, to_sun))) continue;
    box.add(sphere.center * axes, sphere.radius);
  }
  if (!environment.empty()) {
    const bool sees_people = nearest < std::numeric_limits<float>::max();
    const float seen_range = sees_people ? std::min(range, kFadeDistance) : kNearestRange;
    addEnvironment(environment, axes, seenAlongLight(view, environment, axes, seen_range), box);
  }
  if (box.empty()) box.add(Vec3(0.0f), 1.0f);

  const Vec3 extent = box.high - box.low;
  const float side = std::exp2(std::ceil(std::log2(1.02f * std::max(extent.x, extent.y)) * kSteps) / kSteps);
  fit.texel_side = side / static_cast<float>(fit.size);
  const Vec3 center = 0.5f * (box.low + box.high);
  const auto row = [&](int axis, float scale, float zero) { return Vec4(axes[axis] * scale, -zero * scale); };
  const auto snapped = [&](float value) { return std::floor(value / fit.texel_side) * fit.texel_side; };
  fit.shadow_from_world =
      glm::transpose(Mat4(row(0, 2.0f / side, snapped(center.x)), row(1, 2.0f / side, snapped(center.y)),
                          row(2, 1.0f / extent.z, box.low.z), Vec4(0.0f, 0.0f, 0.0f, 1.0f)));
  return fit;
}

CasterRule casterRuleOf(const ShadowFit& fit) {
  const Mat4 rows = glm::transpose(fit.shadow_from_world);
  return {.across_x = rows[0],
          .across_y = rows[1],
          .scale = 2.0f / (fit.texel_side * static_cast<float>(fit.size))};
}

void findCasters(const ShadowFit& fit, std::span<const Sphere> bounds, std::vector<std::uint32_t>& casters) {
  casters.clear();
  const CasterRule rule = casterRuleOf(fit);
  for (std::uint32_t i = 0; i < bounds.size(); ++i) {
    const Vec4 ball(bounds[i].center, bounds[i].radius);
    if (culling::castsInto(rule.across_x, rule.across_y, rule.scale, ball)) casters.push_back(i);
  }
}

bool mayCast(const ShadowFit& fit, const Box& box) {
  const Vec4 center = fit.shadow_from_world * Vec4(box.center(), 1.0f);
  const Mat3 shadow_axes(fit.shadow_from_world);
  Vec3 reach(0.0f);
  for (int axis = 0; axis < 3; ++axis) reach += glm::abs(shadow_axes[axis]) * (0.5f * box.extent()[axis]);
  return std::abs(center.x) <= 1.0f + reach.x && std::abs(center.y) <= 1.0f + reach.y;
}

GpuView makeGpuView(const View& view, const Tile& tile, const ShadowFit& fit) {
  const CameraFrame frame = cameraFrame(view.camera);
  const float tan_y = std::tan(0.5f * view.camera.fov_y);
  const float pixel = 2.0f * tan_y / static_cast<float>(view.height);  // on a plane one metre away
  const Vec3 corner =
      frame.forward + frame.up * tan_y -
      frame.right * (tan_y * static_cast<float>(view.width) / static_cast<float>(view.height));
  const bool is_sky = view.background == BackgroundKind::kSky;
  const bool is_clear = view.background == BackgroundKind::kTransparent;
  const Vec3 horizon = is_sky ? kHorizon : linearFromSrgb(view.background_color);
  const float fade = is_clear ? std::numeric_limits<float>::infinity() : kFadeDistance;
  GpuView gpu{};
  gpu.clip_from_world = clipFromWorld(view);
  gpu.shadow_from_world = fit.shadow_from_world;
  gpu.camera = Vec4(view.camera.position, view.camera.near_plane);
  gpu.ray_origin = Vec4(corner, fade);
  gpu.ray_x = Vec4(frame.right * pixel, view.light.shadows ? 1.0f : 0.0f);
  gpu.ray_y = Vec4(-frame.up * pixel, fit.texel_side);
  gpu.to_sun = Vec4(toSun(view.light), static_cast<float>(fit.size));
  gpu.sun_color = Vec4(kSun, is_sky ? 1.0f : 0.0f);
  gpu.ambient_up = Vec4(kAmbientUp, is_clear ? 0.0f : 1.0f);
  gpu.ambient_down = Vec4(kAmbientDown, static_cast<float>(tile.x));
  gpu.horizon = Vec4(horizon, static_cast<float>(tile.y));
  gpu.zenith = Vec4(is_sky ? kZenith : horizon, 0.0f);
  return gpu;
}

}  // namespace ensemble
