// From the resolved linear picture (premultiplied alpha) to 8-bit sRGB with straight alpha.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/crowd_types.h"

layout(local_size_x = ENSEMBLE_POST_GROUP) in;

layout(set = 0, binding = ENSEMBLE_BINDING_POST_LINEAR) uniform sampler2D linear_picture;
layout(set = 0, binding = ENSEMBLE_BINDING_POST_SRGB, rgba8) uniform writeonly image2D srgb_picture;

// IEC 61966-2-1.
vec3 encodeSrgb(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

void convert(ivec2 at) {
  vec4 c = texelFetch(linear_picture, at, 0);
  vec3 straight = clamp(c.a > 0.0 ? c.rgb / c.a : vec3(0.0), 0.0, 1.0);
  imageStore(srgb_picture, at, vec4(encodeSrgb(straight), clamp(c.a, 0.0, 1.0)));
}

// Several rows: where shaders run on the CPU an invocation costs as much to begin as a pixel.
void main() {
  ivec2 size = textureSize(linear_picture, 0);
  ivec2 at = ivec2(gl_GlobalInvocationID.x, gl_WorkGroupID.y * ENSEMBLE_POST_ROWS);
  int end = at.x < size.x ? min(at.y + ENSEMBLE_POST_ROWS, size.y) : 0;
  [[dont_unroll]] for (; at.y < end; ++at.y) convert(at);
}
