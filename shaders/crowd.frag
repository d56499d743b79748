// People's colour: linear, alpha 1 where somebody is.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"
#include "shaders/crowd_sets.glsl"
#include "shaders/assets.glsl"
#include "shaders/lighting.glsl"

layout(location = 0) in vec4 normal_u;
layout(location = 1) in vec4 world_v;
layout(location = 2) flat in uvec2 who;

layout(location = 0) out vec4 color;

void main() {
  GpuMaterial material = materials[draws[drawNumber(who.y)].material];
  vec3 albedo = baseColor(material, vec2(normal_u.w, world_v.w)).rgb;
  albedo = tinted(albedo, material, characters[who.x].tint_seed, who.y >> ENSEMBLE_DRAW_BITS);

  vec3 normal = normalize(gl_FrontFacing ? normal_u.xyz : -normal_u.xyz);
  vec3 from_camera = world_v.xyz - view.camera.xyz;
  float facing = clamp(-dot(normal, normalize(from_camera)), 0.0, 1.0);
  float sun = max(dot(normal, view.to_sun.xyz), 0.0) * sunShare3(world_v.xyz, normal);
  vec3 light = view.sun_color.rgb * sun + ambient(normal);
  float edge = (1.0 - facing) * (1.0 - facing);
  vec3 sheen = material.sheen * edge * edge * light;
  color = vec4(faded(albedo * light + sheen, from_camera), 1.0);
}
