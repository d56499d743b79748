// A stick figure with two legs that walks on the spot: for tests of steps and feet.
#pragma once

#include <cmath>

#include "core/clip.h"
#include "core/raw_asset.h"
#include "core/wardrobe.h"
#include "shaders/shared/leg_ik.h"

namespace ensemble::testing {

enum StickJoint : std::uint32_t {
  kPelvis,
  kChest,
  kHipL,
  kKneeL,
  kAnkleL,
  kToesL,
  kHipR,
  kKneeR,
  kAnkleR,
  kToesR
};

inline constexpr float kStickStep = 0.7f;        // metres between the prints of one foot and the other
inline constexpr float kStickStance = 0.6f;      // part of the walk that a foot stands
inline constexpr float kStickIdleWidth = 0.16f;  // metres of an ankle from the middle, standing; 0.1 walking

inline const std::vector<Vec3>& stickPlaces() {
  static const std::vector<Vec3> places = {{0, 1.0f, 0},         {0, 1.5f, 0},         {0.1f, 0.9f, 0},
                                           {0.1f, 0.5f, 0.03f},  {0.1f, 0.08f, 0},     {0.1f, 0.02f, 0.12f},
                                           {-0.1f, 0.9f, 0},     {-0.1f, 0.5f, 0.03f}, {-0.1f, 0.08f, 0},
                                           {-0.1f, 0.02f, 0.12f}};
  return places;
}

inline RawSkeleton stickSkeleton() {
  constexpr std::int32_t kParents[] = {-1, 0, 0, 2, 3, 4, 0, 6, 7, 8};
  RawSkeleton skeleton;
  for (std::size_t i = 0; i < stickPlaces().size(); ++i) {
    const std::int32_t parent = kParents[i];
    const Vec3 from = parent < 0 ? Vec3(0.0f) : stickPlaces()[static_cast<std::size_t>(parent)];
    skeleton.bones.push_back({"bone" + std::to_string(i), parent, {stickPlaces()[i] - from}});
    RawJoint joint{static_cast<std::uint32_t>(i), Mat4(1.0f)};
    joint.joint_from_model[3] = Vec4(-stickPlaces()[i], 1.0f);
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

/// A pose whose ankles are at `left` and `right`, soles level, the pelvis lowered so that legs reach.
inline std::vector<Transform> stickPose(const RawSkeleton& skeleton, float drop, Vec3 left, Vec3 right) {
  std::vector<Transform> pose = restPose(skeleton);
  pose[kPelvis].translation.y -= drop;
  left.y += drop;
  right.y += drop;
  for (std::uint32_t leg = 0; leg < 2; ++leg) {
    const std::uint32_t hip = leg == 0 ? kHipL : kHipR;
    const auto place = [&](std::uint32_t i) { return stickPlaces()[hip + i]; };
    const auto turn = [&](std::uint32_t part) {
      return glm::quat_cast(
          leg_ik::moveLeg(place(0), place(1), place(2), leg == 0 ? left : right, 0.0f, part).rotation);
    };
    const Quat thigh = turn(ENSEMBLE_LEG_THIGH), shin = turn(ENSEMBLE_LEG_SHIN);
    pose[hip].rotation = thigh;
    pose[hip + 1].rotation = glm::inverse(thigh) * shin;
    pose[hip + 2].rotation = glm::inverse(shin);
  }
  return pose;
}

/// An ankle of the walk: it stands for kStickStance from phase 0, then swings.
inline Vec3 stickAnkle(float phase) {
  phase -= std::floor(phase);
  const float reach = kStickStep * kStickStance;  // it stands while the body moves 2 steps x stance
  if (phase <= kStickStance) return {0.1f, 0.08f, reach - 2.0f * kStickStep * phase};
  const float u = (phase - kStickStance) / (1.0f - kStickStance);
  return {0.1f, 0.08f + 0.12f * std::sin(kPi * u), -reach * std::cos(kPi * u)};
}

inline std::vector<Clip> stickClips(const RawSkeleton& skeleton) {
  Clip walk{
      .name = "walk", .seconds = 1.0f, .key_count = 61, .ground_speed = 2.0f * kStickStep, .transforms = {}};
  for (std::uint32_t key = 0; key < walk.key_count; ++key) {
    const float phase = static_cast<float>(key) / static_cast<float>(walk.key_count - 1);
    Vec3 right = stickAnkle(phase + 0.5f);
    right.x = -right.x;
    const auto pose = stickPose(skeleton, 0.14f, stickAnkle(phase), right);
    walk.transforms.insert(walk.transforms.end(), pose.begin(), pose.end());
  }
  Clip idle{.name = "idle", .seconds = 2.0f, .key_count = 2, .ground_speed = 0.0f, .transforms = {}};
  const auto pose =
      stickPose(skeleton, 0.03f, {kStickIdleWidth, 0.08f, 0.02f}, {-kStickIdleWidth, 0.08f, -0.03f});
  for (int key = 0; key < 2; ++key) idle.transforms.insert(idle.transforms.end(), pose.begin(), pose.end());
  return {walk, idle};
}

/// A wardrobe of one template, a sign of two faces on every joint, without outfits.
inline Wardrobe stickWardrobe() {
  Wardrobe wardrobe;
  wardrobe.folder = "memory";
  TemplateBody& body = wardrobe.body;
  body.skeleton = stickSkeleton();
  body.clips = stickClips(body.skeleton);
  for (std::uint16_t joint = 0; joint < stickPlaces().size(); ++joint) {
    const auto first = static_cast<std::uint32_t>(body.vertices.size());
    for (const Vec2 corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)}) {
      RawVertex vertex;
      vertex.position = stickPlaces()[joint] + 0.06f * Vec3(corner, 0.0f);
      vertex.normal = Vec3(0.0f, 0.0f, 1.0f);
      vertex.skin.joints = {joint, 0, 0, 0};
      vertex.skin.weights = {1.0f, 0.0f, 0.0f, 0.0f};
      body.vertices.push(vertex);
    }
    body.faces.push({first, first + 1, first + 2});
    body.faces.push({first, first + 2, first + 3});
    body.region_of_face.push(RegionId(std::size_t{0}));
    body.region_of_face.push(RegionId(std::size_t{0}));
  }
  const auto faces = static_cast<std::uint32_t>(body.faces.size());
  body.regions.push({"signs", 0, faces, 0, static_cast<std::uint32_t>(body.vertices.size())});
  body.parts.push_back({RegionId(std::size_t{0}), 0, 0, faces});
  body.materials.emplace_back().name = "signs";
  body.materials[0].double_sided = true;
  return wardrobe;
}

}  // namespace ensemble::testing
