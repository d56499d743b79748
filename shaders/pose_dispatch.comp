// Where the queues of poses begin, and what the pose pass is dispatched with. One invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/queue_types.h"
#include "shaders/group_number.glsl"
#include "shaders/queue_sets.glsl"

layout(local_size_x = 1) in;

layout(set = 0, binding = ENSEMBLE_BINDING_QUEUE_POSE_HEAD, std430) writeonly buffer Head { GpuPoseHead head; };

void main() {
  uint seen = totals[0].count, length = seen + totals[1].count;
  totals[0].offset = 0u;
  totals[1].offset = seen;
  head.count = length;
  uvec2 rows = groupRows(length);
  head.groups_x = rows.x;
  head.groups_y = rows.y;
  head.groups_z = 1u;
}
