// How many people of each group show each sub-mesh (Lister, Laycock and Day, section 4, in parallel).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/queue_types.h"
#include "shaders/queue_sets.glsl"
#include "shaders/queue_masks.glsl"
#include "shaders/queue_people.glsl"

void main() {
  clearMasks();
  enterShown(ownShown());
  writeLengths();
}
