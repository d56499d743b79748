// The texture is a cylinder around the head, unrolled, with more room for the face than for the back.
// Features are drawn where people_head.cpp puts them, in metres of the reference head.
#include "assetpipe/people_skin.h"

#include <algorithm>
#include <cmath>

#include "core/color.h"
#include "core/image_file.h"

namespace ensemble {
namespace {

constexpr std::uint32_t kSide = 512;
constexpr float kAxisZ = -0.010f;               // the cylinder's axis, metres of the reference head
constexpr float kTop = 0.110f, kTall = 0.300f;  // v = 0 at kTop, 1 at kTop - kTall
constexpr float kFront = 1.6f;                  // the front is this much wider than the average
constexpr float kSoft = 0.0007f;                // metres, about a texel

/// 1 where `inside` is positive, 0 outside, with an edge as wide as `soft` on either side; metres.
float cover(float inside, float soft = kSoft) { return smoothStep(-soft, soft, inside); }

float bump(float x, float width) { return std::exp(-x * x / (width * width)); }

/// Paints one texel: layers of colour over skin.
class FacePaint {
 public:
  FacePaint(const Figure& figure, const PersonColors& colors)
      : skin_(colors.skin),
        hair_(colors.hair),
        female_(figure.isFemale()),
        old_(figure.options.age == AgeGroup::kOld),
        young_(figure.options.age == AgeGroup::kYoung) {}

  /// @param angle from the front, 0 to pi; left and right are alike. @param y up, of the reference head
  Vec3 at(float angle, float y) {
    color_ = skin_;
    angle_ = angle;
    y_ = y;
    paintCrop();
    if (angle > radians(80.0f)) return color_;
    paintFlush();
    if (old_) paintLines();
    paintLips();
    paintBrow();
    paintEye();
    return color_;
  }

 private:
  /// How far to the side a texel lies where the face is `depth` in front of the ears.
  float sideAt(float depth) const { return std::tan(angle_) * (depth - kAxisZ); }
  void layer(const Vec3& color, float alpha) {
    color_ = glm::mix(color_, color, std::clamp(alpha, 0.0f, 1.0f));
  }

  /// Hair cut to a millimetre or two: it makes a bare head, and the skin under a wig, a person's.
  void paintCrop() {
    const float front = std::cos(angle_), side = std::sin(angle_);
    // High over the forehead, down before the ear, around it, and to the nape.
    const float temple = smoothStep(0.30f, 0.95f, side) * (front > 0.0f ? 1.0f : 0.0f);
    float line = 0.058f - 0.012f * side * side - 0.052f * temple * smoothStep(0.5f, 1.0f, side);
    if (front <= 0.0f) line = glm::mix(0.002f, -0.062f, smoothStep(0.05f, 0.75f, -front));
    if (old_ && !female_) line += 0.035f * smoothStep(-0.1f, 0.5f, front);
    layer(glm::mix(hair_, skin_ * 0.30f, 0.4f), 0.62f * cover(y_ - line, 0.009f));
  }

  void paintFlush() {
    const Vec3 red = skin_ * Vec3(1.02f, 0.80f, 0.78f), dark = skin_ * Vec3(0.70f, 0.66f, 0.70f);
    const float x = sideAt(0.070f);
    layer(red, 0.55f * bump(x - 0.046f, 0.022f) * bump(y_ + 0.038f, 0.022f));
    layer(red, 0.40f * bump(sideAt(0.108f), 0.012f) * bump(y_ + 0.045f, 0.012f));
    // The socket lies in shade, more so in age.
    layer(dark, (old_ ? 0.55f : 0.38f) * bump(sideAt(0.080f) - 0.030f, 0.017f) * bump(y_ + 0.008f, 0.013f));
    layer(dark * 0.35f, 0.75f * cover(0.0030f - std::hypot(sideAt(0.100f) - 0.0062f, 1.5f * (y_ + 0.0545f))));
    if (female_ || young_) return;
    const float jaw = smoothStep(-0.052f, -0.072f, y_) * smoothStep(-0.150f, -0.125f, y_);
    layer(glm::mix(skin_, hair_, 0.5f), 0.16f * jaw * smoothStep(1.35f, 1.0f, angle_));
  }

