// Lists the pixels at which somebody rasterised in compute is in front of all that the graphics pipeline drew.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/raster_types.h"
#include "shaders/raster_sets.glsl"
#include "shaders/raster_pixels.glsl"

layout(local_size_x = ENSEMBLE_LIST_GROUP) in;

layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_DEPTH) uniform sampler2D depth_picture;

void main() {
  uint pixel = (gl_WorkGroupID.y * ENSEMBLE_RASTER_GROUPS_X + gl_WorkGroupID.x) * ENSEMBLE_LIST_GROUP + gl_LocalInvocationID.x;
  if (pixel >= width * height) return;
  uvec2 key = visible[pixel];
  if (key.y == 0u) return;
  // At equal depth people come before ground and environment.
  float drawn = texelFetch(depth_picture, ivec2(pixel % width, pixel / width), 0).x;
  if (uintBitsToFloat(key.y) < drawn) return;
  uint id = ~key.x;
  uvec4 person = texelFetch(who, int(id >> face_bits));
  uint item = itemOfFace(person.x, id & ((1u << face_bits) - 1u)).x;
  uvec4 first = texelFetch(items, int(item * ENSEMBLE_RASTER_ITEM_TEXELS));
  uint pose = texelFetch(pose_table, int(first.z + person.y)).x;
  uint of_bin = first.w + (pose >> ENSEMBLE_POSE_OFFSET_BITS) * bin;  // `bin`: bins of one buffer of poses
  atomicAdd(bins[of_bin].count, 1u);
  pixels[atomicAdd(bins[bin_count].count, 1u)] = uvec2(pixel, item | of_bin << 20);
}
