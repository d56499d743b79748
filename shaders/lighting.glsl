// One sun with a shadow map, and light from the sky and the ground. Linear colours.
layout(set = ENSEMBLE_SET_VIEW, binding = ENSEMBLE_BINDING_SHADOW_MAP) uniform sampler2DShadow shadow_map;

// The share of the sun that arrives at a point, by a 5 x 5 tent over the shadow map made of nine
// bilinear samples (after Castano, "Shadow Mapping Summary", 2013).
float sunShare(vec3 world, vec3 normal) {
  float slope = sqrt(max(1.0 - pow(max(dot(normal, view.to_sun.xyz), 0.0), 2.0), 0.0));
  vec3 p = world + normal * (view.ray_y.w * (0.5 + 1.5 * slope));
  vec3 shadow = (view.shadow_from_world * vec4(p, 1.0)).xyz;
  shadow.z = clamp(shadow.z, 0.0, 1.0);  // the map's depth holds the people, not the ground
  vec2 at = (shadow.xy * 0.5 + 0.5) * view.to_sun.w;
  vec2 base = floor(at + 0.5);
  vec2 st = at + 0.5 - base;
  base -= 0.5;
  vec3 weight_x = vec3(4.0 - 3.0 * st.x, 7.0, 1.0 + 3.0 * st.x);
  vec3 weight_y = vec3(4.0 - 3.0 * st.y, 7.0, 1.0 + 3.0 * st.y);
  vec3 x = vec3((3.0 - 2.0 * st.x) / weight_x.x - 2.0, (3.0 + st.x) / 7.0, st.x / weight_x.z + 2.0);
  vec3 y = vec3((3.0 - 2.0 * st.y) / weight_y.x - 2.0, (3.0 + st.y) / 7.0, st.y / weight_y.z + 2.0);
  float texel = 1.0 / view.to_sun.w;
  float sum = 0.0;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      vec2 uv = (base + vec2(x[i], y[j])) * texel;
      sum += weight_x[i] * weight_y[j] * texture(shadow_map, vec3(uv, shadow.z));
    }
  }
  return mix(1.0, sum / 144.0, view.ray_x.w);
}

vec3 ambient(vec3 normal) {
  return mix(view.ambient_down.rgb, view.ambient_up.rgb, normal.y * 0.5 + 0.5);
}

// Distance fades into the horizon.
vec3 faded(vec3 color, vec3 from_camera) {
  float d = length(from_camera) / view.ray_origin.w;
  return mix(color, view.horizon.rgb, 1.0 - exp(-d * d));
}

// The sky behind everything, by the height of the view ray.
vec3 skyColor(vec3 ray) {
  float up = clamp(normalize(ray).y, 0.0, 1.0);
  vec3 gradient = mix(view.horizon.rgb, view.zenith.rgb, 1.0 - pow(1.0 - up, 3.0));
  return mix(view.horizon.rgb, gradient, view.sun_color.w);
}
