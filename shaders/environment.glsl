// The material of a piece of the environment. Included after crowd_types.h.
layout(set = ENSEMBLE_SET_ENVIRONMENT_TEXTURE, binding = 0) uniform sampler2DArray base_color_textures;
layout(push_constant) uniform Push { GpuStaticMaterial material; };

layout(constant_id = ENSEMBLE_CONSTANT_TEXTURED) const bool kTextured = false;
layout(constant_id = ENSEMBLE_CONSTANT_CUT_OUT) const bool kCutOut = false;

// Base colour with its texture, linear; discards what an alpha mask cuts out.
vec4 baseColor(vec2 uv) {
  vec4 color = material.base_color;
  if (kTextured) color *= texture(base_color_textures, vec3(uv, float(material.texture_layer)));
  if (kCutOut && color.a < material.alpha_cutoff) discard;
  return color;
}
