// What shows where: numbers for people, regions and faces, depth and normal.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"
#include "shaders/crowd_sets.glsl"
#include "shaders/assets.glsl"

layout(location = 0) in vec4 normal_u;
layout(location = 1) in vec4 world_v;
layout(location = 2) flat in uvec2 who;

layout(location = ENSEMBLE_AOV_CHARACTER) out uint character;
layout(location = ENSEMBLE_AOV_REGION) out uint region;
layout(location = ENSEMBLE_AOV_FACE) out uint face;
layout(location = ENSEMBLE_AOV_DEPTH) out float depth;
layout(location = ENSEMBLE_AOV_NORMAL) out vec4 normal;

void main() {
  GpuDraw draw_data = draws[drawNumber(who.y)];
  if (kCutOut) baseColor(materials[draw_data.material], vec2(normal_u.w, world_v.w));
  character = 1u + characters[who.x].number;
  region = draw_data.region;
  face = 1u + sourceFace(draw_data);
  depth = view.camera.w / gl_FragCoord.z;
  normal = vec4(normalize(gl_FrontFacing ? normal_u.xyz : -normal_u.xyz), 1.0);
}
