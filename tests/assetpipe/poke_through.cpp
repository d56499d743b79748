#include "tests/assetpipe/poke_through.h"

#include <cmath>
#include <limits>
#include <vector>

#include "core/clip.h"

namespace ensemble::testing {
namespace {

constexpr float kPoke = 0.002f;  // metres

/// The point of a triangle that is nearest to p.
Vec3 nearestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0.0f && d2 <= 0.0f) return a;
  const Vec3 bp = p - b;
  const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0.0f && d4 <= d3) return b;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) return a + ab * (d1 / (d1 - d3));
  const Vec3 cp = p - c;
  const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0.0f && d5 <= d6) return c;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) return a + ac * (d2 / (d2 - d6));
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) {
    return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  }
  const float denominator = 1.0f / (va + vb + vc);
  return a + ab * (vb * denominator) + ac * (vc * denominator);
}

/// A posed mesh node.
struct PosedNode {
  std::vector<Vec3> positions, normals;
  std::vector<Triangle> faces;
};

PosedNode posed(const RawMeshNode& node, const std::vector<Mat4>& matrices) {
  PosedNode result;
  for (const RawPrimitive& primitive : node.primitives) {
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (const RawVertex& vertex : primitive.vertices) {
      result.positions.push_back(skinPosition(vertex, matrices));
      result.normals.push_back(vertex.normal);
    }
    for (const Triangle& face : primitive.faces) {
      result.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
    }
  }
  return result;
}

/// How far a body vertex stands out of cloth along the cloth's normal.
struct Standing {
  float out = -1.0f;
  float gap = std::numeric_limits<float>::max();
  Vec3 cloth_normal{0.0f};
  bool is_inside_a_face = false;  // the nearest cloth is no edge
};

Standing standingOf(const Vec3& p, const PosedNode& garment, const std::vector<std::uint32_t>& faces) {
  Standing standing;
  for (const std::uint32_t f : faces) {
    const Triangle& face = garment.faces[f];
    const Vec3 &a = garment.positions[face[0]], &b = garment.positions[face[1]],
               &c = garment.positions[face[2]];
    const Vec3 nearest = nearestOnTriangle(p, a, b, c);
    const float gap = glm::distance(p, nearest);
    const Vec3 normal = glm::cross(b - a, c - a);
    if (gap >= standing.gap || glm::length(normal) < 1e-12f) continue;
    standing.gap = gap;
    standing.cloth_normal = glm::normalize(normal);
    standing.out = glm::dot(p - nearest, standing.cloth_normal);
    standing.is_inside_a_face = std::abs(standing.out) > 0.999f * gap;
  }
  return standing;
}

/// Moves with the head alone, and lies on hair that is painted on.
bool isHeadwear(const RawAsset& outfit, const RawMeshNode& node) {
  for (const RawPrimitive& primitive : node.primitives) {
    for (const RawVertex& vertex : primitive.vertices) {
      const std::uint32_t bone = outfit.skeleton.joints[vertex.skin.joints[0]].bone;
      if (vertex.skin.weights[0] < 1.0f || outfit.skeleton.bones[bone].name != "head") return false;
    }
  }
  return true;
}

/// A body vertex and the part of a garment that lies over it at rest.
struct Covered {
  std::size_t vertex, node;
  std::vector<std::uint32_t> faces;
};

/// The vertices of `body` under garments at rest; counts what stands out of them already.
std::vector<Covered> findCovered(const RawAsset& outfit, const PosedNode& body,
                                 const std::vector<Mat4>& at_rest, std::size_t& out_at_rest) {
  constexpr float kNear = 0.04f;
  std::vector<Covered> covered;
  for (std::size_t n = 1; n < outfit.meshes.size(); ++n) {
    if (isHeadwear(outfit, outfit.meshes[n])) continue;
    const PosedNode cloth = posed(outfit.meshes[n], at_rest);
    for (std::size_t v = 0; v < body.positions.size(); ++v) {
      std::vector<std::uint32_t> faces;
      for (std::uint32_t f = 0; f < cloth.faces.size(); ++f) {
        const Triangle& face = cloth.faces[f];
        const float gap = glm::distance(
            body.positions[v], nearestOnTriangle(body.positions[v], cloth.positions[face[0]],
                                                 cloth.positions[face[1]], cloth.positions[face[2]]));
        if (gap < kNear) faces.push_back(f);
      }
      const Standing standing = standingOf(body.positions[v], cloth, faces);
      const bool same_way = glm::dot(standing.cloth_normal, body.normals[v]) > 0.3f;
      if (standing.gap > (standing.out > 0.0f ? 0.01f : 0.03f) || !same_way || !standing.is_inside_a_face)
        continue;
      out_at_rest += standing.out >= kPoke ? 1 : 0;
      if (standing.out < 0.0f) covered.push_back({v, n, std::move(faces)});
    }
  }
  return covered;
}

}  // namespace

PokeThrough countPokeThrough(const RawAsset& person, const RawAsset& outfit) {
  const RawSkeleton& skeleton = person.skeleton;
  const RawMeshNode& body = outfit.meshes.front();
  const std::vector<Mat4> at_rest = skinningMatrices(skeleton, restPose(skeleton));
  PokeThrough count;
  const std::vector<Covered> covered = findCovered(outfit, posed(body, at_rest), at_rest, count.at_rest);
  for (const RawClip& raw_clip : person.clips) {
    const Clip clip = sampleClip(skeleton, raw_clip);
    for (std::uint32_t key = 0; key + 1 < clip.key_count; key += clip.key_count > 100 ? 30 : 3) {
      const std::vector<Mat4> matrices = skinningMatrices(skeleton, clip.key(key));
      const PosedNode moved = posed(body, matrices);
      std::size_t node = 0;
      PosedNode cloth;
      for (const Covered& place : covered) {
        if (place.node != node) cloth = posed(outfit.meshes[node = place.node], matrices);
        const Standing standing = standingOf(moved.positions[place.vertex], cloth, place.faces);
        ++count.looked_at;
        const bool pokes = standing.is_inside_a_face && standing.gap < 0.03f && standing.out > kPoke;
        count.poking += pokes ? 1 : 0;
      }
    }
  }
  return count;
}

}  // namespace ensemble::testing
