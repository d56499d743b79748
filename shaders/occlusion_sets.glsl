// What the passes share that find out what the first round hides. Included after raster_types.h.
#include "shaders/group_number.glsl"

layout(set = 0, binding = ENSEMBLE_BINDING_OCCLUSION_PYRAMID, std430) buffer Pyramid {
  float pyramid[];  // the least depth of a texel's pixels, level after level; 0: the background shows
};

layout(push_constant) uniform Push {
  uint width;  // of the target, pixels
  uint height;
  uint level;        // to be made
  uint first_group;  // of the second round
  uint group_count;  // likewise
  uint face_bits;
  uint batch_count;
  uint triangles_per_group;
  float near_plane;
  uint hides;  // 0: everything is drawn
};

// Of as many groups of ENSEMBLE_OCCLUSION_GROUP as it takes.
uint invocationNumber() { return groupNumber() * ENSEMBLE_OCCLUSION_GROUP + gl_LocalInvocationID.x; }

uvec2 levelSize(uint number) {
  uint side = ENSEMBLE_PYRAMID_TILE << number;
  return (uvec2(width, height) + side - 1u) / side;
}

uint levelFirst(uint number) {
  uint first = 0u;
  for (uint i = 0u; i < number; ++i) {
    uvec2 size = levelSize(i);
    first += size.x * size.y;
  }
  return first;
}
