// A person's vertex in the world: the blend of its joints' matrices (Lister, Laycock, Day, equation 1).
layout(location = ENSEMBLE_ATTRIBUTE_POSITION) in vec3 model_position;
layout(location = ENSEMBLE_ATTRIBUTE_JOINTS) in uvec4 joints;
layout(location = ENSEMBLE_ATTRIBUTE_WEIGHTS) in vec4 weights;

struct WorldFromModel {
  vec4 row_0, row_1, row_2;
};

// `precise`: the passes must cover the same pixels, whatever else their shaders compute.
//
// The pose pass has multiplied world_from_model into the palette already. Four joints always: where
// a shader runs on the CPU a branch is a mask, and skipping a joint of weight 0 saves nothing.
WorldFromModel blendedJoints(uint first_joint) {
  uvec4 at = (uvec4(first_joint) + (joints & ((1u << ENSEMBLE_JOINT_BITS) - 1u))) * 3u;
  precise WorldFromModel m;
  m.row_0 = texelFetch(palette, int(at.x)) * weights.x + texelFetch(palette, int(at.y)) * weights.y + texelFetch(palette, int(at.z)) * weights.z +
            texelFetch(palette, int(at.w)) * weights.w;
  m.row_1 = texelFetch(palette, int(at.x + 1)) * weights.x + texelFetch(palette, int(at.y + 1)) * weights.y + texelFetch(palette, int(at.z + 1)) * weights.z +
            texelFetch(palette, int(at.w + 1)) * weights.w;
  m.row_2 = texelFetch(palette, int(at.x + 2)) * weights.x + texelFetch(palette, int(at.y + 2)) * weights.y + texelFetch(palette, int(at.z + 2)) * weights.z +
            texelFetch(palette, int(at.w + 2)) * weights.w;
  return m;
}

vec3 worldPosition(WorldFromModel m) {
  vec4 p = vec4(model_position, 1.0);
  precise vec3 world = vec3(dot(m.row_0, p), dot(m.row_1, p), dot(m.row_2, p));
  return world;
}
