// Rasterises small triangles: lanes hold triangles of one mesh in one pose, in a loop over the people who come by
// that pose. A sample keeps the greatest of (depth, person, face), so that the order of work does not matter and
// equal depths go to the lower person and face.
//
// Where shaders run on the CPU a branch is a mask and a loop's body runs at least once: hence loops that end at
// their end, and no tests around what costs little.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/raster_types.h"
#include "shaders/raster_sets.glsl"

layout(local_size_x_id = ENSEMBLE_CONSTANT_LANES) in;  // one subgroup
layout(constant_id = ENSEMBLE_CONSTANT_TO_SUN) const bool kToSun = false;
layout(constant_id = ENSEMBLE_CONSTANT_CUT_OUT) const bool kCutOut = false;
layout(constant_id = ENSEMBLE_CONSTANT_HIDE_FACES) const bool kHideFaces = false;
// Counts how often each sample is covered, instead of keeping what is in front.
layout(constant_id = ENSEMBLE_CONSTANT_COUNTS) const bool kCounts = false;

layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_ENTRIES, std430) readonly buffer Entries {
  uint entries[];  // id of the person's first face of the item
};
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_WORK, std430) readonly buffer AllWork {
  GpuRasterWork all_work[];
};
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_GROUPS, std430) readonly buffer Groups {
  GpuRasterGroup groups[];
};
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_VERTICES) uniform usamplerBuffer vertices;
layout(set = ENSEMBLE_SET_ASSETS, binding = ENSEMBLE_BINDING_MATERIALS, std430) readonly buffer Materials {
  GpuMaterial materials[];
};
layout(set = ENSEMBLE_SET_ASSETS, binding = ENSEMBLE_BINDING_HIDDEN_FIRST, std430) readonly buffer HiddenFirst {
  uint hidden_first[];
};
layout(set = ENSEMBLE_SET_ASSETS, binding = ENSEMBLE_BINDING_HIDDEN_WORDS, std430) readonly buffer HiddenWords {
  uint hidden_words[];
};
layout(set = ENSEMBLE_SET_ASSETS, binding = ENSEMBLE_BINDING_SOURCE_FACES, std430) readonly buffer SourceFaces {
  uint source_faces[];
};
layout(set = ENSEMBLE_SET_TEXTURE, binding = 0) uniform sampler2DArray base_color_textures;
// One of the three: to the camera depth and id, to the sun depth alone; how often a sample is covered.
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_TARGET, std430) buffer Visible { uint64_t visible[]; };
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_TARGET, std430) buffer SunDepth { uint sun_depth[]; };
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_TARGET, std430) buffer Counts { uint counts[]; };

const int kSubpixels = 1 << ENSEMBLE_SUBPIXEL_BITS;
// Where samples are, in sub-pixels from a pixel's centre: Vulkan's standard places for 4.
const ivec2 kPlaces[4] = ivec2[4](ivec2(-32, -96), ivec2(96, -32), ivec2(-96, 32), ivec2(32, 96));
const int kReach = kSamples == 1 ? 0 : 96;

struct Screen {
  ivec2 at;  // sub-pixels from the centre of pixel (0, 0)
  float depth;
  vec2 uv;  // for cut-outs
};

// What push constants say of the target. Read once: where shaders run on the CPU each reading takes as long as
// twenty additions, and stays inside of the loops that it is written in.
struct Target {
  ivec2 size;  // pixels
  float near_plane;
};

// Of the material that a group's triangles are cut out by.
struct CutOut {
  float alpha, cutoff, layer;
};

Screen toScreen(vec3 position, vec2 uv, vec4 row[3], Target target) {
  vec4 p = vec4(position, 1.0);
  vec3 c = vec3(dot(row[0], p), dot(row[1], p), dot(row[2], p));
  Screen s;
  s.uv = uv;
  if (kToSun) {
    s.at = ivec2(roundEven(c.xy));
    s.depth = c.z;
  } else {
    float q = 1.0 / c.z;
    s.at = ivec2(roundEven(c.xy * q));
    s.depth = target.near_plane * q;
  }
  return s;
}

// What a sample gets: depth in front of everything else, then the lower id.
void keep(int number, float depth, uint id) {
  if (kCounts) {
    atomicAdd(counts[number], 1u);
  } else if (kToSun) {
    atomicMax(sun_depth[number], floatBitsToUint(clamp(depth, 0.0, 1.0)));
  } else {
    atomicMax(visible[number], uint64_t(floatBitsToUint(depth)) << 32 | uint64_t(~id));
  }
}

