// Writes people into the queues of what they show, ascending by number.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/queue_types.h"
#include "shaders/queue_sets.glsl"
#include "shaders/queue_masks.glsl"
#include "shaders/queue_people.glsl"

layout(set = 0, binding = ENSEMBLE_BINDING_QUEUE_ENTRIES, std430) writeonly buffer Entries { uint entries[]; };

shared uint group_begins[ENSEMBLE_QUEUE_RANGE];

void main() {
  clearMasks();
  uvec2 own = ownShown();
  enterShown(own);
  for (uint queue = lane(); queue < queuesOfRange(); queue += ENSEMBLE_QUEUE_GROUP) {
    uint number = firstQueue() + queue;
    group_begins[queue] = totals[number].offset + counts[group() * push.queue_count + number];
  }
  barrier();
  for (uint i = own.x; i < own.y; ++i) {
    uint queue = shown[i] - firstQueue();
    entries[group_begins[queue] + placeIn(queue)] = personOfLane();
  }
}
