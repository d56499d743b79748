// Leaves out of the environment's shadow what an alpha mask cuts out.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/crowd_types.h"
#include "shaders/environment.glsl"

layout(location = 0) in vec2 uv;

void main() { baseColor(uv); }
