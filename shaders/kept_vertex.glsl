// A vertex as poses keep it: 15 bits for each coordinate, 19 for the normal. Included after raster_types.h and
// vertex.h.

// Whole numbers.
vec3 keptPosition(uvec2 kept) {
  const uint mask = (1u << ENSEMBLE_POSE_POSITION_BITS) - 1u;
  return vec3(float(kept.x & mask), float((kept.x >> ENSEMBLE_POSE_POSITION_BITS) & mask), float(kept.y & mask));
}

vec3 keptNormal(uvec2 kept) {
  uint n = (kept.x >> 30) | (kept.y >> ENSEMBLE_POSE_POSITION_BITS) << 2;
  const uint most_x = (1u << ENSEMBLE_POSE_NORMAL_X_BITS) - 1u, most_y = (1u << ENSEMBLE_POSE_NORMAL_Y_BITS) - 1u;
  vec2 e = vec2(float(n & most_x) / float(most_x), float(n >> ENSEMBLE_POSE_NORMAL_X_BITS) / float(most_y));
  return decodeOctahedral(e * 2.0 - 1.0);
}

// @param position in steps of the box, rounded here
uvec2 keepVertex(vec3 position, vec3 normal) {
  const float most = float((1u << ENSEMBLE_POSE_POSITION_BITS) - 1u);
  uvec3 q = uvec3(clamp(position + 0.5, 0.0, most));
  vec2 n = encodeOctahedral(normal) * 0.5 + 0.5;
  uint nx = uint(n.x * float((1u << ENSEMBLE_POSE_NORMAL_X_BITS) - 1u) + 0.5);
  uint ny = uint(n.y * float((1u << ENSEMBLE_POSE_NORMAL_Y_BITS) - 1u) + 0.5);
  uint packed_normal = nx | ny << ENSEMBLE_POSE_NORMAL_X_BITS;  // 2 bits in the first word, 17 in the second
  return uvec2(q.x | q.y << 15 | packed_normal << 30, q.z | packed_normal >> 2 << 15);
}
