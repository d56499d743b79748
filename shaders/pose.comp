// The palette of this frame: world_from_model * skinning matrix of every joint of the queued people,
// read from the animation texture between two keys. Done once a person for all passes and views.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"

layout(local_size_x = ENSEMBLE_POSE_GROUP) in;

layout(set = 0, binding = ENSEMBLE_BINDING_POSE_CHARACTERS, std430) readonly buffer Characters {
  GpuCharacter characters[];
};
layout(set = 0, binding = ENSEMBLE_BINDING_POSE_PALETTE, std430) writeonly buffer Palette { vec4 palette[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_POSE_CLIPS, std430) readonly buffer Clips { GpuClip clips[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_POSE_ANIMATION) uniform sampler2D animation;
layout(set = 0, binding = ENSEMBLE_BINDING_POSE_QUEUE, std430) readonly buffer Queue { uint queue[]; };

layout(push_constant) uniform Push { uint queue_length; };

vec4 animationRow(uint matrix, uint row) {
  uint texel = matrix * 3u + row;
  return texelFetch(animation, ivec2(texel % ENSEMBLE_ANIMATION_WIDTH, texel / ENSEMBLE_ANIMATION_WIDTH), 0);
}

void main() {
  uint index = gl_WorkGroupID.y * ENSEMBLE_POSE_GROUPS_X + gl_WorkGroupID.x;
  if (index >= queue_length) return;
  GpuCharacter character = characters[queue[index]];
  GpuClip clip = clips[character.clip];
  // The last key closes the loop: between key_count keys lie key_count - 1 intervals.
  float at = character.phase * float(clip.key_count - 1u);
  uint key = min(uint(at), max(clip.key_count, 2u) - 2u);
  uint next_key = min(key + 1u, clip.key_count - 1u);
  float part = at - float(key);

  for (uint joint = gl_LocalInvocationID.x; joint < clip.joint_count; joint += ENSEMBLE_POSE_GROUP) {
    uint from = clip.first_matrix + key * clip.joint_count + joint;
    uint to = clip.first_matrix + next_key * clip.joint_count + joint;
    vec4 row_0 = mix(animationRow(from, 0u), animationRow(to, 0u), part);
    vec4 row_1 = mix(animationRow(from, 1u), animationRow(to, 1u), part);
    vec4 row_2 = mix(animationRow(from, 2u), animationRow(to, 2u), part);
    uint out_at = (character.first_joint + joint) * 3u;
    for (uint row = 0u; row < 3u; ++row) {
      vec4 world = character.world_from_model[row];
      palette[out_at + row] =
          world.x * row_0 + world.y * row_1 + world.z * row_2 + vec4(0.0, 0.0, 0.0, world.w);
    }
  }
}