// Texture coordinates where the edge functions of b and c are these. To the camera depth is near / w.
vec2 uvAt(Screen a, Screen b, Screen c, float per_area, vec2 e) {
  vec3 share = vec3(0.0, e * per_area);
  share.x = 1.0 - share.y - share.z;
  if (!kToSun) share *= vec3(a.depth, b.depth, c.depth);
  return (share.x * a.uv + share.y * b.uv + share.z * c.uv) / (share.x + share.y + share.z);
}

// Whether a mask cuts out a pixel, decided at its centre as in a graphics pipeline.
bool isCutOut(CutOut mask, Screen a, Screen b, Screen c, float per_area, ivec3 e, ivec3 right, ivec3 down) {
  vec2 uv = uvAt(a, b, c, per_area, vec2(e.yz));
  vec2 uv_right = uvAt(a, b, c, per_area, vec2(e.yz + right.yz)) - uv, uv_down = uvAt(a, b, c, per_area, vec2(e.yz + down.yz)) - uv;
  return mask.alpha * textureGrad(base_color_textures, vec3(uv, mask.layer), uv_right, uv_down).a < mask.cutoff;
}

// Fixed-point edge functions, top-left rule. Extents of a triangle are below 2^15 sub-pixels, since whoever has
// larger ones is drawn by the graphics pipeline; a leg bent beyond all bounds leaves its triangle out.
void rasterise(Target target, Screen a, Screen b, Screen c, bool double_sided, CutOut mask, uint id, bool is_there) {
  ivec2 ab = b.at - a.at, ac = c.at - a.at;
  int area = ac.x * ab.y - ac.y * ab.x;
  // From behind all areas are the negative ones.
  int flip = double_sided ? area >> 31 : 0;
  area = (area ^ flip) - flip;
  ab = (ab ^ flip) - flip;
  ac = (ac ^ flip) - flip;
  ivec2 least = min(a.at, min(b.at, c.at)), greatest = max(a.at, max(b.at, c.at));
  ivec2 low = max((least + (kSubpixels - 1 - kReach)) >> ENSEMBLE_SUBPIXEL_BITS, 0);
  ivec2 high = min((greatest + kReach) >> ENSEMBLE_SUBPIXEL_BITS, target.size - 1);
  bool fits = ((greatest.x - least.x) | (greatest.y - least.y)) < 1 << 15;
  if (is_there && fits && area > 0 && low.x <= high.x && low.y <= high.y) {
    ivec2 bc = ac - ab, from = low << ENSEMBLE_SUBPIXEL_BITS;
    // Twice the areas opposite of b and c, and of a, at the first pixel; steps to the right and down.
    int e_b = ac.y * (a.at.x - from.x) - ac.x * (a.at.y - from.y);
    int e_c = ab.x * (a.at.y - from.y) - ab.y * (a.at.x - from.x);
    int e_a = area - e_b - e_c;
    ivec3 by_x = ivec3(bc.y, -ac.y, ab.y), by_y = ivec3(-bc.x, ac.x, -ab.x);
    ivec3 right = by_x << ENSEMBLE_SUBPIXEL_BITS, down = by_y << ENSEMBLE_SUBPIXEL_BITS;
    float per_area = 1.0 / float(area);
    float by_b = (b.depth - a.depth) * per_area, by_c = (c.depth - a.depth) * per_area;
    float nearest = a.depth;
    if (kToSun) {
      vec2 slope = abs(vec2(by_b * float(right.y) + by_c * float(right.z), by_b * float(down.y) + by_c * float(down.z)));
      nearest += target.near_plane * max(slope.x, slope.y);
    }
    // An edge owns its points where it is a left one, or level and a top one.
    ivec3 owned = ivec3(greaterThan((by_x << 16) + by_y, ivec3(0))) - 1;
    ivec3 e = ivec3(e_a, e_b, e_c) + owned;
    int columns = high.x - low.x, x = 0;
    ivec3 next_row = down - columns * right;
    int pixel = low.y * target.size.x + low.x, last = high.y * target.size.x + high.x, next_pixel = target.size.x - columns;
    [[dont_unroll]] for (;;) {
      bool is_cut = kCutOut && isCutOut(mask, a, b, c, per_area, e, right, down);
      if (kSamples == 1) {
        if ((e.x | e.y | e.z) >= 0 && !is_cut) keep(pixel, nearest + by_b * float(e.y) + by_c * float(e.z), id);
      } else {
        [[unroll]] for (int i = 0; i < 4; ++i) {
          ivec3 s = e + by_x * kPlaces[i].x + by_y * kPlaces[i].y;
          if ((s.x | s.y | s.z) >= 0 && !is_cut) keep(4 * pixel + i, nearest + by_b * float(s.y) + by_c * float(s.z), id);
        }
      }
      bool wraps = x == columns;
      x = wraps ? 0 : x + 1;
      pixel += wraps ? next_pixel : 1;
      e += wraps ? next_row : right;
      if (pixel > last) break;
    }
  }
}

