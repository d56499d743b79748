// Where each bin's pixels begin in the sorted list, and how many groups shade them. One invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/raster_types.h"
#include "shaders/raster_sets.glsl"
#include "shaders/raster_pixels.glsl"

layout(local_size_x = 1) in;

void main() {
  // Sorted they stand behind those found; of one bin alone they are left where they are.
  bool is_sorted = bin_count == 1u;
  uint first = is_sorted ? 0u : bins[bin_count].count;
  for (uint i = 0u; i <= bin_count; ++i) {
    uint count = is_sorted && i == bin_count ? 0u : bins[i].count;
    uint groups = (count + ENSEMBLE_GROUP_PIXELS - 1u) / ENSEMBLE_GROUP_PIXELS;
    bins[i].first = i < bin_count ? first : 0u;
    bins[i].cursor = first;
    uvec2 rows = groupRows(groups);
    bins[i].groups_x = rows.x;
    bins[i].groups_y = rows.y;
    bins[i].groups_z = 1u;
    first += count;
  }
}
