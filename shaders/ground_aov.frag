// The ground hides what is below it; it is nobody.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"

layout(set = ENSEMBLE_SET_VIEW, binding = ENSEMBLE_BINDING_VIEW, std140) uniform ViewBlock { GpuView view; };

layout(location = ENSEMBLE_AOV_CHARACTER) out uint character;
layout(location = ENSEMBLE_AOV_REGION) out uint region;
layout(location = ENSEMBLE_AOV_FACE) out uint face;
layout(location = ENSEMBLE_AOV_DEPTH) out float depth;
layout(location = ENSEMBLE_AOV_NORMAL) out vec4 normal;

void main() {
  character = 0u;
  region = 0u;
  face = 0u;
  depth = view.camera.w / gl_FragCoord.z;
  normal = vec4(0.0, sign(view.camera.y), 0.0, 1.0);
}
