// What the compute rasteriser's shaders read. Included after raster_types.h. Texel buffers where lanes read here
// and there: where shaders run on the CPU they are read faster than storage buffers.
#include "shaders/shared/vertex.h"
#include "shaders/kept_vertex.glsl"
#include "shaders/group_number.glsl"

layout(set = ENSEMBLE_SET_VIEW, binding = ENSEMBLE_BINDING_VIEW, std140) uniform ViewBlock { GpuView view; };

layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_PEOPLE) uniform samplerBuffer people;
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_WHO) uniform usamplerBuffer who;
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_INDICES) uniform usamplerBuffer indices;  // words of 32 bits
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_POSES) uniform usamplerBuffer poses;

layout(push_constant) uniform Push {
  uint first_group;  // of a dispatch
  uint group_count;
  uint face_bits;  // of a face's number in its person, in an id
  uint width;      // of the target, pixels
  uint height;
  float near_plane;  // to the sun: the slope bias
  uint bin;
  uint bin_count;
  uint first_pixel;  // of the band
  uint pixel_count;
  uint wide_indices;  // 1: an index has 32 bits, 0: 16
};

layout(constant_id = ENSEMBLE_CONSTANT_SAMPLES) const int kSamples = 1;  // 1 or 4

// The first of the pixels that this invocation is for, counted from the band's or the list's beginning.
uint firstPixelOfInvocation() {
  return groupNumber() * ENSEMBLE_GROUP_PIXELS + gl_LocalInvocationID.x;
}

// The first of the run of neighbours that this invocation is for.
uint firstOfRun() {
  return groupNumber() * ENSEMBLE_GROUP_PIXELS + gl_LocalInvocationID.x * ENSEMBLE_LIST_RUN;
}

// The corners of a triangle. @param index the number of its first one in the buffer of indices
uvec3 cornersAt(uint index) {
  // Texels of 16 bits would take far longer to read where shaders run on the CPU.
  bool is_wide = wide_indices != 0u;
  int word = int(is_wide ? index : index >> 1);
  uvec3 words = uvec3(texelFetch(indices, word).x, texelFetch(indices, word + 1).x, texelFetch(indices, is_wide ? word + 2 : word).x);
  uvec3 from_low = uvec3(words.x & 0xffffu, words.x >> 16, words.y & 0xffffu);
  uvec3 from_high = uvec3(words.x >> 16, words.y & 0xffffu, words.y >> 16);
  return is_wide ? words : (index & 1u) != 0u ? from_high : from_low;
}
