// Sorts the pixels found by bin. Their order within a bin is any: each is shaded for itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/raster_types.h"
#include "shaders/raster_sets.glsl"
#include "shaders/raster_pixels.glsl"

layout(local_size_x = ENSEMBLE_LIST_GROUP) in;

uint binOf(uint number) { return texelFetch(listed_pixels, int(number)).y >> ENSEMBLE_LISTED_ITEM_BITS; }

// Pixels of one bin that follow each other take their places at once.
void main() {
  uint number = firstOfRun(), end = min(number + ENSEMBLE_LIST_RUN, bins[bin_count].count);
  [[dont_unroll]] while (number < end) {
    uint of_bin = binOf(number), run_end = number + 1u;
    [[dont_unroll]] while (run_end < end && binOf(run_end) == of_bin) ++run_end;
    uint place = atomicAdd(bins[of_bin].cursor, run_end - number);
    [[dont_unroll]] for (; number < run_end; ++number) pixels[place++] = texelFetch(listed_pixels, int(number));
  }
}
