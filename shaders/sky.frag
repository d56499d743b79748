// The background.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"

layout(set = ENSEMBLE_SET_VIEW, binding = ENSEMBLE_BINDING_VIEW, std140) uniform ViewBlock { GpuView view; };
#include "shaders/lighting.glsl"
#include "shaders/view_ray.glsl"

layout(location = 0) out vec4 color;

void main() {
  vec3 ray = viewRay();
  color = vec4(skyColor(ray), 1.0);
}
