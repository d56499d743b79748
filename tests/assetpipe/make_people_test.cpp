#include "assetpipe/make_people.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "assetpipe/people_body.h"
#include "assetpipe/people_clips.h"
#include "core/clip.h"
#include "core/gltf_file.h"
#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

PersonConfig configOf(Sex sex) {
  PersonConfig config;
  config.name = sex == Sex::kFemale ? "woman" : "man";
  config.figure = {sex, sex == Sex::kFemale ? 1.67f : 1.79f, 0.0f};
  config.seed = 3;
  return config;
}

/// Their bodies, made once a process.
const RawAsset& templatePerson(Sex sex) {
  static std::map<Sex, RawAsset> made;
  auto found = made.find(sex);
  if (found == made.end()) found = made.emplace(sex, makeTemplatePerson(configOf(sex))).first;
  return found->second;
}

class EachSex : public ::testing::TestWithParam<Sex> {};
INSTANTIATE_TEST_SUITE_P(People, EachSex, ::testing::Values(Sex::kFemale, Sex::kMale),
                         [](const auto& sex) { return sex.param == Sex::kFemale ? "Woman" : "Man"; });

struct PositionOrder {
  bool operator()(const Vec3& a, const Vec3& b) const {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
};

/// A node's faces over distinct positions, all primitives together.
struct WeldedMesh {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
};

WeldedMesh weld(const RawMeshNode& node) {
  WeldedMesh mesh;
  std::map<Vec3, std::uint32_t, PositionOrder> numbers;
  for (const RawPrimitive& primitive : node.primitives) {
    for (Triangle face : primitive.faces) {
      for (std::uint32_t& corner : face) {
        const Vec3& position = primitive.vertices[corner].position;
        const auto [entry, is_new] =
            numbers.try_emplace(position, static_cast<std::uint32_t>(mesh.positions.size()));
        if (is_new) mesh.positions.push_back(position);
        corner = entry->second;
      }
      mesh.faces.push_back(face);
    }
  }
  return mesh;
}

std::size_t faceCount(const RawMeshNode& node) {
  std::size_t count = 0;
  for (const RawPrimitive& primitive : node.primitives) count += primitive.faces.size();
  return count;
}

TEST_P(EachSex, BodyIsAClosedSurfaceFacingOutwards) {
  const RawAsset& made = templatePerson(GetParam());
  const WeldedMesh body = weld(made.meshes.front());
  EXPECT_GE(body.faces.size(), 3000u);
  EXPECT_LE(body.faces.size(), 3500u);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double volume = 0.0;
  for (const Triangle& face : body.faces) {
    const Vec3 a = body.positions[face[0]], b = body.positions[face[1]], c = body.positions[face[2]];
    EXPECT_GT(glm::length(glm::cross(b - a, c - a)), 2e-9f) << "a face without area at y = " << a.y;
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
    for (int i = 0; i < 3; ++i) ++edges[{face[i], face[(i + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(edges.contains({edge.second, edge.first})) << "a border";
  }
  // A sphere's topology: one piece, no handles (as fingers grown together would make).
  EXPECT_EQ(static_cast<int>(body.positions.size()) - static_cast<int>(body.faces.size()) / 2, 2);
  // About a litre for each kilogram.
  EXPECT_GT(volume, 0.045);
  EXPECT_LT(volume, 0.095);
}

TEST_P(EachSex, BodyStandsAsTheConventionSays) {
  const RawAsset& made = templatePerson(GetParam());
  const RawMeshNode& body = made.meshes.front();
  EXPECT_EQ(body.name, "body");
  ASSERT_EQ(body.primitives.size(), 6u);
  float lowest = 1e9f, highest = -1e9f, widest = 0.0f;
  for (std::uint32_t region = 0; region < 6; ++region) {
    const RawPrimitive& primitive = body.primitives[region];
    EXPECT_EQ(made.materials[primitive.material].name, kBodyRegionNames[region]);
    EXPECT_FALSE(made.materials[primitive.material].double_sided);
    EXPECT_GT(primitive.faces.size(), 150u) << kBodyRegionNames[region];
    for (const RawVertex& vertex : primitive.vertices) {
      lowest = std::min(lowest, vertex.position.y);
      highest = std::max(highest, vertex.position.y);
      widest = std::max(widest, std::abs(vertex.position.x));
      EXPECT_NEAR(glm::length(vertex.normal), 1.0f, 1e-4f);
      EXPECT_NEAR(
          vertex.skin.weights[0] + vertex.skin.weights[1] + vertex.skin.weights[2] + vertex.skin.weights[3],
          1.0f, 1e-5f);
      EXPECT_TRUE(std::is_sorted(vertex.skin.weights.rbegin(), vertex.skin.weights.rend()));
    }
  }
  EXPECT_NEAR(lowest, 0.0f, 0.003f);
  EXPECT_NEAR(highest, GetParam() == Sex::kFemale ? 1.67f : 1.79f, 0.012f);
  EXPECT_LT(widest, 0.75f);
  const RawSkeleton& skeleton = made.skeleton;
  ASSERT_EQ(skeleton.joints.size(), 53u);
  EXPECT_EQ(skeleton.bones[0].name, "Root");
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b)
    EXPECT_LT(skeleton.bones[b].parent, static_cast<int>(b));
  std::vector<Mat4> pose(skeleton.bones.size());
  globalPose(skeleton, restPose(skeleton), pose);
  for (std::size_t b = 0; b < pose.size(); ++b) {
    const bool is_right = skeleton.bones[b].name.ends_with("_r");
    const bool is_left = skeleton.bones[b].name.ends_with("_l");
    EXPECT_EQ(pose[b][3].x < -0.01f, is_right) << skeleton.bones[b].name;
    EXPECT_EQ(pose[b][3].x > 0.01f, is_left) << skeleton.bones[b].name;
    const Mat4 unity = pose[b] * skeleton.joints[b].joint_from_model;
    for (int column = 0; column < 4; ++column) {
      EXPECT_LT(glm::length(unity[column] - Mat4(1.0f)[column]), 1e-4f);
    }
  }
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
    EXPECT_LT(faceCount(outfit.fitted.meshes.front()), faceCount(made.body.meshes.front()) * 4 / 5)
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

std::vector<RawVertex> nodeVertices(const RawMeshNode& node) {
  std::vector<RawVertex> vertices;
  for (const RawPrimitive& primitive : node.primitives) {
    vertices.insert(vertices.end(), primitive.vertices.begin(), primitive.vertices.end());
  }
  return vertices;
}

TEST_P(EachSex, ClipsLoopAndAreInPlace) {
  const RawAsset& made = templatePerson(GetParam());
  ASSERT_EQ(made.clips.size(), 2u);
  const Clip walk = sampleClip(made.skeleton, made.clips[0]);
  const Clip idle = sampleClip(made.skeleton, made.clips[1]);
  EXPECT_EQ(walk.name, "walk");
  EXPECT_EQ(walk.key_count, 34u);
  EXPECT_NEAR(walk.seconds, 1.1f, 1e-4f);
  EXPECT_EQ(idle.name, "idle");
  EXPECT_EQ(idle.key_count, 121u);
  EXPECT_NEAR(idle.seconds, 4.0f, 1e-4f);
  for (const Clip& clip : {walk, idle}) {
    for (std::size_t b = 0; b < made.skeleton.bones.size(); ++b) {
      const Transform &first = clip.key(0)[b], &last = clip.key(clip.key_count - 1)[b];
      EXPECT_EQ(first.translation, last.translation);
      EXPECT_EQ(first.rotation, last.rotation);
      // No key jumps: under 20 degrees from one to the next.
      for (std::uint32_t k = 0; k + 1 < clip.key_count; ++k) {
        EXPECT_GT(std::abs(glm::dot(clip.key(k)[b].rotation, clip.key(k + 1)[b].rotation)),
                  std::cos(radians(10.0f)))
            << clip.name << " key " << k << " " << made.skeleton.bones[b].name;
      }
    }
  }
}

/// The foot's lowest vertices must stand still on the moving ground while the foot stands.
TEST_P(EachSex, PlantedFeetDoNotSlide) {
  const RawAsset& made = templatePerson(GetParam());
  const RawSkeleton& skeleton = made.skeleton;
  const Clip walk = sampleClip(skeleton, made.clips[0]);
  const std::vector<RawVertex> vertices = nodeVertices(made.meshes.front());
  const float speed = walkSpeed(makeFigure(configOf(GetParam()).figure));
  const float step = walk.seconds / static_cast<float>(walk.key_count - 1);
  float lowest = 0.0f, worst_drift = 0.0f;
  std::map<std::size_t, Vec3> standing;  // vertex, where on the ground it came down
  for (std::uint32_t key = 0; key < walk.key_count; ++key) {
    const std::vector<Mat4> now = skinningMatrices(skeleton, walk.key(key));
    const float ground = speed * step * static_cast<float>(key);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      if (vertices[v].position.y > 0.06f) continue;
      Vec3 position = skinPosition(vertices[v], now);
      lowest = std::min(lowest, position.y);
      position.z += ground;  // on the ground, which moves backwards under a figure in place
      if (position.y > 0.004f) {
        standing.erase(v);
        continue;
      }
      const auto [entry, came_down] = standing.try_emplace(v, position);
      if (came_down) continue;
      const Vec3 drift = position - entry->second;
      worst_drift = std::max(worst_drift, glm::length(Vec2(drift.x, drift.z)));
    }
  }
  EXPECT_LT(worst_drift, 0.01f);
  EXPECT_GT(lowest, -0.01f) << "a foot goes into the ground";
  EXPECT_GT(speed, 0.9f);
  EXPECT_LT(speed, 1.4f);
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
TEST_P(EachSex, OutfitsAreSound) {
  const MadePerson made = makePerson(configOf(GetParam()));
  expectOutfitsDifferAndShareGarments(made);
  expectFittedBodiesAreParts(made);
  expectSkinDoesNotPokeThrough(made);
}

TEST(MakePeople, SameConfigurationGivesTheSameBytes) {
  PersonConfig config = configOf(Sex::kMale);
  config.outfits = {"casual"};
  const MadePerson first = makePerson(config, 1), again = makePerson(config, 3);
  EXPECT_EQ(writeGlb(again.body), writeGlb(first.body));
  EXPECT_EQ(writeGlb(makeTemplatePerson(config)), writeGlb(first.body));
  ASSERT_EQ(again.outfits.size(), 1u);
  EXPECT_EQ(writeGlb(again.outfits[0].fitted), writeGlb(first.outfits[0].fitted));
  EXPECT_EQ(writeGlb(again.outfits[0].unfitted), writeGlb(first.outfits[0].unfitted));
}

TEST(MakePeople, FilesAreReadBackAsMade) {
  const testing::TemporaryFolder folder;
  PersonConfig config = configOf(Sex::kFemale);
  config.outfits = {"summer"};
  const MadePerson made = makePerson(config);
  const auto files = writePerson(made, folder.path());
  ASSERT_EQ(files.size(), 3u);
  EXPECT_EQ(files[0], folder.path() / "woman" / "template.glb");
  EXPECT_EQ(files[1], folder.path() / "woman" / "outfits" / "summer.glb");
  EXPECT_EQ(files[2], folder.path() / "woman" / "unfitted" / "summer.glb");
  const RawAsset body = readGltf(files[0]), outfit = readGltf(files[1]);
  EXPECT_TRUE(body.warnings.empty());
  ASSERT_EQ(body.meshes.size(), 1u);
  EXPECT_EQ(faceCount(body.meshes[0]), faceCount(made.body.meshes[0]));
  EXPECT_EQ(body.skeleton.joints.size(), 53u);
  ASSERT_EQ(body.clips.size(), 2u);
  EXPECT_EQ(body.clips[0].name, "walk");
  ASSERT_EQ(outfit.meshes.size(), made.outfits[0].fitted.meshes.size());
  for (std::size_t n = 0; n < outfit.meshes.size(); ++n) {
    EXPECT_EQ(outfit.meshes[n].name, made.outfits[0].fitted.meshes[n].name);
    EXPECT_EQ(faceCount(outfit.meshes[n]), faceCount(made.outfits[0].fitted.meshes[n]));
  }
}

TEST(MakePeople, ExtremeFiguresAreSound) {
  for (const FigureOptions& options :
       {FigureOptions{Sex::kFemale, 1.45f, 1.0f}, FigureOptions{Sex::kMale, 2.05f, -1.0f}}) {
    const Figure figure = makeFigure(options);
    const FieldMesh mesh = makeBodyMesh(figure, 3300);
    EXPECT_EQ(static_cast<int>(mesh.positions.size()) - static_cast<int>(mesh.faces.size()) / 2, 2)
        << options.height;
    std::set<std::uint8_t> labels(mesh.labels.begin(), mesh.labels.end());
    EXPECT_EQ(labels.size(), 6u);
  }
}

PeopleConfig parse(const std::string& text) { return parsePeopleConfig(text, "p.yaml"); }

TEST(PeopleConfig, ReadsEveryKey) {
  const PeopleConfig config = parse(
      "version: 1\n"
      "people:\n"
      "  - {name: ann, sex: female, height: 1.7, build: 0.5, seed: 7, skin: tan, hair: [1, 0, 0], outfits: "
      "[summer], faces: 4000}\n"
      "  - {name: bob, sex: male}\n");
  ASSERT_EQ(config.people.size(), 2u);
  const PersonConfig& ann = config.people[0];
  EXPECT_EQ(ann.name, "ann");
  EXPECT_EQ(ann.figure.sex, Sex::kFemale);
  EXPECT_FLOAT_EQ(ann.figure.height, 1.7f);
  EXPECT_FLOAT_EQ(ann.figure.build, 0.5f);
  EXPECT_EQ(ann.seed, 7u);
  EXPECT_EQ(ann.colors.hair, Vec3(1.0f, 0.0f, 0.0f));
  EXPECT_EQ(ann.outfits, std::vector<std::string>{"summer"});
  EXPECT_EQ(ann.body_faces, 4000u);
  EXPECT_EQ(config.people[1].figure.sex, Sex::kMale);
  EXPECT_TRUE(config.people[1].outfits.empty());
}

TEST(PeopleConfig, ErrorsTellHowToMend) {
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: []\n"),
                     "p.yaml: 2:9: people is empty; add {name: woman, sex: female}");
  EXPECT_INPUT_ERROR(parse("version: 1\n"),
                     "p.yaml: 1:1: the file has no people; add people: [{name: woman, sex: female}]");
  EXPECT_INPUT_ERROR(parse("people: [{name: a, sex: male}]\n"),
                     "p.yaml: 1:1: the file has no version; add version: 1");
  EXPECT_INPUT_ERROR(parse("version: 2\npeople: [{name: a, sex: male}]\n"),
                     "p.yaml: 1:10: version is '2'; give a whole number from 1 to 1");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a}]\n"),
                     "p.yaml: 2:10: people.0 has no sex; add sex: female or sex: male");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a, sex: mail}]\n"),
                     "p.yaml: 2:25: people.0.sex is 'mail'; give 'female' or 'male'");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: ../a, sex: male}]\n"),
                     "p.yaml: 2:17: people.0.name is '../a', which can't be a folder's name; use up to 64 "
                     "letters, digits, '-' and '_'");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a, sex: male, height: 3}]\n"),
                     "p.yaml: 2:39: people.0.height is '3'; give a number from 1.4 to 2.1 (metres)");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a, sex: male, hight: 1.7}]\n"),
                     "p.yaml: 2:31: unknown key 'hight' in people.0; write 'height' (known: name, sex, "
                     "height, build, seed, skin, hair, outfits, faces)");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a, sex: male, skin: green}]\n"),
                     "p.yaml: 2:37: people.0.skin is 'green', which is no colour known here; write 'pale', "
                     "'fair', 'olive', 'tan', 'brown' or 'dark' or [r, g, b] from 0 to 1");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a, sex: male, outfits: [suite]}]\n"),
                     "p.yaml: 2:41: people.0.outfits.0 is 'suite', which is no outfit; did you mean 'suit'? "
                     "There are 'casual', 'suit', 'sport' and 'weekend'");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a, sex: male, outfits: [suit, suit]}]\n"),
                     "p.yaml: 2:47: people.0.outfits.1 is 'suit', which is there twice; leave one out");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a, sex: male}, {name: a, sex: male}]\n"),
                     "p.yaml: 2:32: the name 'a' is there twice; give each person a name of its own");
}

}  // namespace
}  // namespace ensemble
