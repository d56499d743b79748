// The plane y = 0 out to the horizon: four triangles from below the camera to points at infinity.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"

layout(set = ENSEMBLE_SET_VIEW, binding = ENSEMBLE_BINDING_VIEW, std140) uniform ViewBlock { GpuView view; };

precise gl_Position;

void main() {
  const vec2 kAround[4] = vec2[4](vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(-1.0, 0.0), vec2(0.0, -1.0));
  int triangle = gl_VertexIndex / 3;
  int corner = gl_VertexIndex % 3;
  vec2 direction = kAround[(triangle + corner) & 3];
  vec4 world = corner == 0 ? vec4(view.camera.x, 0.0, view.camera.z, 1.0)
                           : vec4(direction.x, 0.0, direction.y, 0.0);
  gl_Position = view.clip_from_world * world;
}
