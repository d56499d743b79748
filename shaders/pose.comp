// The palette of this frame: world_from_model * skinning matrix of every joint of the queued people,
// read from the animation texture between two keys, the idle clip blended in, and legs bent so that
// feet stay where they stand. Done once a person for all passes and views.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"
#include "shaders/shared/leg_ik.h"
#include "shaders/group_number.glsl"

layout(local_size_x = ENSEMBLE_POSE_GROUP) in;

layout(set = 0, binding = ENSEMBLE_BINDING_POSE_CHARACTERS, std430) readonly buffer Characters {
  GpuCharacter characters[];
};
layout(set = 0, binding = ENSEMBLE_BINDING_POSE_PALETTE, std430) writeonly buffer Palette { vec4 palette[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_POSE_CLIPS, std430) readonly buffer Clips { GpuClip clips[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_POSE_ANIMATION) uniform sampler2D animation;
layout(set = 0, binding = ENSEMBLE_BINDING_POSE_QUEUE, std430) readonly buffer Queue { GpuPoseJob queue[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_POSE_LEGS, std430) readonly buffer AllLegs { GpuLegs all_legs[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_POSE_LEG_GROUPS, std430) readonly buffer Groups { uint leg_groups[]; };

layout(set = 0, binding = ENSEMBLE_BINDING_POSE_HEAD, std430) readonly buffer Head { GpuPoseHead head; };

/// Three rows of a matrix.
struct Rows {
  vec4 row[3];
};

vec4 animationRow(uint matrix, uint row) {
  uint texel = matrix * 3u + row;
  return texelFetch(animation, ivec2(texel % ENSEMBLE_ANIMATION_WIDTH, texel / ENSEMBLE_ANIMATION_WIDTH), 0);
}

Rows clipRows(uint clip_number, float phase, uint joint) {
  GpuClip clip = clips[clip_number];
  // The last key closes the loop: between key_count keys lie key_count - 1 intervals.
  float at = phase * float(clip.key_count - 1u);
  uint key = min(uint(at), max(clip.key_count, 2u) - 2u);
  uint next_key = min(key + 1u, clip.key_count - 1u);
  float part = at - float(key);
  uint from = clip.first_matrix + key * clip.joint_count + joint;
  uint to = clip.first_matrix + next_key * clip.joint_count + joint;
  Rows rows;
  for (uint row = 0u; row < 3u; ++row) {
    rows.row[row] = mix(animationRow(from, row), animationRow(to, row), part);
  }
  return rows;
}

Rows posedRows(GpuCharacter character, uint joint) {
  Rows rows = clipRows(character.clip, character.phase, joint);
  if (character.idle_weight > 0.0) {
    Rows idle = clipRows(character.idle_clip, character.idle_phase, joint);
    for (uint row = 0u; row < 3u; ++row) rows.row[row] = mix(rows.row[row], idle.row[row], character.idle_weight);
  }
  return rows;
}

vec3 moved(Rows rows, vec3 point) {
  vec4 p = vec4(point, 1.0);
  return vec3(dot(rows.row[0], p), dot(rows.row[1], p), dot(rows.row[2], p));
}

/// Bends the leg that a joint belongs to.
Rows holdFoot(GpuCharacter character, GpuLegs legs, uint group, Rows rows) {
  uint leg = (group - 1u) / ENSEMBLE_LEG_PARTS;
  uint part = (group - 1u) % ENSEMBLE_LEG_PARTS;
  vec3 place[3];
  for (uint i = 0u; i < 3u; ++i) {
    uint at = leg * 3u + i;
    place[i] = moved(posedRows(character, legs.joints[at]), legs.positions[at].xyz);
  }
  vec4 foot = character.feet[leg];
  vec3 target = place[2] + vec3(foot.x, 0.0, foot.z);
  LegMove move = moveLeg(place[0], place[1], place[2], target, foot.y, part);
  Rows held;
  vec3 offset = move.to - move.rotation * move.from;
  for (uint row = 0u; row < 3u; ++row) {
    vec3 turn = vec3(move.rotation[0][row], move.rotation[1][row], move.rotation[2][row]);
    held.row[row] = turn.x * rows.row[0] + turn.y * rows.row[1] + turn.z * rows.row[2] + vec4(0.0, 0.0, 0.0, offset[row]);
  }
  return held;
}

void main() {
  uint index = groupNumber();
  if (index >= head.count) return;
  GpuPoseJob job = queue[index];
  GpuCharacter character = characters[job.character];
  GpuClip clip = clips[character.clip];
  bool is_key = job.key_matrix != 0u;
  bool holds_feet = !is_key && (character.feet[0].w > 0.0 || character.feet[1].w > 0.0);

  for (uint joint = gl_LocalInvocationID.x; joint < clip.joint_count; joint += ENSEMBLE_POSE_GROUP) {
    Rows rows;
    if (is_key) {
      for (uint row = 0u; row < 3u; ++row) rows.row[row] = animationRow(job.key_matrix - 1u + joint, row);
    } else {
      rows = posedRows(character, joint);
    }
    if (holds_feet) {
      GpuLegs legs = all_legs[clip.legs];
      uint group = leg_groups[legs.first_group + joint];
      if (group != 0u) rows = holdFoot(character, legs, group, rows);
    }
    uint out_at = (character.first_joint + joint) * 3u;
    for (uint row = 0u; row < 3u; ++row) {
      vec4 world = character.world_from_model[row];
      palette[out_at + row] =
          world.x * rows.row[0] + world.y * rows.row[1] + world.z * rows.row[2] + vec4(0.0, 0.0, 0.0, world.w);
    }
  }
}
