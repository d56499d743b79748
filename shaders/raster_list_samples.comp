// Lists what shows of the compute rasteriser, several samples a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/raster_types.h"
#include "shaders/raster_sets.glsl"
#include "shaders/raster_pixels.glsl"

layout(local_size_x = ENSEMBLE_LIST_GROUP) in;

layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_DEPTH) uniform sampler2DMS depth_picture;

float drawnDepth(ivec2 at, int number) { return texelFetch(depth_picture, at, number).x; }
#include "shaders/raster_list.glsl"
