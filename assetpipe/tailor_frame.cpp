#include "assetpipe/tailor_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace ensemble {
namespace {

constexpr float kPi2 = 2.0f * kPi;

/// Of the head that recipes are drawn on, from between its ears: skull's top, half its width over the ears,
/// forehead and back of the head.
constexpr float kHeadTop = 0.1005f, kHeadHalf = 0.0760f, kHeadFore = 0.0860f, kHeadBack = -0.1080f;

Vec2 direction(std::size_t k, std::size_t count) {
  const float angle = kPi2 * static_cast<float>(k) / static_cast<float>(count);
  return {std::sin(angle), std::cos(angle)};
}

}  // namespace

TailorFrame::TailorFrame(const AuthorBody& body, const Landmarks& marks) : body_(body), marks_(marks) {
  const auto height = [&](Landmark mark, float otherwise) {
    const float share = body.low().y + otherwise * (body.high().y - body.low().y);
    return marks.has(mark) ? 0.5f * (marks.at(mark, 0).y + marks.at(mark, 1).y) : share;
  };
  level_heights_ = {body.low().y,
                    height(Landmark::kAnkle, 0.05f),
                    height(Landmark::kKnee, 0.29f),
                    height(Landmark::kHip, 0.53f),
                    height(Landmark::kNeck, 0.85f),
                    body.high().y};
  if (marks.has(Landmark::kHead)) measureHead();
  if (marks.has(Landmark::kAnkle)) measureFeet();
}

float TailorFrame::heightOf(float level) const {
  const float free = std::clamp(level, -3.0f, 2.0f) + 3.0f;
  const std::size_t row = std::min<std::size_t>(static_cast<std::size_t>(free), 4);
  return glm::mix(level_heights_[row], level_heights_[row + 1], free - static_cast<float>(row));
}

float TailorFrame::levelOf(float y) const {
  std::size_t row = 0;
  while (row < 4 && y > level_heights_[row + 1]) ++row;
  const float span = std::max(level_heights_[row + 1] - level_heights_[row], 1e-4f);
  return static_cast<float>(row) - 3.0f + (y - level_heights_[row]) / span;
}

float TailorFrame::armPlace(const Vec3& p) const {
  const std::size_t side = sideOf(p);
  const Vec3 shoulder = marks_.at(Landmark::kShoulder, side), elbow = marks_.at(Landmark::kElbow, side),
             wrist = marks_.at(Landmark::kWrist, side);
  const auto along = [&](const Vec3& from, const Vec3& to) {
    return glm::dot(p - from, to - from) / std::max(glm::dot(to - from, to - from), 1e-8f);
  };
  const float upper = std::clamp(along(shoulder, elbow), 0.0f, 1.0f);
  const float lower = std::clamp(along(elbow, wrist), 0.0f, 2.0f);
  const bool is_upper =
      glm::distance(p, glm::mix(shoulder, elbow, upper)) < glm::distance(p, glm::mix(elbow, wrist, lower));
  return is_upper ? upper : 1.0f + lower;
}

float TailorFrame::beyondArmPlace(const Vec3& p, float place) const {
  const std::size_t side = sideOf(p);
  const bool is_upper = place < 1.0f;
  const Vec3 from = marks_.at(is_upper ? Landmark::kShoulder : Landmark::kElbow, side);
  const Vec3 to = marks_.at(is_upper ? Landmark::kElbow : Landmark::kWrist, side);
  return glm::dot(p - glm::mix(from, to, is_upper ? place : place - 1.0f), glm::normalize(to - from));
}

float TailorFrame::offArms(const Vec3& p) const {
  return body_.border({BodyZone::kArms, BodyZone::kHands}, p);
}

Vec3 TailorFrame::legMiddle(std::size_t side, float y) const {
  const Vec3 hip = marks_.at(Landmark::kHip, side), knee = marks_.at(Landmark::kKnee, side),
             ankle = marks_.at(Landmark::kAnkle, side);
  const Vec3 &from = y > knee.y ? hip : knee, &to = y > knee.y ? knee : ankle;
  return glm::mix(from, to, std::clamp((from.y - y) / std::max(from.y - to.y, 1e-4f), 0.0f, 1.0f));
}

