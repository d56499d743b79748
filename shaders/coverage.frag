// Lets a person through once at each pixel: people are drawn in the order of their numbers, each at a
// depth of its own in front of all before, so that a person's second fragment at a pixel fails the depth
// test and an occlusion query counts pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"
#include "shaders/crowd_sets.glsl"
#include "shaders/assets.glsl"

layout(location = 0) in vec4 normal_u;
layout(location = 1) in vec4 world_v;
layout(location = 2) flat in uvec2 who;

void main() {
  if (kCutOut) baseColor(materials[draws[drawNumber(who.y)].material], vec2(normal_u.w, world_v.w));
  gl_FragDepth = float(1u + characters[who.x].number) * (1.0 / 16777216.0);
}
