// People as the sun sees them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"
#include "shaders/shared/vertex.h"
#include "shaders/crowd_sets.glsl"
#include "shaders/skinning.glsl"

precise gl_Position;

void main() {
  uint character = queue[gl_InstanceIndex];
  WorldFromModel m = blendedJoints(characters[character].first_joint);
  gl_Position = view.shadow_from_world * vec4(worldPosition(m), 1.0);
}
