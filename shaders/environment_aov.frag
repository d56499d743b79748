// The environment hides what is behind it; like the ground it is nobody.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"

layout(set = ENSEMBLE_SET_VIEW, binding = ENSEMBLE_BINDING_VIEW, std140) uniform ViewBlock { GpuView view; };
#include "shaders/environment.glsl"

layout(location = 0) in vec4 normal_u;
layout(location = 1) in vec4 world_v;

layout(location = ENSEMBLE_AOV_CHARACTER) out uint character;
layout(location = ENSEMBLE_AOV_REGION) out uint region;
layout(location = ENSEMBLE_AOV_FACE) out uint face;
layout(location = ENSEMBLE_AOV_DEPTH) out float depth;
layout(location = ENSEMBLE_AOV_NORMAL) out vec4 normal;

void main() {
  if (kCutOut) baseColor(vec2(normal_u.w, world_v.w));
  character = 0u;
  region = 0u;
  face = 0u;
  depth = view.camera.w / gl_FragCoord.z;
  normal = vec4(normalize(gl_FrontFacing ? normal_u.xyz : -normal_u.xyz), 1.0);
}
