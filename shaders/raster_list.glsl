// Lists the samples at which somebody rasterised in compute is in front of all that the graphics pipeline drew:
// an entry for each person and face that a pixel shows. drawnDepth(pixel, sample) is declared before.
void listSamples(uint pixel, uvec2 key, uint samples) {
  uint id = ~key.x;
  uvec4 person = texelFetch(who, int(id >> face_bits));
  uvec3 item = itemOfFace(person.x, id & ((1u << face_bits) - 1u));
  uvec4 first = texelFetch(items, int(item.x * ENSEMBLE_RASTER_ITEM_TEXELS));
  uint pose = poseOf(person, item, first.z);
  uint of_bin = first.w + (pose >> ENSEMBLE_POSE_OFFSET_BITS) * bin;  // `bin`: bins of one buffer of poses
  addToBin(of_bin);
  pixels[addToAll()] = uvec4(pixel | samples << ENSEMBLE_LISTED_PIXEL_BITS, item.x | of_bin << ENSEMBLE_LISTED_ITEM_BITS,
                             id - item.y, pose & ((1u << ENSEMBLE_POSE_OFFSET_BITS) - 1u));
}

// At equal depth people come before ground and environment.
bool isInFront(uint pixel, int number, uvec2 key) {
  return key.y != 0u && uintBitsToFloat(key.y) >= drawnDepth(ivec2(pixel % width, pixel / width), number);
}

void listPixel(uint pixel) {
  if (kSamples == 1) {
    uvec2 key = texelFetch(seen, int(pixel)).xy;
    if (isInFront(pixel, 0, key)) listSamples(pixel, key, 1u);
    return;
  }
  uvec2 keys[4];
  uint open = 0u;
  for (int i = 0; i < 4; ++i) {
    keys[i] = texelFetch(seen, int(4u * pixel) + i).xy;
    if (isInFront(pixel, i, keys[i])) open |= 1u << i;
  }
  while (open != 0u) {
    int first = findLSB(open);
    uint alike = 0u;
    for (int i = 0; i < 4; ++i) alike |= (open & (1u << i)) != 0u && keys[i].x == keys[first].x ? 1u << i : 0u;
    listSamples(pixel, keys[first], alike);
    open &= ~alike;
  }
}

// Whether somebody is at a pixel of the band, in front or not.
bool isSeen(uint number) {
  int sample_0 = int((first_pixel + number) * kSamples);
  uint depths = texelFetch(seen, sample_0).y;
  if (kSamples > 1) depths |= texelFetch(seen, sample_0 + 1).y | texelFetch(seen, sample_0 + 2).y | texelFetch(seen, sample_0 + 3).y;
  return depths != 0u;
}

// Where shaders run on the CPU all lanes do what one has to do: hence each goes on to its next pixel that has
// something to do.
void main() {
  uint number = firstPixelOfInvocation(), end = min(number + ENSEMBLE_GROUP_PIXELS, pixel_count);
  [[dont_unroll]] for (;;) {
    [[dont_unroll]] while (number < end && !isSeen(number)) number += ENSEMBLE_LIST_GROUP;
    if (number >= end) break;
    listPixel(first_pixel + number);
    number += ENSEMBLE_LIST_GROUP;
  }
}