  void paintLines() {
    const Vec3 dark = skin_ * Vec3(0.62f, 0.56f, 0.55f);
    for (int i = 0; i < 3; ++i) {
      const float height = 0.032f + 0.0095f * static_cast<float>(i);
      layer(dark, 0.30f * bump(y_ - height + 2.0f * sideAt(0.085f) * sideAt(0.085f), 0.0010f) *
                      smoothStep(0.040f, 0.030f, sideAt(0.085f)));
    }
    // From the wings of the nose to the corners of the mouth; and the bags of the eyes.
    const float fold = 0.019f + 0.32f * (-0.050f - y_);
    layer(dark, 0.50f * bump(sideAt(0.090f) - fold, 0.0013f) * smoothStep(-0.094f, -0.082f, y_) *
                    smoothStep(-0.046f, -0.054f, y_));
    const float x = sideAt(0.084f) - 0.032f;
    layer(dark,
          0.38f * bump(y_ + 0.0185f - 12.0f * x * x, 0.0010f) * smoothStep(0.016f, 0.010f, std::abs(x)));
  }

  void paintLips() {
    const float half = female_ ? 0.0245f : 0.0250f, t = sideAt(0.0945f) / half;
    if (t >= 1.0f) return;
    const float line = -0.0832f - 0.0008f * t * t, full = (female_ ? 1.10f : 0.85f) * (old_ ? 0.75f : 1.0f);
    const float bow = std::sqrt(1.0f - t * t) * (1.0f - 0.14f * bump(t, 0.16f));
    const float top = line + 0.0082f * full * bow * (1.0f - 0.25f * t),
                low = line - 0.0095f * full * (1.0f - t * t);
    const Vec3 lip = skin_ * (female_ ? Vec3(0.88f, 0.46f, 0.48f) : Vec3(0.82f, 0.58f, 0.58f));
    const float within = std::min(top - y_, y_ - low);
    layer(lip, (old_ ? 0.65f : 0.85f) * cover(within, 0.0012f));
    layer(lip * 0.28f, 0.85f * bump(y_ - line, 0.0009f) * (1.0f - smoothStep(0.80f, 1.0f, t)));
  }

  void paintBrow() {
    const float x = sideAt(0.0790f), t = (x - 0.0120f) / 0.0390f;
    if (t <= 0.0f || t >= 1.0f) return;
    const float thick = (female_ ? 0.0025f : 0.0037f) * (1.0f - 0.70f * t) * smoothStep(0.0f, 0.12f, t);
    const float arch = (female_ ? 0.0165f : 0.0140f) + 0.0045f * std::sin(kPi * 0.80f * t) - 0.0030f * t;
    const float hairs = 0.92f + 0.08f * std::sin(1400.0f * x + 700.0f * y_);
    layer(hair_ * 0.8f, 0.88f * hairs * cover(thick - std::abs(y_ - arch), 0.0010f));
  }

