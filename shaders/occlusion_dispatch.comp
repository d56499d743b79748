// How many groups each batch of the second round has left. One invocation for each.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/raster_types.h"
#include "shaders/occlusion_sets.glsl"

layout(local_size_x = ENSEMBLE_OCCLUSION_GROUP) in;

layout(set = 0, binding = ENSEMBLE_BINDING_OCCLUSION_BATCHES, std430) buffer Batches { GpuRasterBatch batches[]; };

void main() {
  uint number = invocationNumber();
  if (number >= batch_count) return;
  uvec2 rows = groupRows(batches[number].group_count);
  batches[number].groups_x = rows.x;
  batches[number].groups_y = rows.y;
  batches[number].groups_z = 1u;
}
