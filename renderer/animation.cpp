// Lister, Laycock, Day, section 3, "Skinned Instancing", figure 1; two keys are interpolated here.
#include "renderer/animation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "core/box.h"
#include "core/clip.h"
#include "core/gait.h"

namespace ensemble {
namespace {

/// Boxes of the vertices that each joint moves, at rest; the last of those that none moves.
std::vector<Box> jointBoxes(const Wardrobe& wardrobe) {
  std::vector<Box> boxes(wardrobe.body.skeleton.joints.size() + 1);
  const auto add = [&](const RawVertex& vertex) {
    bool moved = false;
    for (std::size_t i = 0; i < 4; ++i) {
      if (!(vertex.skin.weights[i] > 0.0f)) continue;
      boxes[vertex.skin.joints[i]].add(vertex.position);
      moved = true;
    }
    if (!moved) boxes.back().add(vertex.position);
  };
  std::for_each(wardrobe.body.vertices.begin(), wardrobe.body.vertices.end(), add);
  for (const Item& item : wardrobe.items) forEachVertex(item, add);
  return boxes;
}

/// Adds a moved box. A vertex is a convex combination of where its joints put it, and a pose one of
/// two keys, so that the union of all moved boxes holds it.
void addMoved(Box& bounds, const Box& box, const Mat4& matrix) {
  if (box.empty()) return;
  for (unsigned i = 0; i < 8; ++i) bounds.add(Vec3(matrix * Vec4(box.corner(i), 1.0f)));
}

Sphere sphereAround(const Box& box) {
  if (box.empty()) return {};
  return {box.center(), 0.5f * glm::length(box.extent())};
}

void addMatrix(std::vector<vec4>& texels, const Mat4& m) {
  for (int row = 0; row < 3; ++row) texels.emplace_back(m[0][row], m[1][row], m[2][row], m[3][row]);
}

/// Appends a clip whose key i has the local transforms `key(i)`.
template <class Key>
void addClip(Animation& animation, const RawSkeleton& skeleton, const std::vector<Box>& boxes,
             std::uint32_t key_count, const Key& key) {
  animation.clips.push_back({.first_matrix = static_cast<std::uint32_t>(animation.texels.size() / 3),
                             .key_count = key_count,
                             .joint_count = static_cast<std::uint32_t>(boxes.size()),
                             .legs = static_cast<std::uint32_t>(animation.legs.size() - 1)});
  Box bounds;
  addMoved(bounds, boxes.back(), Mat4(1.0f));
  for (std::uint32_t i = 0; i < key_count; ++i) {
    const std::vector<Mat4> matrices = skinningMatrices(skeleton, key(i));
    for (std::size_t joint = 0; joint < matrices.size(); ++joint) {
      addMatrix(animation.texels, matrices[joint]);
      addMoved(bounds, boxes[joint], matrices[joint]);
    }
    addMatrix(animation.texels, Mat4(1.0f));
  }
  animation.bounds.push_back(sphereAround(bounds));
}

/// Legs as the pose pass reads them.
void addLegs(Animation& animation, const RawSkeleton& skeleton) {
  GpuLegs gpu{};
  gpu.first_group = static_cast<std::uint32_t>(animation.leg_groups.size());
  const std::optional<Legs> legs = findLegs(skeleton);
  if (legs) {
    for (std::size_t l = 0; l < 2; ++l) {
      const Leg& leg = legs->legs[l];
      const std::uint32_t joints[] = {leg.hip, leg.knee, leg.ankle};
      const Vec3 positions[] = {leg.hip_position, leg.knee_position, leg.ankle_position};
      std::copy(std::begin(joints), std::end(joints), gpu.joints + 3 * l);
      for (std::size_t i = 0; i < 3; ++i) gpu.positions[3 * l + i] = Vec4(positions[i], 1.0f);
    }
    animation.leg_groups.insert(animation.leg_groups.end(), legs->groups.begin(), legs->groups.end());
  }
  animation.leg_groups.resize(gpu.first_group + skeleton.joints.size() + 1, 0u);
  animation.legs.push_back(gpu);
}

}  // namespace

float bodyHeight(const Wardrobe& wardrobe) {
  Box body;
  for (const RawVertex& vertex : wardrobe.body.vertices) body.add(vertex.position);
  return body.empty() ? 0.0f : body.extent().y;
}

Animation buildAnimation(std::span<const Wardrobe> wardrobes) {
  Animation animation;
  for (const Wardrobe& wardrobe : wardrobes) {
    const RawSkeleton& skeleton = wardrobe.body.skeleton;
    const std::vector<Box> boxes = jointBoxes(wardrobe);
    animation.first_clip.push_back(static_cast<std::uint32_t>(animation.clips.size()));
    animation.joint_count.push_back(static_cast<std::uint32_t>(boxes.size()));
    addLegs(animation, skeleton);
    animation.heights.push_back(bodyHeight(wardrobe));
    for (const Clip& clip : wardrobe.body.clips) {
      addClip(animation, skeleton, boxes, clip.key_count, [&](std::uint32_t i) { return clip.key(i); });
      animation.seconds.push_back(clip.seconds);
    }
    if (!wardrobe.body.clips.empty()) continue;
    const std::vector<Transform> rest = restPose(skeleton);
    addClip(animation, skeleton, boxes, 1, [&](std::uint32_t) { return std::span<const Transform>(rest); });
    animation.seconds.push_back(0.0f);
  }
  return animation;
}

float phaseAt(double time_seconds, float clip_seconds, float phase, float speed) {
  if (!(clip_seconds > 0.0f)) return 0.0f;
  const double turns = double{phase} + double{speed} * time_seconds / double{clip_seconds};
  const auto part = static_cast<float>(turns - std::floor(turns));
  return part < 1.0f ? part : 0.0f;
}

}  // namespace ensemble
