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

vec4 tintColor(uint number) { return tints[number]; }
