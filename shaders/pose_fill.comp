// Queues the poses: of who is in the tile, ascending by number, then of who casts alone.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/queue_types.h"
#include "shaders/queue_sets.glsl"
#include "shaders/queue_masks.glsl"
#include "shaders/pose_queues.glsl"

layout(set = 0, binding = ENSEMBLE_BINDING_QUEUE_ENTRIES, std430) writeonly buffer Jobs { GpuPoseJob jobs[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_QUEUE_POSES, std430) readonly buffer Poses { uint pose_of[]; };

void main() {
  clearMasks();
  uint verdict = ownVerdict();
  enterPoses(verdict);
  barrier();
  for (uint queue = 0u; queue < ENSEMBLE_COUNTED_POSE_QUEUE; ++queue) {
    if ((verdict >> (ENSEMBLE_FIRST_POSE_BIT + queue) & 1u) == 0u) continue;
    uint at = totals[queue].offset + counts[group() * push.queue_count + queue] + placeIn(queue);
    jobs[at].character = personOfLane();
    jobs[at].key_matrix = pose_of[personOfLane()];
  }
}
