// Eyes, brows and the line of the mouth: small patches that lie on the face's own triangles.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "assetpipe/people_garments.h"
#include "core/check.h"

namespace ensemble {
namespace {

enum Part : std::uint32_t { kEyeWhite, kIris, kLashes, kBrows, kPartCount };

/// Paints onto the face from the front. Points are x, y in metres of the reference head.
class FacePainter {
 public:
  FacePainter(const Figure& figure, const FieldMesh& body)
      : figure_(figure), body_(body), parts_(kPartCount) {
    for (const Triangle& face : body.faces) {
      const Vec3 a = onHead(body.positions[face[0]]);
      if (a.z > 0.0f && a.y > -0.13f && a.y < 0.08f) faces_.push_back(face);
    }
    for (std::uint32_t part = 0; part < kPartCount; ++part) parts_[part].material = part;
  }

  /// A strip between a lower and an upper line of equally many points, counter-clockwise from the front.
  void strip(Part part, const std::vector<Vec2>& lower, const std::vector<Vec2>& upper, float lift) {
    ENSEMBLE_CHECK(lower.size() == upper.size());
    for (const float side : {1.0f, -1.0f}) {
      std::vector<std::uint32_t> low, up;
      for (std::size_t i = 0; i < lower.size(); ++i) {
        low.push_back(add(part, lower[i] * Vec2(side, 1.0f), lift));
        const bool is_tip = lower[i] == upper[i];
        up.push_back(is_tip ? low.back() : add(part, upper[i] * Vec2(side, 1.0f), lift));
      }
      for (std::size_t i = 0; i + 1 < low.size(); ++i) {
        addFace(part, {low[i], low[i + 1], up[i + 1]}, side);
        addFace(part, {low[i], up[i + 1], up[i]}, side);
      }
    }
  }

  void disc(Part part, const Vec2& center, float radius, float lift) {
    constexpr int kCorners = 8;
    for (const float side : {1.0f, -1.0f}) {
      std::vector<std::uint32_t> ring;
      const std::uint32_t middle = add(part, center * Vec2(side, 1.0f), lift);
      for (int i = 0; i < kCorners; ++i) {
        const float angle = 2.0f * kPi * static_cast<float>(i) / kCorners;
        const Vec2 corner = center + radius * Vec2(std::cos(angle), std::sin(angle));
        ring.push_back(add(part, corner * Vec2(side, 1.0f), lift));
      }
      for (std::size_t i = 0; i < ring.size(); ++i)
        addFace(part, {middle, ring[i], ring[(i + 1) % ring.size()]}, side);
    }
  }

  std::vector<RawPrimitive> take() { return std::move(parts_); }

 private:
  Vec3 onHead(const Vec3& p) const { return (p - figure_.head_center) / figure_.head_size; }

  void addFace(Part part, Triangle face, float side) {
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) return;
    if (side < 0.0f) std::swap(face[1], face[2]);
    parts_[part].faces.push_back(face);
  }

  std::uint32_t add(Part part, const Vec2& at, float lift) {
    // The frontmost triangle of the face at this place.
    const Vec2 place = Vec2(figure_.head_center) + at * figure_.head_size;
    Vec3 hit(0.0f, 0.0f, -1.0f);
    for (const Triangle& face : faces_) {
      const Vec3 &a = body_.positions[face[0]], &b = body_.positions[face[1]], &c = body_.positions[face[2]];
      const float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
      if (area <= 0.0f) continue;  // seen from behind
      const float u = ((b.x - place.x) * (c.y - place.y) - (b.y - place.y) * (c.x - place.x)) / area;
      const float v = ((c.x - place.x) * (a.y - place.y) - (c.y - place.y) * (a.x - place.x)) / area;
      if (u < -1e-4f || v < -1e-4f || u + v > 1.0001f) continue;
      const Vec3 point = u * a + v * b + (1.0f - u - v) * c;
      if (point.z > hit.z) hit = point;
    }
    ENSEMBLE_CHECK(hit.z > 0.0f);
    RawVertex vertex;
    vertex.normal = fieldNormal([this](const Vec3& p) { return figure_.head(p); }, hit, 0.006f);
    vertex.position = hit + Vec3(0.0f, 0.0f, lift * figure_.head_size);
    vertex.uv = {0.5f + at.x, 0.5f - at.y};
    vertex.skin.joints[0] = kHead;
    vertex.skin.weights[0] = 1.0f;
    parts_[part].vertices.push_back(vertex);
    return static_cast<std::uint32_t>(parts_[part].vertices.size() - 1);
  }

  const Figure& figure_;
  const FieldMesh& body_;
  std::vector<Triangle> faces_;
  std::vector<RawPrimitive> parts_;
};

/// A line of points at x from the inner to the outer end, y by a function of t in 0 .. 1.
template <class Curve>
std::vector<Vec2> line(float from_x, float to_x, int count, Curve y) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(count - 1);
    points.emplace_back(std::lerp(from_x, to_x, t), y(t));
  }
  return points;
}

}  // namespace

MadeGarment makeFaceDetails(const Figure& figure, const FieldMesh& body, const Palette& palette) {
  FacePainter painter(figure, body);
  const bool female = figure.isFemale();
  constexpr float kInner = 0.0180f, kOuter = 0.0460f, kEye = -0.0095f;
  const float open = female ? 1.12f : 0.95f;
  const auto arch = [](float t) { return std::sin(kPi * std::pow(t, 0.9f)); };
  const auto upper = [&](float t) { return kEye + 0.0012f * t + 0.0068f * open * arch(t); };
  const auto lower = [&](float t) { return kEye + 0.0012f * t - 0.0050f * open * arch(t); };
  painter.strip(kEyeWhite, line(kInner, kOuter, 8, lower), line(kInner, kOuter, 8, upper), 0.0012f);
  painter.disc(kIris, {0.0322f, kEye + 0.0016f}, 0.0056f, 0.0020f);
  painter.strip(
      kLashes, line(kInner, kOuter + 0.002f, 8, [&](float t) { return upper(t) - 0.0012f; }),
      line(kInner, kOuter + 0.002f, 8, [&](float t) { return upper(t) + (0.0008f + 0.0012f * t) * open; }),
      0.0026f);
  const float thick = female ? 0.0024f : 0.0036f, height = female ? 0.0135f : 0.0115f;
  const auto brow = [&](float t) { return height + 0.0040f * std::sin(kPi * 0.75f * t) - 0.0020f * t; };
  painter.strip(
      kBrows, line(0.0135f, 0.0530f, 7, [&](float t) { return brow(t) - thick * (1.0f - 0.75f * t); }),
      line(0.0135f, 0.0530f, 7, [&](float t) { return brow(t) + thick * (1.0f - 0.75f * t); }), 0.0016f);
  // Half of the mouth's line; the strip's mirror image is the other half.
  const auto mouth = [](float t) { return -0.0830f + 0.0012f * t * t; };
  painter.strip(kLashes, line(0.0f, 0.0215f, 6, [&](float t) { return mouth(t) - 0.0011f * (1.0f - t); }),
                line(0.0f, 0.0215f, 6, [&](float t) { return mouth(t) + 0.0011f * (1.0f - t); }), 0.0012f);

  MadeGarment made;
  made.node.name = "garment.face";
  made.node.primitives = painter.take();
  made.materials = {
      clothMaterial("face.eyes", Vec3(0.78f, 0.76f, 0.72f)), clothMaterial("face.eyes.iris", palette.second),
      clothMaterial("face.lashes", Vec3(0.035f, 0.018f, 0.014f)), clothMaterial("hair.brows", palette.main)};
  return made;
}

}  // namespace ensemble
