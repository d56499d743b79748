// The environment's colour: linear, in the light that people stand in.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"

layout(set = ENSEMBLE_SET_VIEW, binding = ENSEMBLE_BINDING_VIEW, std140) uniform ViewBlock { GpuView view; };
#include "shaders/environment.glsl"
#include "shaders/lighting.glsl"

layout(location = 0) in vec4 normal_u;
layout(location = 1) in vec4 world_v;

layout(location = 0) out vec4 color;

void main() {
  vec3 albedo = baseColor(vec2(normal_u.w, world_v.w)).rgb;
  vec3 normal = normalize(gl_FrontFacing ? normal_u.xyz : -normal_u.xyz);
  float sun = max(dot(normal, view.to_sun.xyz), 0.0) * sunShare3(world_v.xyz, normal);
  color = vec4(faded(albedo * (view.sun_color.rgb * sun + ambient(normal)), world_v.xyz - view.camera.xyz), 1.0);
}
