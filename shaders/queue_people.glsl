// The queues that a person of a pass is in: those of the sub-meshes that its combination shows. Included after
// queue_masks.glsl.
// Per combination, range after range: where its sub-meshes of that range begin; they end where the next begin.
layout(set = 0, binding = ENSEMBLE_BINDING_QUEUE_RANGES, std430) readonly buffer Ranges { uint ranges[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_QUEUE_SHOWN, std430) readonly buffer Shown { uint shown[]; };

/// Where the sub-meshes of an invocation's person begin and end; nowhere for who is not queued.
uvec2 ownShown() {
  uint person = personOfLane();
  uint verdict = person < push.person_count ? verdicts[person] : 0u;
  if ((verdict & push.verdict) == 0u) return uvec2(0u);
  uint at = (verdict >> ENSEMBLE_VERDICT_BITS) * gl_NumWorkGroups.y + gl_WorkGroupID.y;
  return uvec2(ranges[at], ranges[at + 1u]);
}

void enterShown(uvec2 own) {
  for (uint i = own.x; i < own.y; ++i) enter(shown[i] - firstQueue());
}
