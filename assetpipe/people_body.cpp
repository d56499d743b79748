#include "assetpipe/people_body.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "assetpipe/simplify_surface.h"
#include "assetpipe/surface_check.h"

namespace ensemble {
namespace {

Vec3 toLeft(const Vec3& p) { return {std::abs(p.x), p.y, p.z}; }

/// Whether a point is nearer to an arm than to the rest of the body.
bool isOnArm(const Figure& figure, const Vec3& p) {
  return std::min(figure.arm(p), figure.hand(p)) < std::min(figure.torso(p), figure.leg(p));
}

/// Where errors count more: the face, then fingers, toes and the joints that bend.
float importance(const Figure& figure, const Vec3& p) {
  const float s = figure.scale;
  const Vec3 face = figure.joints[kHead] + s * Vec3(0.0f, 0.045f, 0.07f);
  const float at_face = 1.0f - smoothStep(0.075f * s, 0.115f * s, glm::distance(p, face));
  const float at_head = smoothStep(-0.06f * s, 0.0f, p.y - figure.joints[kHead].y);
  const float at_hand = smoothStep(-0.02f * s, 0.04f * s, handBorder(figure, p));
  const float at_toes = 1.0f - smoothStep(0.03f * s, 0.06f * s, p.y);
  // Small features weigh little by their area, so each is named.
  struct Feature {
    Vec3 center;  // metres of the reference head, from between the ears
    float radius, weight;
  };
  constexpr Feature kFeatures[] = {{{0.032f, -0.008f, 0.082f}, 0.024f, 260.0f},
                                   {{0.000f, -0.083f, 0.095f}, 0.028f, 260.0f},
                                   {{0.006f, -0.045f, 0.108f}, 0.020f, 90.0f},
                                   {{0.082f, -0.018f, -0.008f}, 0.034f, 16.0f}};
  float at_feature = 0.0f;
  for (const Feature& feature : kFeatures) {
    const float distance = glm::distance((toLeft(p) - figure.head_center) / figure.head_size, feature.center);
    at_feature = std::max(
        at_feature, feature.weight * (1.0f - smoothStep(0.6f * feature.radius, feature.radius, distance)));
  }
  float at_tip = 0.0f;
  for (const Vec3& end : figure.finger_ends) {
    at_tip = std::max(at_tip, 1.0f - smoothStep(0.010f * s, 0.020f * s, glm::distance(toLeft(p), end)));
  }
  float result = 0.42f + 35.0f * at_face + at_feature + 1.8f * at_head + 1.6f * at_hand + 40.0f * at_tip +
                 2.6f * at_toes;
  for (const int joint : {kLowerArm, kCalf, kUpperArm}) {
    const float distance = glm::distance(toLeft(p), figure.joints[static_cast<std::size_t>(joint)]);
    result += 0.7f * (1.0f - smoothStep(0.05f * s, 0.12f * s, distance));
  }
  return result;
}

}  // namespace

float headBorder(const Figure& figure, const Vec3& p) {
  return neckline(figure, p, 0.0f, figure.isFemale() ? 0.072f : 0.088f);
}

float neckline(const Figure& figure, const Vec3& p, float rise, float radius) {
  const Vec3 base = figure.joints[kNeck] - Vec3(0.0f, 0.005f * figure.scale, 0.0f);
  const Vec3 up = glm::normalize(Vec3(0.0f, 1.0f, 0.42f));
  const Vec3 axis = glm::normalize(figure.joints[kHead] - figure.joints[kNeck]);
  const Vec3 offset = p - base;
  const float above = glm::dot(offset, up) - rise * figure.scale;
  const float beside = glm::length(offset - axis * glm::dot(offset, axis));
  // Higher up everything is head, chin and ears too.
  const float wide = radius * figure.scale + std::max(0.0f, 1.6f * (above - 0.045f * figure.scale));
  return smoothMin(above, wide - beside, 0.03f * figure.scale);
}

float armBorder(const Figure& figure, const Vec3& p) {
  const float from = 0.36f * glm::distance(figure.joints[kUpperArm], figure.joints[kLowerArm]);
  const float along = glm::dot(toLeft(p) - figure.joints[kUpperArm], figure.armAxis()) - from;
  return isOnArm(figure, p) ? along : -figure.scale;
}

float handBorder(const Figure& figure, const Vec3& p) {
  const Vec3 axis = glm::normalize(figure.joints[kHand] - figure.joints[kLowerArm]);
  const float along = glm::dot(toLeft(p) - figure.joints[kHand], axis) + 0.012f * figure.scale;
  return isOnArm(figure, p) ? along : -figure.scale;
}

float legBorder(const Figure& figure, const Vec3& p) {
  // From the groin up to the side of the hip, like the edge of briefs.
  const float groin = figure.joints[kThigh].y - 0.085f * figure.scale;
  const Vec3 side = toLeft(p);
  if (isOnArm(figure, p)) return -figure.scale;
  return (groin + 0.55f * side.x - p.y) / std::sqrt(1.0f + 0.55f * 0.55f);
}

float footBorder(const Figure& figure, const Vec3& p) {
  return figure.joints[kFoot].y + 0.025f * figure.scale - p.y;
}

BodyRegion bodyRegion(const Figure& figure, const Vec3& p) {
  if (armBorder(figure, p) > 0.0f)
    return handBorder(figure, p) > 0.0f ? BodyRegion::kHands : BodyRegion::kArms;
  if (headBorder(figure, p) > 0.0f) return BodyRegion::kHead;
  if (legBorder(figure, p) <= 0.0f) return BodyRegion::kTorso;
  return footBorder(figure, p) > 0.0f ? BodyRegion::kFeet : BodyRegion::kLegs;
}

namespace {

/// The left half of the surface as the grid has it, cut along the regions' borders.
/// @param cell the grid's step, metres for a figure of scale 1
FieldMesh meshLeftHalf(const Figure& figure, const Field& body, float cell) {
  FieldMesherOptions mesher;
  mesher.low = {0.0f, -0.02f, -0.35f * figure.scale};
  mesher.high = {0.85f * figure.scale, figure.head_top.y + 0.03f, 0.35f * figure.scale};
  mesher.cell = cell * figure.scale;
  mesher.half = true;
  FieldMesh half = meshField(body, mesher);
  using Border = float (*)(const Figure&, const Vec3&);
  for (const Border border :
       {Border(headBorder), Border(armBorder), Border(handBorder), Border(legBorder), Border(footBorder)}) {
    snapToBorder(
        half, body, [&](const Vec3& p) { return border(figure, p); }, mesher.cell);
  }
  for (std::size_t f = 0; f < half.faces.size(); ++f) {
    const Triangle& face = half.faces[f];
    const Vec3 middle = (half.positions[face[0]] + half.positions[face[1]] + half.positions[face[2]]) / 3.0f;
    half.labels[f] = static_cast<std::uint8_t>(bodyRegion(figure, middle));
  }
  return half;
}

}  // namespace

FieldMesh makeBodyMesh(const Figure& figure, std::size_t face_count) {
  const Field body = [&figure](const Vec3& p) { return figure.body(p); };
  // Where two parts of the body lie close, as in an armpit, few triangles may cut each other: there it
  // takes more of them, and it is tried again. A fine furrow (between the lips) may fold where it meets the
  // grid unluckily: each time the grid is another.
  constexpr int kRounds = 8;
  std::vector<Vec3> narrow;
  for (int round = 1;; ++round) {
    const FieldMesh half = meshLeftHalf(figure, body, 0.0034f - 0.00005f * static_cast<float>(round - 1));
    SimplifySurfaceOptions simplify;
    simplify.target_faces = face_count / 2;
    simplify.importance = [&](const Vec3& p) {
      float closeness = 0.0f;
      for (const Vec3& place : narrow) {
        const float distance = glm::distance(toLeft(p), toLeft(place));
        closeness =
            std::max(closeness, 1.0f - smoothStep(0.02f * figure.scale, 0.04f * figure.scale, distance));
      }
      return importance(figure, p) * (1.0f + 10.0f * closeness);
    };
    FieldMesh mesh = mirrored(simplifySurface(half, body, simplify));
    const SurfaceCheck check = checkSurface(mesh.positions, mesh.faces);
    if (check.crossings.empty() || round == kRounds) return mesh;
    narrow.insert(narrow.end(), check.crossings.begin(), check.crossings.end());
  }
}

RawVertex makeVertex(const Figure& figure, const Field& field, const Vec3& position,
                     const SkinBinding& skin) {
  RawVertex vertex;
  vertex.position = position;
  constexpr float kNormalStep = 0.0035f;  // metres: about the size of the smallest triangles
  vertex.normal = fieldNormal(field, position, kNormalStep);
  if (position.x == 0.0f) {
    vertex.normal.x = 0.0f;
    vertex.normal = glm::normalize(vertex.normal);
  }
  vertex.uv = {0.5f + position.x / figure.options.height, 1.0f - position.y / figure.options.height};
  vertex.skin = skin;
  return vertex;
}

}  // namespace ensemble
