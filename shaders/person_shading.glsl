// A person's colour from its material, tint and place: the same for both rasterisers. Included after
// lighting.glsl; vec4 tintColor(uint) is declared before.

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
  vec3 tint = tintColor(material.tint_first + h % count).rgb * material.tint.rgb;
  float brightness = 1.0 + material.tint_spread * (float(hashBits(h) >> 8) * (2.0 / 16777216.0) - 1.0);
  return color * mix(vec3(1.0), tint * brightness, material.tint.a);
}

// Light on a tinted surface. @param normal unit, towards the viewer's side
vec3 litPerson(vec3 albedo, float sheen_strength, vec3 world, vec3 normal) {
  vec3 from_camera = world - view.camera.xyz;
  float facing = clamp(-dot(normal, normalize(from_camera)), 0.0, 1.0);
  float sun = max(dot(normal, view.to_sun.xyz), 0.0) * sunShare3(world, normal);
  vec3 light = view.sun_color.rgb * sun + ambient(normal);
  float edge = (1.0 - facing) * (1.0 - facing);
  vec3 sheen = sheen_strength * edge * edge * light;
  return faded(albedo * light + sheen, from_camera);
}
