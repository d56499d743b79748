// The second round's groups without what is hidden: of each run of triangles the people of whom something of it may
// lie in front of all that the first round left, and inside of the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/raster_types.h"
#include "shaders/occlusion_sets.glsl"

layout(local_size_x = ENSEMBLE_OCCLUSION_GROUP) in;

layout(set = 0, binding = ENSEMBLE_BINDING_OCCLUSION_OCCLUDEES) uniform samplerBuffer occludees;  // GpuOccludee
layout(set = 0, binding = ENSEMBLE_BINDING_OCCLUSION_BOXES) uniform samplerBuffer boxes;          // GpuRunBox
layout(set = 0, binding = ENSEMBLE_BINDING_OCCLUSION_ENTRIES, std430) buffer Entries { uint entries[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_OCCLUSION_WORK, std430) readonly buffer AllWork { GpuRasterWork all_work[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_OCCLUSION_GROUPS, std430) buffer Groups { GpuRasterGroup groups[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_OCCLUSION_BATCHES, std430) buffer Batches { GpuRasterBatch batches[]; };

// Positions are rounded, on the way to the screen and between corners of triangles.
const float kNearer = 1.0 + 1.0e-4;

// Whether all of the pyramid around some pixels is nearer than a depth. @param low, high inclusive
bool isBehind(ivec2 low, ivec2 high, float depth) {
  low /= int(ENSEMBLE_PYRAMID_TILE);
  high /= int(ENSEMBLE_PYRAMID_TILE);
  // The level at which four texels side by side hold them.
  int side = max(high.x - low.x, high.y - low.y);
  int number = side > 3 ? findMSB((side - 1) / 3) + 1 : 0;
  if (number >= int(ENSEMBLE_PYRAMID_LEVELS)) return false;
  low >>= number;
  high >>= number;
  int row_texels = int(levelSize(uint(number)).x), row = int(levelFirst(uint(number))) + low.y * row_texels;
  ivec2 at = low;
  float least = 1.0e30;
  [[dont_unroll]] while (at.y <= high.y && least > depth) {
    least = min(least, pyramid[row + at.x]);
    bool wraps = at.x == high.x;
    at = wraps ? ivec2(low.x, at.y + 1) : ivec2(at.x + 1, at.y);
    row += wraps ? row_texels : 0;
  }
  return least > depth;
}

// Least and greatest quotient. @param y positive
vec2 quotients(vec2 x, vec2 y) {
  return vec2(x.x / (x.x < 0.0 ? y.x : y.y), x.y / (x.y < 0.0 ? y.y : y.x));
}

// Values of a row over a box.
vec2 overBox(vec4 row, vec3 center, vec3 half_size) {
  float middle = dot(row, vec4(center, 1.0)), reach = dot(abs(row.xyz), half_size);
  return vec2(middle - reach, middle + reach);
}

bool isHidden(int person, uvec4 clips, uint first_box) {
  int box = 2 * int(first_box + clips.x), idle = 2 * int(first_box + clips.y);
  vec3 low = min(texelFetch(boxes, box).xyz, texelFetch(boxes, idle).xyz);
  vec3 high = max(texelFetch(boxes, box + 1).xyz, texelFetch(boxes, idle + 1).xyz);
  vec3 center = 0.5 * (low + high), half_size = 0.5 * (high - low);
  vec2 w = overBox(texelFetch(occludees, person + 2), center, half_size);
  if (!(w.x > near_plane)) return false;
  vec2 x = quotients(overBox(texelFetch(occludees, person), center, half_size), w);
  vec2 y = quotients(overBox(texelFetch(occludees, person + 1), center, half_size), w);
  // Whole numbers are centres of pixels; one more on all sides for their samples and for rounding.
  ivec2 most = ivec2(width, height) - 1;
  ivec2 first = ivec2(clamp(floor(vec2(x.x, y.x) - 0.5), vec2(0.0), vec2(most)));
  ivec2 last = ivec2(clamp(floor(vec2(x.y, y.y) + 1.5), vec2(0.0), vec2(most)));
  return isBehind(first, last, near_plane / w.x * kNearer);
}

void main() {
  uint number = invocationNumber();
  if (number >= group_count) return;
  GpuRasterGroup group = groups[first_group + number];
  GpuRasterWork work = all_work[group.work];
  uint run = group.first_triangle / triangles_per_group;
  uint first = work.first_picked + run * group.entry_count, left = 0u;
  for (uint i = 0u; i < group.entry_count; ++i) {
    uint entry = entries[group.first_entry + i];
    int person = int(entry >> face_bits) * ENSEMBLE_OCCLUDEE_TEXELS;
    uvec4 clips = floatBitsToUint(texelFetch(occludees, person + 3));
    bool is_hidden = hides != 0u && clips.w != 0u && isHidden(person, clips, work.first_box + run * clips.z);
    if (!is_hidden) entries[first + left++] = entry;
  }
  if (left == 0u) return;
  uint triangle_count = min(work.triangle_count - group.first_triangle, triangles_per_group);
  atomicAdd(batches[work.batch].triangle_count, left * triangle_count);
  uint picked = batches[work.batch].first_group + atomicAdd(batches[work.batch].group_count, 1u);
  groups[picked] = GpuRasterGroup(group.work, group.first_triangle, first, left);
}
