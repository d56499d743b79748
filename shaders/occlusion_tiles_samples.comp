// The depth pyramid's first level, several samples a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/raster_types.h"
#include "shaders/occlusion_sets.glsl"

layout(set = 0, binding = ENSEMBLE_BINDING_OCCLUSION_DEPTH) uniform sampler2DMS depth_picture;

float drawnDepth(ivec2 at, int number) { return texelFetch(depth_picture, at, number).x; }
#include "shaders/occlusion_tiles.glsl"