void TailorFrame::measureHead() {
  // The head is what its joint and joints above it move; the neck belongs to another.
  const TemplateBody& body = body_.body();
  const Vec3 joint = marks_.at(Landmark::kHead);
  std::vector<Vec3> points;
  for (std::size_t f = 0; f < body.faces.size(); ++f) {
    if (body_.zoneOf(static_cast<std::uint32_t>(f)) != BodyZone::kHead) continue;
    for (const std::uint32_t corner : body.faces[FaceId(f)]) {
      const RawVertex& vertex = body.vertices[VertexId(corner)];
      if (marks_.has(Landmark::kNeck) && vertex.skin.joints[0] == marks_.joint(Landmark::kNeck)) continue;
      points.push_back(vertex.position);
    }
  }
  if (points.empty()) points = {joint, joint + Vec3(0.0f, 0.2f, 0.0f)};
  float top = points.front().y, chin = top;
  for (const Vec3& p : points) {
    top = std::max(top, p.y);
    if (p.z > joint.z) chin = std::min(chin, p.y);
  }
  const float middle = top - 0.46f * (top - chin), up = top - middle;
  float half = 0.01f, fore = -kPi, back = kPi;
  for (const Vec3& p : points) {
    const float share = (p.y - middle) / up;
    if (share > 0.45f && share < 0.75f) half = std::max(half, std::abs(p.x - joint.x));
    if (share > 0.35f) fore = std::max(fore, p.z);
    if (share > 0.0f) back = std::min(back, p.z);
  }
  head_scale_ = {half / kHeadHalf, up / kHeadTop, (fore - back) / (kHeadFore - kHeadBack)};
  head_origin_ = {joint.x, middle, back - kHeadBack * head_scale_.z};
}

void TailorFrame::measureFeet() {
  const TemplateBody& body = body_.body();
  const float sole = body_.ground() + 0.035f * scale();
  for (std::size_t side = 0; side < 2; ++side) {
    foot_low_[side] = Vec3(10.0f);
    foot_high_[side] = Vec3(-10.0f);
    prints_[side].fill(-10.0f);
  }
  for (std::size_t f = 0; f < body.faces.size(); ++f) {
    if (body_.zoneOf(static_cast<std::uint32_t>(f)) != BodyZone::kFeet) continue;
    for (const std::uint32_t corner : body.faces[FaceId(f)]) {
      const Vec3& p = body.vertices[VertexId(corner)].position;
      const std::size_t side = sideOf(p);
      if (p.y > sole) continue;
      foot_low_[side] = glm::min(foot_low_[side], p);
      foot_high_[side] = glm::max(foot_high_[side], p);
      const Vec3 ankle = marks_.at(Landmark::kAnkle, side);
      for (std::size_t k = 0; k < kPrintSides; ++k) {
        const Vec2 to = direction(k, kPrintSides);
        prints_[side][k] = std::max(prints_[side][k], to.x * (p.x - ankle.x) + to.y * (p.z - ankle.z));
      }
    }
  }
}

float TailorFrame::footprint(const Vec3& p) const {
  const std::size_t side = sideOf(p);
  const Vec3 ankle = marks_.at(Landmark::kAnkle, side);
  float value = -10.0f;
  for (std::size_t k = 0; k < kPrintSides; ++k) {
    const Vec2 to = direction(k, kPrintSides);
    value = std::max(value, to.x * (p.x - ankle.x) + to.y * (p.z - ankle.z) - prints_[side][k]);
  }
  return value;
}

float TailorFrame::footPlace(const Vec3& p) const {
  const std::size_t side = sideOf(p);
  return (p.z - foot_low_[side].z) / std::max(foot_high_[side].z - foot_low_[side].z, 1e-4f);
}

namespace {

/// Support of the body's convex sections: how far they reach in each direction, slice by slice.
class HangingHull {
 public:
  static constexpr std::size_t kSides = 36;

