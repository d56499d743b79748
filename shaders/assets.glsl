// Materials, tints and faces, for fragment shaders. Included after crowd_sets.glsl.
layout(set = ENSEMBLE_SET_ASSETS, binding = ENSEMBLE_BINDING_MATERIALS, std430) readonly buffer Materials {
  GpuMaterial materials[];
};
layout(set = ENSEMBLE_SET_ASSETS, binding = ENSEMBLE_BINDING_TINTS, std430) readonly buffer Tints {
  vec4 tints[];  // linear colours, those of each kind side by side
};
layout(set = ENSEMBLE_SET_ASSETS, binding = ENSEMBLE_BINDING_HIDDEN_FIRST, std430) readonly buffer HiddenFirst {
  uint hidden_first[];  // per combination: its first word below
};
layout(set = ENSEMBLE_SET_ASSETS, binding = ENSEMBLE_BINDING_HIDDEN_WORDS, std430) readonly buffer HiddenWords {
  uint hidden_words[];  // one bit per template face, set where hidden
};
layout(set = ENSEMBLE_SET_ASSETS, binding = ENSEMBLE_BINDING_SOURCE_FACES, std430) readonly buffer SourceFaces {
  uint source_faces[];  // per face of the index lists of this mesh chunk
};
layout(set = ENSEMBLE_SET_TEXTURE, binding = 0) uniform sampler2DArray base_color_textures;

layout(constant_id = ENSEMBLE_CONSTANT_TEXTURED) const bool kTextured = false;
layout(constant_id = ENSEMBLE_CONSTANT_CUT_OUT) const bool kCutOut = false;
layout(constant_id = ENSEMBLE_CONSTANT_HIDE_FACES) const bool kHideFaces = false;

// Base colour with its texture, linear; discards what an alpha mask cuts out.
vec4 baseColor(GpuMaterial material, vec2 uv) {
  vec4 color = material.base_color;
  if (kTextured) color *= texture(base_color_textures, vec3(uv, float(material.texture_layer)));
  if (kCutOut && color.a < material.alpha_cutoff) discard;
  return color;
}

// The number of this fragment's face in its source file (for the template: in the template).
uint sourceFace(GpuDraw draw_data) {
  return source_faces[draw_data.first_face + uint(gl_PrimitiveID)] + draw_data.face_offset;
}

// PCG output function (O'Neill 2014) as a hash of 32 bits.
uint hashBits(uint x) {
  uint state = x * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}

// What a person's tint does to a material's colour. A suit's parts have tints of their own.
vec3 tinted(vec3 color, GpuMaterial material, uint tint_seed, uint part) {
  if (material.tint_count == 0u) return color;
  bool is_lower = part != 0u && material.lower_tint_count != 0u;
  uint count = is_lower ? material.lower_tint_count : material.tint_count;
  uint h = hashBits(tint_seed ^ (material.tint_key + (is_lower ? part * 0x9e3779b9u : 0u)));
  vec3 tint = tints[material.tint_first + h % count].rgb * material.tint.rgb;
  float brightness = 1.0 + material.tint_spread * (float(hashBits(h) >> 8) * (2.0 / 16777216.0) - 1.0);
  return color * mix(vec3(1.0), tint * brightness, material.tint.a);
}
