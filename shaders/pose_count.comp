// How many people of each group are to be posed: those in the tile, those who cast alone; and how many are in the
// picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/queue_types.h"
#include "shaders/queue_sets.glsl"
#include "shaders/queue_masks.glsl"
#include "shaders/pose_queues.glsl"

void main() {
  clearMasks();
  enterPoses(ownVerdict());
  writeLengths();
}
