// Lists the samples at which somebody rasterised in compute is in front of all that the graphics pipeline drew:
// an entry for each person and face that a pixel shows. drawnDepth(pixel, sample) is declared before.
void listSamples(uint pixel, uvec2 key, uint samples) {
  uint id = ~key.x;
  uvec4 person = texelFetch(who, int(id >> face_bits));
  uvec3 item = itemOfFace(person.x, id & ((1u << face_bits) - 1u));
  uvec4 first = texelFetch(items, int(item.x * ENSEMBLE_RASTER_ITEM_TEXELS));
  uint of_bin = first.w + (poseOf(person, item, first.z) >> ENSEMBLE_POSE_OFFSET_BITS) * bin;  // `bin`: bins of one buffer of poses
  atomicAdd(bins[of_bin].count, 1u);
  pixels[atomicAdd(bins[bin_count].count, 1u)] =
      uvec2(pixel | samples << ENSEMBLE_LISTED_PIXEL_BITS, item.x | of_bin << ENSEMBLE_LISTED_ITEM_BITS);
}

// At equal depth people come before ground and environment.
bool isInFront(uint pixel, int number, uvec2 key) {
  return key.y != 0u && uintBitsToFloat(key.y) >= drawnDepth(ivec2(pixel % width, pixel / width), number);
}

void listPixel(uint pixel) {
  if (kSamples == 1) {
    uvec2 key = visible[pixel];
    if (isInFront(pixel, 0, key)) listSamples(pixel, key, 1u);
    return;
  }
  uvec2 keys[4];
  uint open = 0u;
  for (int i = 0; i < 4; ++i) {
    keys[i] = visible[4u * pixel + i];
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

void main() {
  uint number = (gl_WorkGroupID.y * ENSEMBLE_RASTER_GROUPS_X + gl_WorkGroupID.x) * ENSEMBLE_LIST_GROUP + gl_LocalInvocationID.x;
  if (number < pixel_count) listPixel(first_pixel + number);
}
