// Counters that many lanes count by: one atomic for all lanes of a subgroup that count alike. Included after
// raster_pixels.glsl.
#extension GL_KHR_shader_subgroup_ballot : require

// Adds the calling lanes to the count of all pixels. @return each lane's number
uint addToAll() {
  uvec4 lanes = subgroupBallot(true);
  uint first = 0u;
  if (subgroupElect()) first = atomicAdd(bins[bin_count].count, subgroupBallotBitCount(lanes));
  return subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(lanes);
}

// Adds each lane to the count of its bin.
void addToBin(uint of_bin) {
  bool is_counted = false;
  do {
    uint one = subgroupBroadcastFirst(of_bin);
    if (of_bin == one) {
      uvec4 lanes = subgroupBallot(true);
      if (subgroupElect()) atomicAdd(bins[one].count, subgroupBallotBitCount(lanes));
      is_counted = true;
    }
  } while (!is_counted);
}

// The next place in each lane's bin.
uint nextInBin(uint of_bin) {
  uint place = 0u;
  bool is_placed = false;
  do {
    uint one = subgroupBroadcastFirst(of_bin);
    if (of_bin == one) {
      uvec4 lanes = subgroupBallot(true);
      uint first = 0u;
      if (subgroupElect()) first = atomicAdd(bins[one].cursor, subgroupBallotBitCount(lanes));
      place = subgroupBroadcastFirst(first) + subgroupBallotExclusiveBitCount(lanes);
      is_placed = true;
    }
  } while (!is_placed);
  return place;
}
