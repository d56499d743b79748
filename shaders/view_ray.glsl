// The view ray through this fragment: by its place in the whole picture, of which the target may hold a
// tile. Whole numbers are added, so that a tile's rays are those of the picture to the last bit.
vec3 viewRay() {
  vec2 at = gl_FragCoord.xy + vec2(view.ambient_down.w, view.horizon.w);
  return view.ray_origin.xyz + at.x * view.ray_x.xyz + at.y * view.ray_y.xyz;
}
