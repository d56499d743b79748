// From the resolved linear picture (premultiplied alpha) to 8-bit sRGB with straight alpha.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"

layout(local_size_x = ENSEMBLE_POST_GROUP, local_size_y = ENSEMBLE_POST_GROUP) in;

layout(set = 0, binding = ENSEMBLE_BINDING_POST_LINEAR) uniform sampler2D linear_picture;
layout(set = 0, binding = ENSEMBLE_BINDING_POST_SRGB, rgba8) uniform writeonly image2D srgb_picture;

// IEC 61966-2-1.
vec3 encodeSrgb(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, textureSize(linear_picture, 0)))) return;
  vec4 c = texelFetch(linear_picture, at, 0);
  vec3 straight = clamp(c.a > 0.0 ? c.rgb / c.a : vec3(0.0), 0.0, 1.0);
  imageStore(srgb_picture, at, vec4(encodeSrgb(straight), clamp(c.a, 0.0, 1.0)));
}
