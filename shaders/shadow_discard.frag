// Leaves out of the shadow what casts none: what an alpha mask cuts out, and, where the naive
// technique draws the whole body and whole clothes, the faces that clothes hide. Naive pays for their vertices
// and triangles as everywhere; but their shadow could fall through a gap of the clothes, and the
// techniques are to differ in no pixel but those that show a hidden face.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"
#include "shaders/crowd_sets.glsl"
#include "shaders/assets.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in uvec2 who;

void main() {
  GpuDraw draw_data = draws[who.y];
  if (kHideFaces) {
    if (draw_data.is_covered != 0u) discard;
    uint face = sourceFace(draw_data);
    uint word = hidden_words[hidden_first[characters[who.x].combination] + (face >> 5)];
    if ((word >> (face & 31u) & 1u) != 0u) discard;
  }
  if (kCutOut) baseColor(materials[draw_data.material], uv);
}
