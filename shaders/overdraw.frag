// How often triangles of people cover a pixel: blending adds these up.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"
#include "shaders/crowd_sets.glsl"
#include "shaders/assets.glsl"

layout(location = 0) in vec4 normal_u;
layout(location = 1) in vec4 world_v;
layout(location = 2) flat in uvec2 who;

layout(location = 0) out float count;

void main() {
  if (kCutOut) baseColor(materials[draws[drawNumber(who.y)].material], vec2(normal_u.w, world_v.w));
  count = 1.0;
}