  HangingHull(const TailorFrame& frame, const HangOptions& options)
      : options_(options), step_(0.012f * frame.scale()) {
    const Vec3 left = frame.marks().at(Landmark::kHip, 0), right = frame.marks().at(Landmark::kHip, 1);
    center_ = {0.5f * (left.x + right.x), 0.5f * (left.z + right.z)};
    rows_.resize(static_cast<std::size_t>((options.top - options.bottom) / step_) + 2);
    for (auto& row : rows_) row.fill(0.02f);
    const TemplateBody& body = frame.body().body();
    for (std::size_t f = 0; f < body.faces.size(); ++f) {
      const BodyZone zone = frame.body().zoneOf(static_cast<std::uint32_t>(f));
      if (zone != BodyZone::kTorso && zone != BodyZone::kLegs) continue;
      const Triangle& face = body.faces[FaceId(f)];
      for (std::size_t k = 0; k < 3; ++k) {
        addEdge(body.vertices[VertexId(face[k])].position,
                body.vertices[VertexId(face[(k + 1) % 3])].position);
      }
    }
    hang(frame.scale());
  }

  float distance(const Vec3& p) const {
    const float free =
        std::clamp((options_.top - p.y) / step_, 0.0f, static_cast<float>(rows_.size() - 1) - 1e-3f);
    const std::size_t row = static_cast<std::size_t>(free);
    const float share = free - static_cast<float>(row);
    float value = -1.0f;
    const Vec2 from = Vec2(p.x, p.z) - center_;
    for (std::size_t k = 0; k < kSides; ++k) {
      const float reach = glm::mix(rows_[row][k], rows_[row + 1][k], share);
      value = std::max(value, glm::dot(direction(k, kSides), from) - reach);
    }
    const float down = std::clamp((options_.top - p.y) / (options_.top - options_.bottom), 0.0f, 1.0f);
    value -= options_.folds * down * down *
             std::cos(static_cast<float>(options_.fold_count) * std::atan2(from.x, from.y));
    return std::max({value, p.y - options_.top, options_.bottom - p.y});
  }

 private:
  void addEdge(const Vec3& a, const Vec3& b) {
    const Vec3 &high = a.y > b.y ? a : b, &low = a.y > b.y ? b : a;
    const float first = std::ceil((options_.top - high.y) / step_),
                last = std::floor((options_.top - low.y) / step_);
    for (float row = std::max(first, 0.0f); row <= last && row < static_cast<float>(rows_.size());
         row += 1.0f) {
      const float y = options_.top - row * step_;
      const float share = (high.y - y) / std::max(high.y - low.y, 1e-9f);
      const Vec3 p = glm::mix(high, low, std::clamp(share, 0.0f, 1.0f));
      auto& reach = rows_[static_cast<std::size_t>(row)];
      for (std::size_t k = 0; k < kSides; ++k) {
        reach[k] = std::max(reach[k], glm::dot(direction(k, kSides), Vec2(p.x, p.z) - center_));
      }
    }
  }

  /// Cloth falls from where the body reaches out furthest.
  void hang(float scale) {
    const float taper = 0.07f * scale;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      const float down = static_cast<float>(row) * step_;
      const float ease = options_.ease - 0.03f * scale * (1.0f - smoothStep(0.0f, taper, down));
      for (std::size_t k = 0; k < kSides; ++k) {
        rows_[row][k] += ease;
        if (row == 0) continue;
        const float hung = rows_[row - 1][k] + step_ * (options_.flare - options_.cling);
        rows_[row][k] = std::max(rows_[row][k], hung);
      }
    }
  }

  HangOptions options_;
  float step_;
  Vec2 center_{0.0f};
  std::vector<std::array<float, kSides>> rows_;
};

}  // namespace

Field hangingCloth(const TailorFrame& frame, const HangOptions& options) {
  const auto hull = std::make_shared<const HangingHull>(frame, options);
  return [hull](const Vec3& p) { return hull->distance(p); };
}

}  // namespace ensemble
