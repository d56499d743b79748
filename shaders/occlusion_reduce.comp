// A level of the depth pyramid from the one before: the least of four texels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/raster_types.h"
#include "shaders/occlusion_sets.glsl"

layout(local_size_x = ENSEMBLE_OCCLUSION_GROUP) in;

void main() {
  uvec2 size = levelSize(level), from = levelSize(level - 1u);
  uint texel = invocationNumber();
  if (texel >= size.x * size.y) return;
  uvec2 low = 2u * uvec2(texel % size.x, texel / size.x), high = min(low + 1u, from - 1u);
  uint first = levelFirst(level - 1u);
  pyramid[levelFirst(level) + texel] = min(min(pyramid[first + low.y * from.x + low.x], pyramid[first + low.y * from.x + high.x]),
                                           min(pyramid[first + high.y * from.x + low.x], pyramid[first + high.y * from.x + high.x]));
}
