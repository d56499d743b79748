// Lists the samples at which somebody rasterised in compute is in front of all that the graphics pipeline drew:
// an entry for each person and face that a pixel shows. drawnDepth(pixel, sample) is declared before.
//
// An invocation has a run of pixels. It first finds out which of them show somebody, so that it takes a place in the
// list once for all; where shaders run on the CPU all lanes do what one has to do, hence each goes on to its next
// pixel that has something to do.

// What is seen at the samples of a pixel. @return bits: at which of them it is in front
uint openSamples(uint pixel, uint width_of_rows, out uvec2 keys[kSamples]) {
  uint open = 0u;
  ivec2 at = ivec2(pixel % width_of_rows, pixel / width_of_rows);
  for (int i = 0; i < kSamples; ++i) {
    keys[i] = texelFetch(seen, int(pixel) * kSamples + i).xy;
    // At equal depth people come before ground and environment.
    bool is_in_front = keys[i].y != 0u && uintBitsToFloat(keys[i].y) >= drawnDepth(at, i);
    open |= uint(is_in_front) << i;
  }
  return open;
}

// Of the open samples those that show what the first of them does.
uint alikeSamples(uint open, uvec2 keys[kSamples]) {
  if (kSamples == 1) return open;
  uint id = keys[findLSB(open)].x, alike = 0u;
  for (int i = 0; i < kSamples; ++i) alike |= (open & (1u << i)) != 0u && keys[i].x == id ? 1u << i : 0u;
  return alike;
}

uint entriesOf(uint pixel, uint width_of_rows) {
  uvec2 keys[kSamples];
  uint open = openSamples(pixel, width_of_rows, keys);
  if (kSamples == 1) return open;
  uint entries = 0u;
  while (open != 0u) {
    open &= ~alikeSamples(open, keys);
    ++entries;
  }
  return entries;
}

// Whether somebody is at a pixel, in front or not.
bool isSeen(uint pixel) {
  uint depths = 0u;
  for (int i = 0; i < kSamples; ++i) depths |= texelFetch(seen, int(pixel) * kSamples + i).y;
  return depths != 0u;
}

// Entries of one bin that follow each other are counted at once.
struct BinRun {
  uint bin, count;
};

void countRun(BinRun run) {
  if (run.count != 0u) atomicAdd(bins[run.bin].count, run.count);
}

void listSamples(uint place, uint pixel, uint id, uint samples, uint bits_of_face, uint bins_of_poses,
                 inout BinRun run) {
  uvec4 person = texelFetch(who, int(id >> bits_of_face));
  uvec3 item = itemOfFace(person.x, id & ((1u << bits_of_face) - 1u));
  uvec4 first = texelFetch(items, int(item.x * ENSEMBLE_RASTER_ITEM_TEXELS));
  uint pose = poseOf(person, item, first.z);
  uint of_bin = first.w + (pose >> ENSEMBLE_POSE_OFFSET_BITS) * bins_of_poses;
  pixels[place] = uvec4(pixel | samples << ENSEMBLE_LISTED_PIXEL_BITS, item.x | of_bin << ENSEMBLE_LISTED_ITEM_BITS,
                        id - item.y, pose & ((1u << ENSEMBLE_POSE_OFFSET_BITS) - 1u));
  if (of_bin != run.bin) {
    countRun(run);
    run = BinRun(of_bin, 0u);
  }
  ++run.count;
}

void main() {
  uint first = first_pixel + firstOfRun(), end = min(first + ENSEMBLE_LIST_RUN, first_pixel + pixel_count);
  uint width_of_rows = width;
  uint open_pixels = 0u, entries = 0u;
  [[dont_unroll]] for (uint pixel = first;; ++pixel) {
    [[dont_unroll]] while (pixel < end && !isSeen(pixel)) ++pixel;
    if (pixel >= end) break;
    uint more = entriesOf(pixel, width_of_rows);
    open_pixels |= uint(more != 0u) << (pixel - first);
    entries += more;
  }
  if (entries == 0u) return;

  uint place = atomicAdd(bins[bin_count].count, entries);
  uint bits_of_face = face_bits, bins_of_poses = bin;
  BinRun run = BinRun(0u, 0u);
  [[dont_unroll]] for (; open_pixels != 0u; open_pixels &= open_pixels - 1u) {
    uint pixel = first + uint(findLSB(open_pixels));
    uvec2 keys[kSamples];
    uint open = openSamples(pixel, width_of_rows, keys);
    [[dont_unroll]] for (;;) {
      uint alike = alikeSamples(open, keys);
      listSamples(place++, pixel, ~keys[kSamples == 1 ? 0 : findLSB(open)].x, alike, bits_of_face, bins_of_poses, run);
      open &= ~alike;
      if (open == 0u) break;
    }
  }
  countRun(run);
}
