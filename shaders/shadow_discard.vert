// As shadow.vert, with what shadow_discard.frag needs to leave fragments out.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"
#include "shaders/shared/vertex.h"
#include "shaders/crowd_sets.glsl"
#include "shaders/skinning.glsl"

layout(location = ENSEMBLE_ATTRIBUTE_UV) in vec2 uv;

layout(location = 0) out vec2 out_uv;
layout(location = 1) flat out uvec2 who;  // character, draw

precise gl_Position;

void main() {
  uint character = queue[gl_InstanceIndex];
  WorldFromModel m = blendedJoints(characters[character].first_joint);
  out_uv = uv;
  who = uvec2(character, first_draw + gl_DrawID);
  gl_Position = view.shadow_from_world * vec4(worldPosition(m), 1.0);
}
