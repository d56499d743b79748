#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "assetpipe/make_people.h"
#include "core/clip.h"
#include "tests/assetpipe/person_config.h"

namespace ensemble {
namespace {

using testing::configOf;

class EachWardrobe : public ::testing::TestWithParam<Sex> {};
INSTANTIATE_TEST_SUITE_P(People, EachWardrobe, ::testing::Values(Sex::kFemale, Sex::kMale),
                         [](const auto& sex) { return sex.param == Sex::kFemale ? "Woman" : "Man"; });

struct PositionOrder {
  bool operator()(const Vec3& a, const Vec3& b) const {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
};

std::size_t faceCount(const RawMeshNode& node) {
  std::size_t count = 0;
  for (const RawPrimitive& primitive : node.primitives) count += primitive.faces.size();
  return count;
}

void expectOutfitsDifferAndShareGarments(const MadePerson& made) {
  ASSERT_GE(made.outfits.size(), 3u);
  std::map<std::string, const RawMeshNode*> garments;
  std::set<std::set<std::string>> combinations;
  bool some_shared = false;
  for (const MadeOutfit& outfit : made.outfits) {
    std::set<std::string> names;
    std::size_t faces = 0;
    for (std::size_t i = 1; i < outfit.fitted.meshes.size(); ++i) {
      const RawMeshNode& node = outfit.fitted.meshes[i];
      EXPECT_TRUE(node.name.starts_with("garment.")) << node.name;
      names.insert(node.name);
      faces += faceCount(node);
      const auto [entry, is_new] = garments.try_emplace(node.name, &node);
      some_shared = some_shared || !is_new;
      ASSERT_EQ(entry->second->primitives.size(), node.primitives.size());
      for (std::size_t p = 0; p < node.primitives.size(); ++p) {
        EXPECT_EQ(entry->second->primitives[p].vertices, node.primitives[p].vertices);
        EXPECT_EQ(entry->second->primitives[p].faces, node.primitives[p].faces);
        EXPECT_EQ(outfit.unfitted.meshes[i].primitives[p], node.primitives[p]);
      }
    }
    EXPECT_TRUE(combinations.insert(names).second) << outfit.name;
    EXPECT_GE(faces, 3000u) << outfit.name;
    EXPECT_LE(faces, 7500u) << outfit.name;
    EXPECT_TRUE(outfit.fitted.clips.empty());
  }
  EXPECT_TRUE(some_shared);
}

using FaceKey = std::array<Vec3, 3>;
struct FaceOrder {
  bool operator()(const FaceKey& a, const FaceKey& b) const {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), PositionOrder());
  }
};

void expectFittedBodiesAreParts(const MadePerson& made) {
  std::map<std::string, std::vector<FaceKey>> template_faces;
  const auto key = [](const RawPrimitive& primitive, const Triangle& face) {
    return FaceKey{primitive.vertices[face[0]].position, primitive.vertices[face[1]].position,
                   primitive.vertices[face[2]].position};
  };
  for (const RawPrimitive& primitive : made.body.meshes.front().primitives) {
    for (const Triangle& face : primitive.faces) {
      template_faces[made.body.materials[primitive.material].name].push_back(key(primitive, face));
    }
  }
  for (const MadeOutfit& outfit : made.outfits) {
    EXPECT_EQ(faceCount(outfit.unfitted.meshes.front()), faceCount(made.body.meshes.front()));
    // Half the faces are of head, hands and feet; a summer dress hides 20 % of all.
    EXPECT_LT(faceCount(outfit.fitted.meshes.front()), faceCount(made.body.meshes.front()) * 5 / 6)
        << outfit.name;
    bool head_is_full = false;
    for (const RawPrimitive& primitive : outfit.fitted.meshes.front().primitives) {
      const std::string& region = outfit.fitted.materials[primitive.material].name;
      // A subsequence of the template's faces, bit for bit.
      auto next = template_faces[region].begin();
      for (const Triangle& face : primitive.faces) {
        next = std::find(next, template_faces[region].end(), key(primitive, face));
        ASSERT_NE(next, template_faces[region].end()) << outfit.name << " " << region;
      }
      head_is_full = head_is_full ||
                     (region == "head" && primitive.faces.size() * 10 > template_faces[region].size() * 9);
    }
    EXPECT_TRUE(head_is_full) << outfit.name;
  }
}

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

/// A body vertex and the part of a garment that lies over it at rest.
struct Covered {
  std::size_t vertex, node;
  std::vector<std::uint32_t> faces;
};

/// The vertices of `body` under garments at rest; what stands out of them already is a failure.
std::vector<Covered> findCovered(const RawAsset& outfit, const PosedNode& body,
                                 const std::vector<Mat4>& at_rest) {
  constexpr float kNear = 0.04f;
  std::vector<Covered> covered;
  for (std::size_t n = 1; n < outfit.meshes.size(); ++n) {
    const std::string& name = outfit.meshes[n].name;
    if (name.starts_with("garment.hair") || name == "garment.face" || name == "garment.cap") continue;
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
      EXPECT_LT(standing.out, 0.002f) << name << " at rest";
      if (standing.out < 0.0f) covered.push_back({v, n, std::move(faces)});
    }
  }
  return covered;
}

