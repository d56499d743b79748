// A view: from where, how large, on what background (design 6). No Vulkan.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "core/image_file.h"
#include "core/scene.h"
#include "renderer/frame_names.h"
#include "renderer/frame_stats.h"

namespace ensemble {

/// Some kinds of AOV.
class AovSet {
 public:
  AovSet() = default;
  AovSet(std::initializer_list<Aov> aovs) {
    for (const Aov aov : aovs) add(aov);
  }
  void add(Aov aov) { bits_ |= bit(aov); }
  bool has(Aov aov) const { return (bits_ & bit(aov)) != 0; }
  bool empty() const { return bits_ == 0; }

 private:
  static unsigned bit(Aov aov) { return 1u << static_cast<unsigned>(aov); }
  unsigned bits_ = 0;
};

struct View {
  SceneCamera camera;
  SceneLight light;
  bool ground = true;  ///< not drawn on a transparent background
  std::uint32_t width = 1280, height = 720;
  std::uint32_t samples = 4;  ///< 1 or 4
  RasterKind raster = RasterKind::kAuto;
  DebugKind debug = DebugKind::kNone;  ///< laid over Picture::color alone
  CullingKind culling = CullingKind::kAuto;
  bool occlusion = false;   ///< who is hidden by nearer people is left out of the compute rasteriser
  float snap_below = 0.0f;  ///< pixels: who is smaller on the screen is shown at the nearest key frame
  BackgroundKind background = BackgroundKind::kSky;
  Vec3 background_color{0.0f};  ///< sRGB, for BackgroundKind::kColor
  AovSet aovs;
  bool linear = false;    ///< Picture::linear is wanted too
  bool coverage = false;  ///< Picture::coverage is wanted too

  bool drawsGround() const { return ground && background != BackgroundKind::kTransparent; }
};

/// The view that a scene asks for at a time.
View viewOf(const Scene& scene, double seconds = 0.0);

/// A view's pictures; rows from the top. Given again, its memory is used again.
struct Picture {
  Image8 color;
  /// Where the view asks for it: linear light, RGBA, half-precision bits, 4 per pixel, colour multiplied
  /// by alpha. The same picture as `color`, before it was clamped and encoded.
  std::vector<std::uint16_t> linear;
  // AOVs, empty unless asked for; one sample at each pixel's centre.
  std::vector<std::uint32_t> character;  ///< 0: nobody; else 1 + number
  std::vector<std::uint32_t> region;     ///< 1 + the template's region; garments after (AovNumbers)
  std::vector<std::uint32_t> face;       ///< 1 + the face's number in its source file
  std::vector<float> depth;              ///< metres along the view axis; 0: nothing there
  std::vector<float> normal;             ///< world space, 3 per pixel; 0: nothing there
  /// Where the view asks for it: pixels that each person would cover if nothing stood in front, by the
  /// rules of the AOVs; #people of the crowd. Empty otherwise.
  std::vector<std::uint32_t> coverage;
  FrameStats stats;
};

}  // namespace ensemble