CutOut cutOutOf(uint number) {
  CutOut mask = CutOut(1.0, 0.0, 0.0);
  if (kCutOut) {
    GpuMaterial material = materials[number];
    mask = CutOut(material.base_color.a, material.alpha_cutoff, float(material.texture_layer));
  }
  return mask;
}

vec2 uvOf(uint vertex) {
  return kCutOut ? uintBitsToFloat(texelFetch(vertices, int(vertex * 5u + 2u)).xy) : vec2(0.0);
}

// Whether a face is hidden under what somebody wears. @param first_word of the person's combination
bool isHidden(uint first_word, uint face) {
  return kHideFaces && (hidden_words[first_word + (face >> 5)] & (1u << (face & 31u))) != 0u;
}

void main() {
  uint number = groupNumber();
  if (number >= group_count) return;
  GpuRasterGroup group = groups[first_group + number];
  if (group.work == ENSEMBLE_NO_WORK) return;
  GpuRasterWork work = all_work[group.work];
  const uint lanes = gl_WorkGroupSize.x, lane = gl_LocalInvocationID.x;
  uint triangle_end = min(group.first_triangle + lanes * ENSEMBLE_RASTER_RUN, work.triangle_count);
  bool double_sided = work.is_double_sided != 0u;
  CutOut mask = cutOutOf(work.material);

  Target target = Target(ivec2(width, height), near_plane);

  uint first_entry = 0u, bits_of_face = face_bits;
  [[dont_unroll]] for (;;) {
    uint entry = entries[group.first_entry + min(first_entry + lane, group.entry_count - 1u)];
    int rank = int(entry >> bits_of_face), person = rank * ENSEMBLE_PERSON_TEXELS;
    vec4 rows[3] = vec4[3](texelFetch(people, person), texelFetch(people, person + 1), texelFetch(people, person + 2));
    uint first_word = kHideFaces ? hidden_first[texelFetch(who, rank).x] : 0u;
    uint people_count = min(group.entry_count - first_entry, lanes);
    uint triangle = group.first_triangle;
    [[dont_unroll]] for (;;) {
      uint mine = min(triangle + lane, triangle_end - 1u);
      uvec3 index = cornersAt(work.first_index + 3u * mine);
      vec3 p = keptPosition(texelFetch(poses, int(work.pose + index.x)).xy);
      vec3 q = keptPosition(texelFetch(poses, int(work.pose + index.y)).xy);
      vec3 r = keptPosition(texelFetch(poses, int(work.pose + index.z)).xy);
      vec2 uv_p = uvOf(work.first_vertex + index.x), uv_q = uvOf(work.first_vertex + index.y),
           uv_r = uvOf(work.first_vertex + index.z);
      uint face = kHideFaces ? source_faces[work.first_face + mine] : 0u;
      uint j = 0u;
      [[dont_unroll]] for (;;) {
        vec4 row[3] = vec4[3](subgroupShuffle(rows[0], j), subgroupShuffle(rows[1], j), subgroupShuffle(rows[2], j));
        bool is_there = triangle + lane < triangle_end && !isHidden(subgroupShuffle(first_word, j), face);
        rasterise(target, toScreen(p, uv_p, row, target), toScreen(q, uv_q, row, target), toScreen(r, uv_r, row, target), double_sided, mask,
                  subgroupShuffle(entry, j) + mine, is_there);
        if (++j >= people_count) break;
      }
      triangle += lanes;
      if (triangle >= triangle_end) break;
    }
    first_entry += lanes;
    if (first_entry >= group.entry_count) break;
  }
}