/// What lies under cloth at rest must not stand out of it by more than 2 mm in motion.
std::pair<std::size_t, std::size_t> countPoking(const MadePerson& made, const RawAsset& outfit) {
  const RawSkeleton& skeleton = made.body.skeleton;
  const RawMeshNode& body = outfit.meshes.front();
  const std::vector<Mat4> at_rest = skinningMatrices(skeleton, restPose(skeleton));
  const std::vector<Covered> covered = findCovered(outfit, posed(body, at_rest), at_rest);
  std::size_t poking = 0, looked_at = 0;
  for (const RawClip& raw_clip : made.body.clips) {
    const Clip clip = sampleClip(skeleton, raw_clip);
    for (std::uint32_t key = 0; key + 1 < clip.key_count; key += clip.key_count > 100 ? 30 : 3) {
      const std::vector<Mat4> matrices = skinningMatrices(skeleton, clip.key(key));
      const PosedNode moved = posed(body, matrices);
      std::size_t node = 0;
      PosedNode cloth;
      for (const Covered& place : covered) {
        if (place.node != node) cloth = posed(outfit.meshes[node = place.node], matrices);
        const Standing standing = standingOf(moved.positions[place.vertex], cloth, place.faces);
        ++looked_at;
        const bool pokes = standing.is_inside_a_face && standing.gap < 0.03f && standing.out > 0.002f;
        if (pokes) ++poking;
      }
    }
  }
  return {poking, looked_at};
}

void expectSkinDoesNotPokeThrough(const MadePerson& made) {
  for (const MadeOutfit& outfit : made.outfits) {
    const auto [fitted, fitted_of] = countPoking(made, outfit.fitted);
    EXPECT_GT(fitted_of, 100u) << outfit.name;
    EXPECT_LE(fitted * 500, fitted_of) << outfit.name << ": " << fitted << " of " << fitted_of;
    const auto [unfitted, unfitted_of] = countPoking(made, outfit.unfitted);
    EXPECT_LE(unfitted * 100, unfitted_of) << outfit.name << ": " << unfitted << " of " << unfitted_of;
    ::testing::Test::RecordProperty(outfit.name, std::to_string(fitted) + "/" + std::to_string(fitted_of) +
                                                     ", complete body " + std::to_string(unfitted) + "/" +
                                                     std::to_string(unfitted_of));
  }
}

/// One test for all three, because making a person takes seconds.
TEST_P(EachWardrobe, OutfitsAreSound) {
  const MadePerson made = makePerson(configOf(GetParam()));
  expectOutfitsDifferAndShareGarments(made);
  expectFittedBodiesAreParts(made);
  expectSkinDoesNotPokeThrough(made);
}

}  // namespace
}  // namespace ensemble
