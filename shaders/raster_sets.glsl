// What the compute rasteriser's shaders read. Included after raster_types.h. Texel buffers where lanes read here
// and there: where shaders run on the CPU they are read faster than storage buffers.
layout(set = ENSEMBLE_SET_VIEW, binding = ENSEMBLE_BINDING_VIEW, std140) uniform ViewBlock { GpuView view; };

layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_PEOPLE) uniform samplerBuffer people;
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_WHO) uniform usamplerBuffer who;
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_INDICES) uniform usamplerBuffer indices;
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
};

layout(constant_id = ENSEMBLE_CONSTANT_SAMPLES) const int kSamples = 1;  // 1 or 4

// A position as poses keep it: whole numbers.
vec3 keptPosition(uvec2 kept) {
  const uint mask = (1u << ENSEMBLE_POSE_POSITION_BITS) - 1u;
  return vec3(float(kept.x & mask), float((kept.x >> ENSEMBLE_POSE_POSITION_BITS) & mask), float(kept.y & mask));
}
