// Shades listed pixels of the compute rasteriser into the linear picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/shared/raster_types.h"
#include "shaders/shared/vertex.h"
#include "shaders/raster_sets.glsl"
#include "shaders/raster_pixels.glsl"
#include "shaders/raster_surface.glsl"
layout(constant_id = ENSEMBLE_CONSTANT_SHADOWS) const bool kShadows = true;
#define HAS_SHADOWS kShadows
#include "shaders/lighting.glsl"

layout(local_size_x = ENSEMBLE_LIST_GROUP) in;
layout(constant_id = ENSEMBLE_CONSTANT_TEXTURED) const bool kTextured = false;

layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_MATERIALS) uniform usamplerBuffer materials;
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_TINTS) uniform samplerBuffer tints;
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_PICTURE, rgba16f) uniform writeonly image2D picture;
layout(set = ENSEMBLE_SET_RASTER, binding = ENSEMBLE_BINDING_RASTER_SHADED, std430) writeonly buffer Shaded {
  uvec2 shaded[];  // of each sample of the band: four halves
};
layout(set = ENSEMBLE_SET_TEXTURE, binding = 0) uniform sampler2DArray base_color_textures;

vec4 tintColor(uint number) { return texelFetch(tints, int(number)); }
#include "shaders/person_shading.glsl"

GpuMaterial readMaterial(uint number) {
  int texel = int(number) * 4;
  uvec4 a = texelFetch(materials, texel + 2), b = texelFetch(materials, texel + 3);
  GpuMaterial m;
  m.base_color = uintBitsToFloat(texelFetch(materials, texel));
  m.tint = uintBitsToFloat(texelFetch(materials, texel + 1));
  m.tint_first = a.x;
  m.tint_count = a.y;
  m.tint_key = a.z;
  m.texture_layer = a.w;
  m.alpha_cutoff = uintBitsToFloat(b.x);
  m.tint_spread = uintBitsToFloat(b.y);
  m.sheen = uintBitsToFloat(b.z);
  m.lower_tint_count = b.w;
  return m;
}

void shade(uvec4 listed) {
  Surface s = surfaceAt(listed, kTextured);
  GpuMaterial material = readMaterial(s.item_1.x);
  vec4 color = material.base_color;
  if (kTextured) {
    color *= textureGrad(base_color_textures, vec3(s.uv, float(material.texture_layer)), s.uv_right, s.uv_down);
  }
  uint part = (texelFetch(vertices, int(s.first_vertex * 5u + 3u)).x & 0xffffu) >> ENSEMBLE_JOINT_BITS;
  vec3 albedo = tinted(color.rgb, material, s.person.z, part);
  vec3 normal = normalize(s.is_front ? s.normal : -s.normal);
  vec3 lit = litPerson(albedo, material.sheen, s.world, normal);
  if (kSamples == 1) {
    imageStore(picture, ivec2(s.pixel % width, s.pixel / width), vec4(lit, 1.0));
  } else {
    uvec2 halves = uvec2(packHalf2x16(lit.rg), packHalf2x16(vec2(lit.b, 1.0)));
    for (uint i = 0u; i < 4u; ++i) {
      if ((s.samples & (1u << i)) != 0u) shaded[4u * (s.pixel - first_pixel) + i] = halves;
    }
  }
}

void main() { FOR_LISTED_PIXELS(shade); }
