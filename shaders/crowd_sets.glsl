// What the shaders that draw people read. Included after crowd_types.h.
layout(set = ENSEMBLE_SET_VIEW, binding = ENSEMBLE_BINDING_VIEW, std140) uniform ViewBlock { GpuView view; };

layout(set = ENSEMBLE_SET_CROWD, binding = ENSEMBLE_BINDING_CHARACTERS, std430) readonly buffer Characters {
  GpuCharacter characters[];
};
// world_from_model of each person's joints: three rows each. A texel buffer: where shaders run on the
// CPU it is read faster than a storage buffer.
layout(set = ENSEMBLE_SET_CROWD, binding = ENSEMBLE_BINDING_PALETTE) uniform samplerBuffer palette;
layout(set = ENSEMBLE_SET_CROWD, binding = ENSEMBLE_BINDING_QUEUE, std430) readonly buffer Queue {
  uint queue[];  // characters, one sub-mesh's queue after the other
};
layout(set = ENSEMBLE_SET_CROWD, binding = ENSEMBLE_BINDING_DRAWS, std430) readonly buffer Draws {
  GpuDraw draws[];
};

// The draw in what crowd.vert passes on.
uint drawNumber(uint draw_and_part) { return draw_and_part & ((1u << ENSEMBLE_DRAW_BITS) - 1u); }

layout(push_constant) uniform Push { uint first_draw; };
