// What the pixels of the compute rasteriser show. Included after raster_sets.glsl.
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_SEEN) uniform usamplerBuffer seen;  // of each sample: id, inverted; depth
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_VERTICES) uniform usamplerBuffer vertices;
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_ITEMS) uniform usamplerBuffer items;
// Per combination: where its items begin below, and how many they are. Then per combination and item: the item
// and the number of its first face in the person, and the first vertex of its mesh in a pose of the person's own.
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_SHOWN) uniform usamplerBuffer shown;
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_POSE_TABLE) uniform usamplerBuffer pose_table;
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_PIXELS, std430) buffer Pixels {
  // Pixel and samples; item and bin; person and triangle of the item, as in an id; first vertex of its pose.
  // First those found, then the same sorted by bin.
  uvec4 pixels[];
};
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_LISTED) uniform usamplerBuffer listed_pixels;  // the same
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_BINS, std430) buffer Bins {
  GpuRasterBin bins[];  // the last is of all
};

// The item that a face of a person belongs to, the item's first face, and its vertices in a pose of its own.
uvec3 itemOfFace(uint combination, uint face) {
  uvec2 range = texelFetch(shown, int(combination)).xy;
  uint low = 0u, count = range.y;
  // The last item that begins no later. As many steps for all lanes: a loop's end is a test of all.
  while (count > 1u) {
    uint half_count = count / 2u;
    bool later = texelFetch(shown, int(range.x + low + half_count)).y <= face;
    low += later ? half_count : 0u;
    count -= half_count;
  }
  return texelFetch(shown, int(range.x + low)).xyz;
}

// Where the pose of an item on a person lies: the buffer, and below it the first vertex.
uint poseOf(uvec4 person, uvec3 shown_item, uint first_pose) {
  bool is_own = (person.y & ENSEMBLE_OWN_POSE) != 0u;
  uint at_key = texelFetch(pose_table, is_own ? 0 : int(first_pose + person.y)).x;
  return is_own ? (person.y & ~ENSEMBLE_OWN_POSE) + shown_item.z : at_key;
}
