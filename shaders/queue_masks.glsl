// Which people of a group are in which queue, a bit each, so that a person's place follows from the bits below
// its own, in whatever order invocations run. Included after queue_sets.glsl.
layout(local_size_x = ENSEMBLE_QUEUE_GROUP) in;

shared uint masks[ENSEMBLE_QUEUE_RANGE * ENSEMBLE_QUEUE_WORDS];

uint lane() { return gl_LocalInvocationIndex; }
uint group() { return gl_WorkGroupID.x; }
uint personOfLane() { return group() * ENSEMBLE_QUEUE_GROUP + lane(); }
/// The first queue that this group is about.
uint firstQueue() { return gl_WorkGroupID.y * ENSEMBLE_QUEUE_RANGE; }
uint queuesOfRange() { return min(push.queue_count - firstQueue(), uint(ENSEMBLE_QUEUE_RANGE)); }

void clearMasks() {
  for (uint i = lane(); i < queuesOfRange() * ENSEMBLE_QUEUE_WORDS; i += ENSEMBLE_QUEUE_GROUP) masks[i] = 0u;
  barrier();
}

/// @param queue of the range
void enter(uint queue) { atomicOr(masks[queue * ENSEMBLE_QUEUE_WORDS + lane() / 32u], 1u << (lane() % 32u)); }

uint lengthOf(uint queue) {
  uint length = 0u;
  for (uint word = 0u; word < ENSEMBLE_QUEUE_WORDS; ++word)
    length += uint(bitCount(masks[queue * ENSEMBLE_QUEUE_WORDS + word]));
  return length;
}

/// How many of the group stand in a queue before this invocation's person.
uint placeIn(uint queue) {
  uint own = lane() / 32u, place = 0u;
  for (uint word = 0u; word < ENSEMBLE_QUEUE_WORDS; ++word) {
    uint mask = masks[queue * ENSEMBLE_QUEUE_WORDS + word];
    if (word == own) mask &= (1u << (lane() % 32u)) - 1u;
    if (word <= own) place += uint(bitCount(mask));
  }
  return place;
}

/// Notes down the lengths of the range's queues.
void writeLengths() {
  barrier();
  for (uint queue = lane(); queue < queuesOfRange(); queue += ENSEMBLE_QUEUE_GROUP)
    counts[group() * push.queue_count + firstQueue() + queue] = lengthOf(queue);
}