  void paintEye() {
    constexpr float kMiddle = 0.0322f, kHalf = 0.0150f, kHeight = -0.0078f;
    const float x = sideAt(0.0845f) - kMiddle, t = x / kHalf;
    if (std::abs(t) > 1.35f) return;
    const float open = (female_ ? 1.08f : 0.94f) * (old_ ? 0.86f : 1.0f) * (young_ ? 1.05f : 1.0f);
    const float tilt = kHeight + 0.0010f * t;
    const float round = std::max(1.0f - t * t, 0.0f), fuller = std::pow(round, 0.75f);
    const float upper = tilt + 0.0064f * open * fuller, lower = tilt - 0.0046f * open * round;
    // The fold of the lid.
    layer(skin_ * Vec3(0.55f, 0.48f, 0.47f),
          0.55f * bump(y_ - upper - 0.0034f, 0.0010f) * std::min(1.0f, 2.0f * round));
    const float within = std::abs(t) < 1.0f ? std::min(upper - y_, y_ - lower) : -1.0f;
    const float shade = 0.72f + 0.28f * smoothStep(0.0f, 0.0035f, upper - y_);
    layer(Vec3(0.62f, 0.58f, 0.55f) * shade, cover(within));
    const float iris = std::hypot(x, y_ - (tilt + 0.0012f));
    const Vec3 brown(0.055f, 0.030f, 0.017f);
    const float inside = cover(within);
    layer(brown * 0.4f * shade, inside * cover(0.0060f - iris));
    layer(brown * 2.2f * shade, inside * cover(0.0050f - iris));
    layer(Vec3(0.004f), inside * cover(0.0024f - iris));
    layer(Vec3(0.85f), inside * cover(0.0011f - std::hypot(x + 0.0018f, y_ - (tilt + 0.0034f))));
    // Lashes: dark above, faint below.
    const float lash = (female_ ? 0.0015f : 0.0010f) * (0.7f + 0.5f * std::max(t, 0.0f));
    const float rim = smoothStep(1.12f, 1.0f, std::abs(t));
    layer(Vec3(0.012f, 0.008f, 0.006f),
          0.92f * rim * cover(lash - std::abs(y_ - upper - 0.4f * lash), 0.0006f));
    layer(skin_ * 0.30f, 0.45f * rim * cover(0.0006f - std::abs(y_ - lower), 0.0006f));
  }

  const Vec3 skin_, hair_;
  const bool female_, old_, young_;
  Vec3 color_{0.0f};
  float angle_ = 0.0f, y_ = 0.0f;
};

}  // namespace

Vec2 headUv(const Figure& figure, const Vec3& position, bool right) {
  const Vec3 place = (position - figure.head_center) / figure.head_size;
  const float part = std::atan2(std::abs(place.x), place.z - kAxisZ) / kPi;
  const float around = 0.5f * (kFront * part - (kFront - 1.0f) * part * part);
  return {right ? 0.5f - around : 0.5f + around, std::clamp((kTop - place.y) / kTall, 0.0f, 1.0f)};
}

RawImage paintHead(const Figure& figure, const PersonColors& colors) {
  Image8 image;
  image.width = image.height = kSide;
  image.rgba.resize(std::size_t{4} * kSide * kSide, 255);
  FacePaint paint(figure, colors);
  for (std::uint32_t row = 0; row < kSide; ++row) {
    const float y = kTop - kTall * (static_cast<float>(row) + 0.5f) / kSide;
    for (std::uint32_t column = 0; column < kSide / 2; ++column) {
      // Both halves at once, from the front outwards; headUv solved for the angle.
      const float around = 2.0f * (static_cast<float>(column) + 0.5f) / kSide;
      constexpr float kCurve = kFront - 1.0f;
      const float part =
          (kFront - std::sqrt(std::max(kFront * kFront - 4.0f * kCurve * around, 0.0f))) / (2.0f * kCurve);
      const Vec3 color = paint.at(part * kPi, y);
      for (const std::uint32_t x : {kSide / 2 + column, kSide / 2 - 1 - column}) {
        for (int i = 0; i < 3; ++i) {
          const float value = std::clamp(srgbFromLinear(color[i]) * 255.0f + 0.5f, 0.0f, 255.0f);
          image.rgba[4 * (std::size_t{row} * kSide + x) + static_cast<std::size_t>(i)] =
              static_cast<std::uint8_t>(value);
        }
      }
    }
  }
  RawImage result;
  result.name = "skin.head";
  result.mime_type = "image/png";
  result.bytes = encodePng(image);
  result.width = result.height = kSide;
  return result;
}

}  // namespace ensemble
