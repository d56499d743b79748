// The environment in the colour pass and the AOV pass: one shader, so that both cover the same pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"
#include "shaders/shared/vertex.h"

layout(set = ENSEMBLE_SET_VIEW, binding = ENSEMBLE_BINDING_VIEW, std140) uniform ViewBlock { GpuView view; };

layout(location = ENSEMBLE_ATTRIBUTE_POSITION) in vec3 world;
layout(location = ENSEMBLE_ATTRIBUTE_NORMAL) in vec2 normal_oct;
layout(location = ENSEMBLE_ATTRIBUTE_UV) in vec2 uv;

layout(location = 0) out vec4 normal_u;  // world normal, not of unit length, and u
layout(location = 1) out vec4 world_v;   // world position and v

precise gl_Position;

void main() {
  normal_u = vec4(decodeOctahedral(normal_oct), uv.x);
  world_v = vec4(world, uv.y);
  gl_Position = view.clip_from_world * vec4(world, 1.0);
}
