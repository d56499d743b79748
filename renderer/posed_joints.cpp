#include "renderer/posed_joints.h"

#include <cmath>

#include "core/clip.h"
#include "core/gait.h"
#include "shaders/shared/leg_ik.h"

namespace ensemble {
namespace {

std::vector<Mat4> clipMatrices(const TemplateBody& body, std::uint32_t clip_number, float phase) {
  if (body.clips.empty()) return skinningMatrices(body.skeleton, restPose(body.skeleton));
  const Clip& clip = body.clips[clip_number];
  return skinningMatricesAt(body.skeleton, clip, phase * static_cast<float>(clip.key_count - 1));
}

Mat4 toMatrix(const leg_ik::LegMove& move) {
  Mat4 matrix(move.rotation);
  matrix[3] = Vec4(move.to - move.rotation * move.from, 1.0f);
  return matrix;
}

void holdFeet(const Legs& legs, const CharacterPose& pose, std::vector<Mat4>& matrices) {
  const std::vector<Mat4> loose = matrices;
  const auto moved = [&](std::uint32_t joint, Vec3 bind) { return Vec3(loose[joint] * Vec4(bind, 1.0f)); };
  for (std::uint32_t l = 0; l < 2; ++l) {
    const Leg& leg = legs.legs[l];
    const Vec3 hip = moved(leg.hip, leg.hip_position), knee = moved(leg.knee, leg.knee_position),
               ankle = moved(leg.ankle, leg.ankle_position);
    const Vec3 target = ankle + Vec3(pose.feet[l].x, 0.0f, pose.feet[l].z);
    for (std::uint32_t part = 0; part < ENSEMBLE_LEG_PARTS; ++part) {
      const Mat4 move = toMatrix(leg_ik::moveLeg(hip, knee, ankle, target, pose.feet[l].yaw, part));
      for (std::size_t j = 0; j < matrices.size(); ++j) {
        if (legs.groups[j] == 1 + part + ENSEMBLE_LEG_PARTS * l) matrices[j] = move * matrices[j];
      }
    }
  }
}

}  // namespace

CharacterPose atNearestKey(const TemplateBody& body, CharacterPose pose) {
  if (pose.idle_weight >= 0.5f) {
    pose.clip = pose.idle_clip;
    pose.phase = pose.idle_phase;
  }
  pose.idle_weight = 0.0f;
  pose.holds_feet = false;
  const std::uint32_t last = body.clips.empty() ? 0 : body.clips[pose.clip].key_count - 1;
  if (last > 0) {
    const auto intervals = static_cast<float>(last);
    pose.phase = std::floor(pose.phase * intervals + 0.5f) / intervals;
  }
  return pose;
}

std::vector<Mat4> posedMatrices(const TemplateBody& body, const CharacterPose& pose) {
  std::vector<Mat4> matrices = clipMatrices(body, pose.clip, pose.phase);
  if (pose.idle_weight > 0.0f) {
    mixMatrices(matrices, clipMatrices(body, pose.idle_clip, pose.idle_phase), pose.idle_weight);
  }
  if (!pose.holds_feet) return matrices;
  if (const std::optional<Legs> legs = findLegs(body.skeleton)) holdFeet(*legs, pose, matrices);
  return matrices;
}

std::vector<Vec3> posedJoints(const TemplateBody& body, const CharacterPose& pose) {
  return jointPositions(body, pose, posedMatrices(body, pose));
}

std::vector<Vec3> jointPositions(const TemplateBody& body, const CharacterPose& pose,
                                 std::span<const Mat4> matrices) {
  std::vector<Vec3> joints;
  for (std::size_t j = 0; j < matrices.size(); ++j) {
    const Vec4 bind = glm::inverse(body.skeleton.joints[j].joint_from_model)[3];
    joints.emplace_back(pose.world_from_model * (matrices[j] * bind));
  }
  return joints;
}

}  // namespace ensemble
