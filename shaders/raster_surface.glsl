// The surface at a listed pixel. Included after raster_pixels.glsl.
struct Surface {
  uint pixel;
  uint samples;  // bits
  uvec4 person;  // GpuRasterWho
  uvec4 item_0, item_1;
  uint triangle;      // of the item
  uint first_vertex;  // of the triangle, texels
  float depth;  // metres along the view axis
  vec3 world;
  vec3 normal;  // world space, towards the viewer's side of a front face; not of unit length
  bool is_front;
  vec2 uv;
  vec2 uv_right, uv_down;  // what a pixel more adds to it
};

const float kPixel = float(1 << ENSEMBLE_SUBPIXEL_BITS);

vec3 cornerOnScreen(int person, vec3 kept) {
  vec4 p = vec4(kept, 1.0);
  return vec3(dot(texelFetch(people, person), p), dot(texelFetch(people, person + 1), p), dot(texelFetch(people, person + 2), p));
}

// Perspective-correct shares of a triangle's corners at a place on the screen, in sub-pixels; and their sign.
vec3 sharesAt(vec3 a, vec3 b, vec3 c, vec2 at) {
  vec2 p = a.xy - at * a.z, q = b.xy - at * b.z, r = c.xy - at * c.z;
  return vec3(q.x * r.y - q.y * r.x, r.x * p.y - r.y * p.x, p.x * q.y - p.y * q.x);
}

// With one sample a shown pixel's centre lies in the triangle, whatever the rounding; with several it may lie
// beside it, where pipelines go on along the triangle's plane.
vec3 unitShares(vec3 shares) {
  shares /= shares.x + shares.y + shares.z;
  if (kSamples > 1) return shares;
  shares = clamp(shares, 0.0, 1.0);
  return shares / (shares.x + shares.y + shares.z);
}

vec2 vertexUv(uint vertex) {
  return uintBitsToFloat(texelFetch(vertices, int(vertex * 5u + 2u)).xy);
}

Surface surfaceAt(uvec4 listed, bool textured) {
  Surface s;
  s.pixel = listed.x & ((1u << ENSEMBLE_LISTED_PIXEL_BITS) - 1u);
  s.samples = listed.x >> ENSEMBLE_LISTED_PIXEL_BITS;
  int rank = int(listed.z >> face_bits), person = rank * ENSEMBLE_PERSON_TEXELS;
  s.person = texelFetch(who, rank);
  int item_texel = int((listed.y & ((1u << ENSEMBLE_LISTED_ITEM_BITS) - 1u)) * ENSEMBLE_RASTER_ITEM_TEXELS);
  s.item_0 = texelFetch(items, item_texel);
  s.item_1 = texelFetch(items, item_texel + 1);
  s.triangle = listed.z & ((1u << face_bits) - 1u);

  uint pose = listed.w;
  uvec3 index = cornersAt(s.item_0.x + 3u * s.triangle);
  uvec2 kept_a = texelFetch(poses, int(pose + index.x)).xy;
  uvec2 kept_b = texelFetch(poses, int(pose + index.y)).xy;
  uvec2 kept_c = texelFetch(poses, int(pose + index.z)).xy;
  vec3 a = keptPosition(kept_a), b = keptPosition(kept_b), c = keptPosition(kept_c);
  vec3 on_a = cornerOnScreen(person, a), on_b = cornerOnScreen(person, b), on_c = cornerOnScreen(person, c);
  vec2 at = vec2(float(s.pixel % width), float(s.pixel / width)) * kPixel;
  vec3 shares = sharesAt(on_a, on_b, on_c, at);
  s.is_front = shares.x + shares.y + shares.z < 0.0;
  vec3 part = unitShares(shares);
  s.depth = dot(part, vec3(on_a.z, on_b.z, on_c.z));

  vec4 place = vec4(a * part.x + b * part.y + c * part.z, 1.0);
  vec3 n = keptNormal(kept_a) * part.x + keptNormal(kept_b) * part.y + keptNormal(kept_c) * part.z;
  vec4 world[3] = vec4[3](texelFetch(people, person + 3), texelFetch(people, person + 4), texelFetch(people, person + 5));
  s.world = vec3(dot(world[0], place), dot(world[1], place), dot(world[2], place));
  s.normal = vec3(dot(world[0].xyz, n), dot(world[1].xyz, n), dot(world[2].xyz, n));
  s.first_vertex = s.item_0.y + index.x;
  if (textured) {
    vec2 uv_a = vertexUv(s.first_vertex), uv_b = vertexUv(s.item_0.y + index.y), uv_c = vertexUv(s.item_0.y + index.z);
    vec3 right = sharesAt(on_a, on_b, on_c, at + vec2(kPixel, 0.0)), down = sharesAt(on_a, on_b, on_c, at + vec2(0.0, kPixel));
    right /= right.x + right.y + right.z;
    down /= down.x + down.y + down.z;
    s.uv = uv_a * part.x + uv_b * part.y + uv_c * part.z;
    s.uv_right = uv_a * right.x + uv_b * right.y + uv_c * right.z - s.uv;
    s.uv_down = uv_a * down.x + uv_b * down.y + uv_c * down.z - s.uv;
  }
  return s;
}

// Calls shade(listed) for the pixels of `bin` that an invocation is for.
#define FOR_LISTED_PIXELS(shade)                                                                                 \
  uint first = bins[bin].first + firstPixelOfInvocation();                                                       \
  uint end = min(first + ENSEMBLE_GROUP_PIXELS, bins[bin].first + bins[bin].count);                              \
  [[dont_unroll]] for (uint number = first; number < end; number += ENSEMBLE_LIST_GROUP) \
    shade(texelFetch(listed_pixels, int(number)))
