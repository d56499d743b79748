// One sun with a shadow map, and light from the sky and the ground. Linear colours.
layout(set = ENSEMBLE_SET_VIEW, binding = ENSEMBLE_BINDING_SHADOW_MAP) uniform sampler2DShadow shadow_map;

// Where a point lies in the shadow map: texels, and depth. Shifted along the normal, so that a surface
// does not shade itself, the more the flatter the sun falls on it.
vec3 shadowPlace(vec3 world, vec3 normal) {
  float facing = max(dot(normal, view.to_sun.xyz), 0.0);
  float slope = sqrt(max(1.0 - facing * facing, 0.0));
  vec3 p = world + normal * (view.ray_y.w * (0.5 + 1.5 * slope));
  vec3 shadow = (view.shadow_from_world * vec4(p, 1.0)).xyz;
  // The map's depth holds the people, not the ground beyond them.
  return vec3((shadow.xy * 0.5 + 0.5) * view.to_sun.w, clamp(shadow.z, 0.0, 1.0));
}

#ifndef HAS_SHADOWS
#define HAS_SHADOWS true  // false only where there are none: view.ray_x.w tells for those who don't know
#endif

// The share of the sun that arrives at a point: tents over the shadow map, made of bilinear samples
// whose places and weights follow from the tent's integral (after Castano, "Shadow Mapping Summary",
// 2013). People, who are small, have 3 x 3 texels from 4 samples; the ground 5 x 5 from 9.
float sunShare3(vec3 world, vec3 normal) {
  if (!HAS_SHADOWS) return 1.0;
  vec3 place = shadowPlace(world, normal);
  vec2 base = floor(place.xy + 0.5);
  vec2 st = place.xy + 0.5 - base;
  base -= 0.5;
  vec2 low_weight = 3.0 - 2.0 * st, high_weight = 1.0 + 2.0 * st;
  float texel = 1.0 / view.to_sun.w;
  vec2 low = (base + (2.0 - st) / low_weight - 1.0) * texel;
  vec2 high = (base + st / high_weight + 1.0) * texel;
  float sum = low_weight.x * low_weight.y * texture(shadow_map, vec3(low, place.z)) +
              high_weight.x * low_weight.y * texture(shadow_map, vec3(high.x, low.y, place.z)) +
              low_weight.x * high_weight.y * texture(shadow_map, vec3(low.x, high.y, place.z)) +
              high_weight.x * high_weight.y * texture(shadow_map, vec3(high, place.z));
  return mix(1.0, sum / 16.0, view.ray_x.w);
}

float sunShare5(vec3 world, vec3 normal) {
  vec3 place = shadowPlace(world, normal);
  vec2 base = floor(place.xy + 0.5);
  vec2 st = place.xy + 0.5 - base;
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
      sum += weight_x[i] * weight_y[j] * texture(shadow_map, vec3(uv, place.z));
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
