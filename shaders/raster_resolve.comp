// The mean of a pixel's samples, where one at least was shaded here; the others are as the pipeline drew them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/raster_types.h"
#include "shaders/raster_sets.glsl"

layout(local_size_x = ENSEMBLE_LIST_GROUP) in;

layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_TARGET, std430) readonly buffer Visible {
  uvec2 visible[];
};
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_DEPTH) uniform sampler2DMS depth_picture;
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_DRAWN) uniform sampler2DMS drawn;
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_SHADED, std430) readonly buffer Shaded {
  uvec2 shaded[];
};
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_PICTURE, rgba16f) uniform writeonly image2D picture;

void resolve(uint number) {
  uint pixel = first_pixel + number;
  ivec2 at = ivec2(pixel % width, pixel / width);
  vec4 sum = vec4(0.0);
  bool any_shaded = false;
  for (int i = 0; i < 4; ++i) {
    uint depth = visible[4u * pixel + i].y;
    bool is_shaded = depth != 0u && uintBitsToFloat(depth) >= texelFetch(depth_picture, at, i).x;
    uvec2 color = shaded[4u * number + i];
    sum += is_shaded ? vec4(unpackHalf2x16(color.x), unpackHalf2x16(color.y)) : texelFetch(drawn, at, i);
    any_shaded = any_shaded || is_shaded;
  }
  if (any_shaded) imageStore(picture, at, 0.25 * sum);
}

void main() {
  uint first = firstPixelOfInvocation(), end = min(first + ENSEMBLE_GROUP_PIXELS, pixel_count);
  [[dont_unroll]] for (uint number = first; number < end; number += ENSEMBLE_LIST_GROUP) resolve(number);
}
