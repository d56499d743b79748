// A square of large pale slabs, fading into the horizon.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"

layout(set = ENSEMBLE_SET_VIEW, binding = ENSEMBLE_BINDING_VIEW, std140) uniform ViewBlock { GpuView view; };
#include "shaders/lighting.glsl"
#include "shaders/view_ray.glsl"

layout(location = 0) out vec4 color;

const float kSlab = 1.5;    // metres
const float kJoint = 0.016;  // metres

// The integral of the joints' pattern, one line at each whole number, from 0 to x.
vec2 jointIntegral(vec2 x, float width) { return floor(x) * width + min(fract(x), vec2(width)); }

// How much of a filter as wide as a pixel's footprint is joint, in each direction.
vec2 jointShare(vec2 slab, vec2 footprint) {
  float width = kJoint / kSlab;
  vec2 from = slab - footprint * 0.5;
  return (jointIntegral(from + footprint, width) - jointIntegral(from, width)) / footprint;
}

float slabBrightness(vec2 slab) {
  uvec2 cell = uvec2(ivec2(floor(slab)) + ivec2(1 << 20));
  uint h = (cell.x * 73856093u) ^ (cell.y * 19349663u);
  h = (h ^ (h >> 15)) * 2246822519u;
  h ^= h >> 13;
  return float(h & 0xffffu) * (1.0 / 65535.0) - 0.5;
}

void main() {
  vec3 ray = viewRay();
  float down = ray.y * view.camera.y < 0.0 ? -view.camera.y / ray.y : 1.0e6;
  vec3 from_camera = ray * min(down, 1.0e6);
  vec2 world = view.camera.xz + from_camera.xz;

  // The footprint of a pixel on the plane, from how the hit moves with the ray.
  vec2 dx = (view.ray_x.xz - ray.xz * (view.ray_x.y / ray.y)) * down;
  vec2 dy = (view.ray_y.xz - ray.xz * (view.ray_y.y / ray.y)) * down;
  vec2 footprint = clamp((abs(dx) + abs(dy)) / kSlab, vec2(1.0e-4), vec2(1.0e4));
  vec2 slab = clamp(world / kSlab, vec2(-1.0e5), vec2(1.0e5));
  vec2 joint = jointShare(slab, footprint);
  float joint_share = joint.x + joint.y - joint.x * joint.y;
  float detail = clamp(1.0 - max(footprint.x, footprint.y) * 1.4, 0.0, 1.0);

  vec3 albedo = vec3(0.47, 0.45, 0.42) * (1.0 + 0.10 * detail * slabBrightness(slab));
  albedo *= 1.0 - 0.45 * joint_share;
  const vec3 kUp = vec3(0.0, 1.0, 0.0);
  float sun = max(view.to_sun.y, 0.0) * sunShare5(vec3(world.x, 0.0, world.y), kUp);
  color = vec4(faded(albedo * (view.sun_color.rgb * sun + ambient(kUp)), from_camera), 1.0);
}
