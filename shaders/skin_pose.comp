// Skins meshes and packs them: at key frames once for all people who come by that pose (the pose cache), or for
// one person between them, whose joints are in the palette.
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
layout(set = 0, binding = ENSEMBLE_BINDING_SKIN_VERTICES) uniform usamplerBuffer vertices;  // GpuVertex: 5 texels
layout(set = 0, binding = ENSEMBLE_BINDING_SKIN_POSES, std430) writeonly buffer Poses { uvec2 poses[]; };
layout(set = 1, binding = ENSEMBLE_BINDING_SKIN_ANIMATION) uniform sampler2D animation;
layout(set = 1, binding = ENSEMBLE_BINDING_SKIN_PALETTE) uniform samplerBuffer palette;
layout(constant_id = ENSEMBLE_CONSTANT_OWN_POSES) const bool kOwnPoses = false;

layout(push_constant) uniform Push { uint first_group, group_count; };

vec4 matrixRow(uint matrix, uint row) {
  uint texel = matrix * 3u + row;
  if (kOwnPoses) return texelFetch(palette, int(texel));
  return texelFetch(animation, ivec2(texel % ENSEMBLE_ANIMATION_WIDTH, texel / ENSEMBLE_ANIMATION_WIDTH), 0);
}

void skin(GpuSkinJob job, uint vertex) {
  int texel = int(job.first_vertex + vertex) * 5;
  uvec2 xy = texelFetch(vertices, texel).xy, zn = texelFetch(vertices, texel + 1).xy;
  uvec2 joints = texelFetch(vertices, texel + 3).xy, weights = texelFetch(vertices, texel + 4).xy;
  vec4 position = vec4(uintBitsToFloat(xy.x), uintBitsToFloat(xy.y), uintBitsToFloat(zn.x), 1.0);
  vec3 normal = decodeOctahedral(unpackSnorm2x16(zn.y));
  uvec4 joint = uvec4(joints.x & 0xffffu, joints.x >> 16, joints.y & 0xffffu, joints.y >> 16);
  joint &= (1u << ENSEMBLE_JOINT_BITS) - 1u;  // the garment part stands above
  vec4 weight = vec4(unpackUnorm2x16(weights.x), unpackUnorm2x16(weights.y));
  vec4 row[3];
  for (uint i = 0u; i < 3u; ++i) {
    row[i] = matrixRow(job.first_matrix + joint.x, i) * weight.x + matrixRow(job.first_matrix + joint.y, i) * weight.y +
             matrixRow(job.first_matrix + joint.z, i) * weight.z + matrixRow(job.first_matrix + joint.w, i) * weight.w;
  }
  vec3 posed = vec3(dot(row[0], position), dot(row[1], position), dot(row[2], position));
  vec3 turned = vec3(dot(row[0].xyz, normal), dot(row[1].xyz, normal), dot(row[2].xyz, normal));
  poses[job.pose + vertex] = keepVertex((posed - job.box.xyz) * job.box.w, turned);
}

void main() {
  uint number = groupNumber();
  if (number >= group_count) return;
  GpuSkinGroup group = groups[first_group + number];
  GpuSkinJob job = jobs[group.job];
  uint end = min(group.first_vertex + ENSEMBLE_SKIN_RUN, job.vertex_count);
  [[dont_unroll]] for (uint v = group.first_vertex + gl_LocalInvocationID.x; v < end; v += ENSEMBLE_SKIN_GROUP) skin(job, v);
}
