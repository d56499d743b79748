// Sorts the pixels found by bin. Their order within a bin is any: each is shaded for itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/raster_types.h"
#include "shaders/raster_sets.glsl"
#include "shaders/raster_pixels.glsl"
#include "shaders/raster_counters.glsl"

layout(local_size_x = ENSEMBLE_LIST_GROUP) in;

void main() {
  uint first = firstPixelOfInvocation(), end = min(first + ENSEMBLE_GROUP_PIXELS, bins[bin_count].count);
  [[dont_unroll]] for (uint number = first; number < end; number += ENSEMBLE_LIST_GROUP) {
    uvec4 found = texelFetch(listed_pixels, int(number));
    pixels[nextInBin(found.y >> ENSEMBLE_LISTED_ITEM_BITS)] = found;
  }
}
