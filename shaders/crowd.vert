// People in the colour pass and the AOV pass: one shader, so that both cover the same pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"
#include "shaders/shared/vertex.h"
#include "shaders/crowd_sets.glsl"
#include "shaders/skinning.glsl"

layout(location = ENSEMBLE_ATTRIBUTE_NORMAL) in vec2 normal_oct;
layout(location = ENSEMBLE_ATTRIBUTE_UV) in vec2 uv;

layout(location = 0) out vec4 normal_u;  // world normal, not of unit length, and u
layout(location = 1) out vec4 world_v;   // world position and v
layout(location = 2) flat out uvec2 who;  // character, draw and garment part

precise gl_Position;

void main() {
  uint character = queue[gl_InstanceIndex];
  WorldFromModel m = blendedJoints(characters[character].first_joint);
  vec3 world = worldPosition(m);
  vec3 n = decodeOctahedral(normal_oct);
  normal_u = vec4(dot(m.row_0.xyz, n), dot(m.row_1.xyz, n), dot(m.row_2.xyz, n), uv.x);
  world_v = vec4(world, uv.y);
  who = uvec2(character, (first_draw + gl_DrawID) | (joints.x >> ENSEMBLE_JOINT_BITS << ENSEMBLE_DRAW_BITS));
  gl_Position = view.clip_from_world * vec4(world, 1.0);
}
