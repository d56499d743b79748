// Places on a body as recipes name them: levels, places on the arm, the head's and the foot's own measures.
#pragma once

#include <array>
#include <vector>

#include "assetpipe/author_body.h"

namespace ensemble {

/// A body measured for one recipe. @pre the landmarks that a function needs are there
class TailorFrame {
 public:
  TailorFrame(const AuthorBody& body, const Landmarks& marks);

  const AuthorBody& body() const { return body_; }
  const Landmarks& marks() const { return marks_; }
  float scale() const { return body_.scale(); }

  float heightOf(float level) const;  ///< metres
  float levelOf(float y) const;

  /// 0 at the shoulder, 1 at the elbow, 2 at the wrist, up to 3.
  float armPlace(const Vec3& p) const;
  /// Metres beyond a place on the arm, along the bone there.
  float beyondArmPlace(const Vec3& p, float place) const;
  /// Positive off arms and hands, about metres from their border.
  float offArms(const Vec3& p) const;
  /// Where the middle of a leg is at a height; above the hip that of the hip.
  Vec3 legMiddle(std::size_t side, float y) const;
  static std::size_t sideOf(const Vec3& p) { return p.x >= 0.0f ? 0 : 1; }

  /// Metres of a reference head, from between its ears; and the mean scale from there to here.
  Vec3 onHead(const Vec3& p) const { return (p - head_origin_) / head_scale_; }
  Vec3 fromHead(const Vec3& h) const { return head_origin_ + h * head_scale_; }
  float headScale() const { return (head_scale_.x + head_scale_.y + head_scale_.z) / 3.0f; }
  const Vec3& headScales() const { return head_scale_; }

  /// The outline of a foot as a convex shape: negative inside, metres; `place` from 0, heel, to 1, toe.
  float footprint(const Vec3& p) const;
  float footPlace(const Vec3& p) const;
  float footLength() const { return foot_high_[0].z - foot_low_[0].z; }

 private:
  void measureHead();
  void measureFeet();

  static constexpr std::size_t kPrintSides = 32;
  const AuthorBody& body_;
  const Landmarks& marks_;
  std::array<float, 6> level_heights_{};  // of levels -3 .. 2
  Vec3 head_origin_{0.0f}, head_scale_{1.0f};
  std::array<Vec3, 2> foot_low_{}, foot_high_{};
  std::array<std::array<float, kPrintSides>, 2> prints_{};
};

/// What hangs around trunk and legs, arms left out: convex sections from a height down to another.
struct HangOptions {
  float top = 1.0f, bottom = 0.0f;  ///< heights, metres
  float ease = 0.01f, cling = 0.0f, flare = 0.0f;
  float folds = 0.0f;  ///< depth at the bottom, metres
  std::uint32_t fold_count = 9;
};
Field hangingCloth(const TailorFrame& frame, const HangOptions& options);

}  // namespace ensemble
