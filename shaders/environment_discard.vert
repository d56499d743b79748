// As environment_shadow.vert, with what environment_discard.frag needs to leave fragments out.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"
#include "shaders/shared/vertex.h"

layout(set = ENSEMBLE_SET_VIEW, binding = ENSEMBLE_BINDING_VIEW, std140) uniform ViewBlock { GpuView view; };

layout(location = ENSEMBLE_ATTRIBUTE_POSITION) in vec3 world;
layout(location = ENSEMBLE_ATTRIBUTE_UV) in vec2 uv;

layout(location = 0) out vec2 out_uv;

void main() {
  out_uv = uv;
  gl_Position = view.shadow_from_world * vec4(world, 1.0);
}
