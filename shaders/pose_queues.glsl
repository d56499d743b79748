// The queues of poses: bits of a verdict. Included after queue_masks.glsl.
void enterPoses(uint verdict) {
  for (uint queue = 0u; queue < ENSEMBLE_POSE_QUEUES; ++queue) {
    if ((verdict >> (ENSEMBLE_FIRST_POSE_BIT + queue) & 1u) != 0u) enter(queue);
  }
}

uint ownVerdict() { return personOfLane() < push.person_count ? verdicts[personOfLane()] : 0u; }
