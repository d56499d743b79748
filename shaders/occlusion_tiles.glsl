// The pyramid's first level: of each tile of pixels the least depth. drawnDepth(pixel, sample) is declared before.
layout(local_size_x = ENSEMBLE_OCCLUSION_GROUP) in;

layout(set = 0, binding = ENSEMBLE_BINDING_OCCLUSION_SEEN) uniform usamplerBuffer seen;  // of each sample: id; depth
layout(constant_id = ENSEMBLE_CONSTANT_SAMPLES) const int kSamples = 1;
layout(constant_id = ENSEMBLE_CONSTANT_DRAWN) const bool kDrawn = false;

// Once there is background, a tile is done.
void main() {
  uvec2 size = levelSize(0u);
  uint tile = invocationNumber();
  uvec2 low = ENSEMBLE_PYRAMID_TILE * uvec2(tile % size.x, tile / size.x);
  uvec2 high = min(low + ENSEMBLE_PYRAMID_TILE, uvec2(width, height));
  uvec2 at = low;
  float least = tile < size.x * size.y ? 1.0e30 : 0.0;
  [[dont_unroll]] while (least > 0.0 && at.y < high.y) {
    int sample_0 = int(at.y * width + at.x) * kSamples;
    for (int i = 0; i < kSamples; ++i) {
      float depth = uintBitsToFloat(texelFetch(seen, sample_0 + i).y);
      if (kDrawn) depth = max(depth, drawnDepth(ivec2(at), i));
      least = min(least, depth);
    }
    bool wraps = at.x + 1u == high.x;
    at = wraps ? uvec2(low.x, at.y + 1u) : uvec2(at.x + 1u, at.y);
  }
  if (tile < size.x * size.y) pyramid[tile] = least;
}
