// For each queue: how many people the groups before each group have, and the length of all.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/queue_types.h"
#include "shaders/queue_sets.glsl"

// Neighbours along x read neighbouring queues; along y stand parts of the groups.
layout(local_size_x = ENSEMBLE_SCAN_QUEUES, local_size_y = ENSEMBLE_SCAN_PARTS) in;

shared uint part_lengths[ENSEMBLE_SCAN_PARTS][ENSEMBLE_SCAN_QUEUES];

void main() {
  uint queue = gl_GlobalInvocationID.x;
  bool is_queue = queue < push.queue_count;
  uint groups_of_part = (push.group_count + ENSEMBLE_SCAN_PARTS - 1u) / ENSEMBLE_SCAN_PARTS;
  uint first = min(gl_LocalInvocationID.y * groups_of_part, push.group_count);
  uint end = is_queue ? min(first + groups_of_part, push.group_count) : first;
  uint length = 0u;
  for (uint group = first; group < end; ++group) length += counts[group * push.queue_count + queue];
  part_lengths[gl_LocalInvocationID.y][gl_LocalInvocationID.x] = length;
  barrier();
  uint before = 0u;
  for (uint part = 0u; part < gl_LocalInvocationID.y; ++part)
    before += part_lengths[part][gl_LocalInvocationID.x];
  for (uint group = first; group < end; ++group) {
    uint at = group * push.queue_count + queue;
    uint own = counts[at];
    counts[at] = before;
    before += own;
  }
  if (is_queue && gl_LocalInvocationID.y == ENSEMBLE_SCAN_PARTS - 1u) totals[queue].count = before;
}
