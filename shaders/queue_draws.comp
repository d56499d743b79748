// Where each queue begins, and one indirect draw for each that is not empty, those of a batch side by side from
// where the batch begins. One group.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/queue_types.h"
#include "shaders/queue_sets.glsl"

layout(local_size_x = ENSEMBLE_QUEUE_GROUP) in;

layout(set = 0, binding = ENSEMBLE_BINDING_QUEUE_ITEMS, std430) readonly buffer Items { GpuQueueItem items[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_QUEUE_COMMANDS, std430) writeonly buffer Commands {
  GpuQueueCommand commands[];
};
layout(set = 0, binding = ENSEMBLE_BINDING_QUEUE_DRAWS, std430) writeonly buffer Draws { GpuDraw draws[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_QUEUE_DRAW_COUNTS, std430) writeonly buffer DrawCounts {
  uint draw_counts[];
};

shared uvec2 sums[ENSEMBLE_QUEUE_GROUP];

/// Entries and draws of the queues that stand before an invocation's own. @param own of its own
uvec2 sumBefore(uvec2 own) {
  uint lane = gl_LocalInvocationID.x;
  sums[lane] = own;
  barrier();
  for (uint reach = 1u; reach < ENSEMBLE_QUEUE_GROUP; reach *= 2u) {
    uvec2 below = lane >= reach ? sums[lane - reach] : uvec2(0u);
    barrier();
    sums[lane] += below;
    barrier();
  }
  return sums[lane] - own;
}

void writeDraw(uint queue) {
  GpuQueueItem item = items[queue];
  uint length = totals[queue].count;
  uint of_batch = totals[queue].rank - totals[item.first_of_batch].rank;
  if (length > 0u) {
    uint at = item.first_of_batch + of_batch;
    commands[at].index_count = item.index_count;
    commands[at].instance_count = length;
    commands[at].first_index = item.first_index;
    commands[at].vertex_offset = item.vertex_offset;
    commands[at].first_instance = totals[queue].offset;
    draws[at] = item.draw;
  }
  bool ends_batch = queue + 1u == push.queue_count || items[queue + 1u].batch != item.batch;
  if (ends_batch) draw_counts[item.batch] = of_batch + (length > 0u ? 1u : 0u);
}

void main() {
  uint per_lane = (push.queue_count + ENSEMBLE_QUEUE_GROUP - 1u) / ENSEMBLE_QUEUE_GROUP;
  uint first = min(gl_LocalInvocationID.x * per_lane, push.queue_count);
  uint end = min(first + per_lane, push.queue_count);
  uvec2 own = uvec2(0u);
  for (uint queue = first; queue < end; ++queue) {
    uint length = totals[queue].count;
    own += uvec2(length, length > 0u ? 1u : 0u);
  }
  uvec2 before = sumBefore(own);
  for (uint queue = first; queue < end; ++queue) {
    uint length = totals[queue].count;
    totals[queue].offset = before.x;
    totals[queue].rank = before.y;
    before += uvec2(length, length > 0u ? 1u : 0u);
  }
  memoryBarrierBuffer();
  barrier();
  for (uint queue = first; queue < end; ++queue) writeDraw(queue);
}
