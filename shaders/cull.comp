// The verdict on each person of a chunk: who is in the tile, who casts a shadow, who is to be posed, and at which
// key frame. The host reaches the same (renderer/view_setup, view_people, CrowdState::queuePoses).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/queue_types.h"
#include "shaders/shared/culling.h"

layout(local_size_x = ENSEMBLE_QUEUE_GROUP) in;

layout(set = 0, binding = ENSEMBLE_BINDING_CULL_VIEW, std140) uniform CullingBlock { GpuCulling culling; };
layout(set = 0, binding = ENSEMBLE_BINDING_CULL_CHARACTERS, std430) readonly buffer Characters {
  GpuCharacter characters[];
};
layout(set = 0, binding = ENSEMBLE_BINDING_CULL_CLIPS, std430) readonly buffer Clips { GpuClip clips[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_CULL_BOUNDS, std430) readonly buffer Bounds { vec4 bounds[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_CULL_HEIGHTS, std430) readonly buffer Heights { float heights[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_CULL_POSES, std430) buffer Poses { uint pose_of[]; };  // GpuPoseJob::key_matrix
layout(set = 0, binding = ENSEMBLE_BINDING_CULL_VERDICTS, std430) writeonly buffer Verdicts { uint verdicts[]; };

layout(push_constant) uniform Push { GpuQueuePush push; };

bool isIn(vec4 planes[5], vec4 ball) {
  bool behind = false;
  for (int i = 0; i < 5; ++i) behind = behind || isBehind(planes[i], ball);
  return !behind;
}

/// GpuPoseJob::key_matrix of the key frame that is nearest to what somebody plays.
uint matrixOfKey(uint person) {
  bool is_idle = characters[person].idle_weight >= 0.5;
  GpuClip clip = clips[is_idle ? characters[person].idle_clip : characters[person].clip];
  float phase = is_idle ? characters[person].idle_phase : characters[person].phase;
  return 1u + clip.first_matrix + nearestKeyAt(phase, clip.key_count - 1u) * clip.joint_count;
}

void main() {
  uint person = gl_GlobalInvocationID.x;
  if (person >= push.person_count) return;
  vec4 ball = bounds[person];
  bool in_picture = isIn(culling.picture, ball);
  bool is_seen = isIn(culling.tile, ball);
  bool casts = culling.has_shadows != 0u && castsInto(culling.shadow_x, culling.shadow_y, culling.shadow_scale, ball);
  vec3 feet = vec3(characters[person].world_from_model[0].w, characters[person].world_from_model[1].w,
                   characters[person].world_from_model[2].w);
  uint pose = 0u;
  if ((in_picture || casts) && isSmall(feet, heights[person], culling.eye, culling.pixels, culling.snap_squared))
    pose = matrixOfKey(person);

  uint verdict = characters[person].combination << ENSEMBLE_VERDICT_BITS;
  if (is_seen) verdict |= ENSEMBLE_VERDICT_SEEN;
  if (casts) verdict |= ENSEMBLE_VERDICT_CASTS;
  if (in_picture) verdict |= ENSEMBLE_VERDICT_IN_PICTURE;
  if (pose_of[person] != pose) {
    if (is_seen) {
      verdict |= ENSEMBLE_VERDICT_POSE;
    } else if (casts && culling.poses_casters != 0u) {
      verdict |= ENSEMBLE_VERDICT_CASTS_POSE;
    }
  }
  if ((verdict & (ENSEMBLE_VERDICT_POSE | ENSEMBLE_VERDICT_CASTS_POSE)) != 0u) pose_of[person] = pose;
  verdicts[person] = verdict;
}
