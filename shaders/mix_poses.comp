// Poses between two key frames of a clip, for one person each, from the kept vertices at both.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/raster_types.h"
#include "shaders/shared/vertex.h"
#include "shaders/kept_vertex.glsl"
#include "shaders/group_number.glsl"

layout(local_size_x = ENSEMBLE_SKIN_GROUP) in;

layout(set = 0, binding = ENSEMBLE_BINDING_SKIN_JOBS, std430) readonly buffer Jobs { GpuSkinJob jobs[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_SKIN_GROUPS, std430) readonly buffer Groups { GpuSkinGroup groups[]; };
layout(set = 0, binding = ENSEMBLE_BINDING_SKIN_POSES, std430) writeonly buffer Poses { uvec2 poses[]; };
layout(set = 1, binding = ENSEMBLE_BINDING_MIX_POSES) uniform usamplerBuffer poses_before;
layout(set = 2, binding = ENSEMBLE_BINDING_MIX_POSES) uniform usamplerBuffer poses_after;

layout(push_constant) uniform Push { uint first_group, group_count; };

void main() {
  uint number = groupNumber();
  if (number >= group_count) return;
  GpuSkinGroup group = groups[first_group + number];
  GpuSkinJob job = jobs[group.job];
  uint end = min(group.first_vertex + ENSEMBLE_SKIN_RUN, job.vertex_count);
  [[dont_unroll]] for (uint v = group.first_vertex + gl_LocalInvocationID.x; v < end; v += ENSEMBLE_SKIN_GROUP) {
    uvec2 before = texelFetch(poses_before, int(job.first_vertex + v)).xy;
    uvec2 after = texelFetch(poses_after, int(job.first_matrix + v)).xy;
    poses[job.pose + v] = keepVertex(mix(keptPosition(before), keptPosition(after), job.box.x),
                                     mix(keptNormal(before), keptNormal(after), job.box.x));
  }
}
