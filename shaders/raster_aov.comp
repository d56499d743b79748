// Numbers, depth and normal of the listed pixels of the compute rasteriser, as aov.frag writes them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/raster_types.h"
#include "shaders/shared/vertex.h"
#include "shaders/raster_sets.glsl"
#include "shaders/raster_pixels.glsl"
#include "shaders/raster_surface.glsl"

layout(local_size_x = ENSEMBLE_LIST_GROUP) in;

layout(set = ENSEMBLE_SET_ASSETS, binding = ENSEMBLE_BINDING_SOURCE_FACES, std430) readonly buffer SourceFaces {
  uint source_faces[];
};
layout(set = ENSEMBLE_SET_RASTER_AOVS, binding = ENSEMBLE_AOV_CHARACTER, r32ui) uniform writeonly uimage2D character;
layout(set = ENSEMBLE_SET_RASTER_AOVS, binding = ENSEMBLE_AOV_REGION, r32ui) uniform writeonly uimage2D region;
layout(set = ENSEMBLE_SET_RASTER_AOVS, binding = ENSEMBLE_AOV_FACE, r32ui) uniform writeonly uimage2D face;
layout(set = ENSEMBLE_SET_RASTER_AOVS, binding = ENSEMBLE_AOV_DEPTH, r32f) uniform writeonly image2D depth;
layout(set = ENSEMBLE_SET_RASTER_AOVS, binding = ENSEMBLE_AOV_NORMAL, rgba32f) uniform writeonly image2D normal;

void write(uvec4 listed) {
  Surface s = surfaceAt(listed, false);
  ivec2 at = ivec2(s.pixel % width, s.pixel / width);
  imageStore(character, at, uvec4(1u + s.person.w));
  imageStore(region, at, uvec4(s.item_1.y));
  imageStore(face, at, uvec4(1u + source_faces[s.item_1.z + s.triangle] + s.item_1.w));
  imageStore(depth, at, vec4(s.depth));
  imageStore(normal, at, vec4(normalize(s.is_front ? s.normal : -s.normal), 1.0));
}

void main() { FOR_LISTED_PIXELS(write); }
