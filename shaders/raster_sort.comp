// Sorts the pixels found by bin. Their order within a bin is any: each is shaded for itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/raster_types.h"
#include "shaders/raster_sets.glsl"
#include "shaders/raster_pixels.glsl"

layout(local_size_x = ENSEMBLE_LIST_GROUP) in;

void main() {
  uint number = (gl_WorkGroupID.y * ENSEMBLE_RASTER_GROUPS_X + gl_WorkGroupID.x) * ENSEMBLE_LIST_GROUP + gl_LocalInvocationID.x;
  if (number >= bins[bin_count].count) return;
  uvec2 found = pixels[number];
  pixels[atomicAdd(bins[found.y >> ENSEMBLE_LISTED_ITEM_BITS].cursor, 1u)] = found;
}
