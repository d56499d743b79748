// Two-bone inverse kinematics: bends a leg so that its ankle comes to a place, closed form. Compiled
// by C++ (annotations, tests) and GLSL (the pose pass), so that both get the same pose.
#ifndef ENSEMBLE_SHADERS_SHARED_LEG_IK_H
#define ENSEMBLE_SHADERS_SHARED_LEG_IK_H

// Parts of a leg: what hangs on the hip but not on the knee, on the knee but not on the ankle, and
// the foot. A joint's group is 0, or 1 + part + ENSEMBLE_LEG_PARTS * leg.
#define ENSEMBLE_LEG_THIGH 0
#define ENSEMBLE_LEG_SHIN 1
#define ENSEMBLE_LEG_FOOT 2
#define ENSEMBLE_LEG_PARTS 3

#ifdef __cplusplus
#include <algorithm>

#include "core/math.h"

namespace ensemble::leg_ik {
using glm::acos, glm::clamp, glm::cos, glm::cross, glm::dot, glm::length, glm::max, glm::normalize, glm::sin;
using glm::mat3, glm::vec3;
using uint = unsigned int;
#define ENSEMBLE_SHARED_FUNCTION inline
#else
#define ENSEMBLE_SHARED_FUNCTION
#endif

/// What moves a part of a leg: x -> rotation * (x - from) + to.
struct LegMove {
  mat3 rotation;
  vec3 from;
  vec3 to;
};

/// Rodrigues' formula. @param axis unit
ENSEMBLE_SHARED_FUNCTION mat3 turnOf(vec3 axis, float cosine, float sine) {
  vec3 a = (1.0f - cosine) * axis;
  vec3 b = sine * axis;
  return mat3(a.x * axis.x + cosine, a.x * axis.y + b.z, a.x * axis.z - b.y,  //
              a.y * axis.x - b.z, a.y * axis.y + cosine, a.y * axis.z + b.x,  //
              a.z * axis.x + b.y, a.z * axis.y - b.x, a.z * axis.z + cosine);
}

ENSEMBLE_SHARED_FUNCTION mat3 turnAbout(vec3 axis, float angle) {
  return turnOf(axis, cos(angle), sin(angle));
}

/// The shortest turn that takes the direction of `a` to that of `b`.
ENSEMBLE_SHARED_FUNCTION mat3 turnBetween(vec3 a, vec3 b) {
  vec3 axis = cross(a, b);
  float sine = length(axis);
  float cosine = dot(a, b);
  float size = length(vec3(sine, cosine, 0.0f));
  if (sine < 1e-9f * size) return mat3(1.0f);
  return turnOf(axis / sine, cosine / size, sine / size);
}

ENSEMBLE_SHARED_FUNCTION float angleOpposite(float opposite, float side_1, float side_2) {
  float cosine = (side_1 * side_1 + side_2 * side_2 - opposite * opposite) / (2.0f * side_1 * side_2);
  return acos(clamp(cosine, -1.0f, 1.0f));
}

/// How a part of a leg moves so that the ankle comes to `target`, or as near as the leg reaches, and
/// the foot turns by `yaw` about +Y. The hip stays, the knee keeps its plane. Model space, metres.
/// Bones of no length, or a hip in the ankle, stay as they are.
ENSEMBLE_SHARED_FUNCTION LegMove moveLeg(vec3 hip, vec3 knee, vec3 ankle, vec3 target, float yaw, uint part) {
  LegMove move;
  move.rotation = mat3(1.0f);
  move.from = hip;
  move.to = hip;
  float upper = length(knee - hip), lower = length(ankle - knee), was = length(ankle - hip);
  if (upper < 1e-5f || lower < 1e-5f || was < 1e-5f) return move;
  vec3 reach = target - hip;
  float distance = length(reach);
  if (distance < 1e-5f) return move;
  // A leg is never stretched further than it was, or than nearly straight.
  float longest = max(was, 0.9995f * (upper + lower));
  float is = clamp(distance, 1.0001f * max(upper - lower, lower - upper) + 1e-5f, longest);

  // The plane of the leg; a straight one bends its knee forwards.
  vec3 axis = cross(ankle - hip, knee - hip);
  if (length(axis) < 1e-6f) axis = cross(ankle - hip, vec3(0.0f, 0.0f, 1.0f));
  if (length(axis) < 1e-6f) return move;
  axis = normalize(axis);
  float hip_turn = angleOpposite(lower, upper, is) - angleOpposite(lower, upper, was);
  float knee_turn = angleOpposite(is, upper, lower) - angleOpposite(was, upper, lower);
  mat3 aim = turnBetween(ankle - hip, reach);
  mat3 thigh = aim * turnAbout(axis, hip_turn);
  mat3 shin = thigh * turnAbout(axis, knee_turn);
  vec3 new_knee = thigh * (knee - hip) + hip;
  if (part == uint(ENSEMBLE_LEG_THIGH)) {
    move.rotation = thigh;
  } else if (part == uint(ENSEMBLE_LEG_SHIN)) {
    move.rotation = shin;
    move.from = knee;
    move.to = new_knee;
  } else {
    move.rotation = turnAbout(vec3(0.0f, 1.0f, 0.0f), yaw);
    move.from = ankle;
    move.to = shin * (ankle - knee) + new_knee;
  }
  return move;
}

#ifdef __cplusplus
}  // namespace ensemble::leg_ik
#endif
#undef ENSEMBLE_SHARED_FUNCTION
#endif
