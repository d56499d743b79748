// How a figure's solids are made; for the sources people_figure, people_head and people_limbs only.
//
// Everything is told in metres of the reference figures (a man of 1.76 m, a woman of 1.66 m) and brought
// to the person's size, and an old person's stoop, on the way in.
#pragma once

#include <array>
#include <vector>

#include "assetpipe/people_figure.h"

namespace ensemble {

/// Lengths of a reference figure in metres.
struct Measures {
  float height;
  float pelvis, spine1, spine2, spine3, neck, head;  // heights of the joints
  Vec3 clavicle, shoulder, hip, knee, ankle, ball;
  float upper_arm, forearm, hand;
  float limb;       // factor on the thickness of arms and legs
  float head_size;  // factor on the head
};

class FigureBuilder {
 public:
  explicit FigureBuilder(const FigureOptions& options);
  Figure run();

 private:
  struct Finger {
    int joint;
    float along, thumbward, splay_degrees, length, slim;
  };
  static const std::array<Finger, 4> kFingers;

  void placeTrunkJoints();
  void placeArmJoints();
  void placeFingers();
  void buildTorso();
  void buildBreast(const Vec3& flip);
  void buildShoulders(const Vec3& flip);
  void buildHead();
  void buildNeck();
  void buildFace(float side);
  void buildNose();
  void buildMouth(float side);
  void buildEar(float side);
  void buildArm();
  void buildHand();
  void buildLeg();
  void buildFoot();
  void buildToes(const LoftFrame& frame, float size, float wide);

  float s(float length) const { return length * figure_.scale; }
  /// A point of the reference figure, stooped and scaled.
  Vec3 at(const Vec3& point) const;
  Vec3& joint(int index) { return figure_.joints[static_cast<std::size_t>(index)]; }
  const Vec3& joint(int index) const { return figure_.joints[static_cast<std::size_t>(index)]; }

  /// A point of the head of reference size, from a point between the ears; and a size likewise.
  Vec3 fromHead(float x, float y, float z) const;
  Vec3 headSize(float x, float y, float z) const { return Vec3(x, y, z) * m_.head_size; }
  float h(float length) const { return s(length * m_.head_size); }
  /// A point of the left hand of reference size: along the hand, towards the thumb, out of the palm.
  Vec3 fromHand(float along, float thumbward, float palmward) const;

  Solid cone(const Vec3& a, const Vec3& b, float radius_a, float radius_b) const;
  Solid ball(const Vec3& center, const Vec3& radii, const Mat3& turn = Mat3(1.0f)) const;
  /// Rows in reference metres; thickness multiplied by `thick`.
  Solid loft(const LoftFrame& frame, std::vector<LoftRow> rows, float thick, float boxiness = 0.0f) const;

  Measures m_;
  const bool female_, old_;
  const float girth_, build_;  // -1 .. 1
  Figure figure_;
  float trunk_ = 1.0f, limb_ = 1.0f, muscle_ = 1.0f, hand_size_ = 1.0f, stoop_ = 0.0f;
  LoftFrame hand_frame_;
};

}  // namespace ensemble
