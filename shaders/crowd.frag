// People's colour: linear, alpha 1 where somebody is.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"
#include "shaders/crowd_sets.glsl"
#include "shaders/assets.glsl"
#include "shaders/lighting.glsl"
#include "shaders/person_shading.glsl"

layout(location = 0) in vec4 normal_u;
layout(location = 1) in vec4 world_v;
layout(location = 2) flat in uvec2 who;

layout(location = 0) out vec4 color;

void main() {
  GpuMaterial material = materials[draws[drawNumber(who.y)].material];
  vec3 albedo = baseColor(material, vec2(normal_u.w, world_v.w)).rgb;
  albedo = tinted(albedo, material, characters[who.x].tint_seed, who.y >> ENSEMBLE_DRAW_BITS);

  vec3 normal = normalize(gl_FrontFacing ? normal_u.xyz : -normal_u.xyz);
  color = vec4(litPerson(albedo, material.sheen, world_v.xyz, normal), 1.0);
}
