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

#include "assetpipe/built_in_recipes.h"
#include "assetpipe/ground_speed.h"
#include "assetpipe/people_body.h"
#include "assetpipe/people_clips.h"
#include "assetpipe/people_colors.h"
#include "core/clip.h"
#include "core/color.h"
#include "core/gltf_file.h"
#include "core/nearest_name.h"
#include "tests/assetpipe/person_config.h"
#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

using testing::configOf;

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

std::vector<RawVertex> nodeVertices(const RawMeshNode& node) {
  std::vector<RawVertex> vertices;
  for (const RawPrimitive& primitive : node.primitives) {
    vertices.insert(vertices.end(), primitive.vertices.begin(), primitive.vertices.end());
  }
  return vertices;
}

struct ClipFacts {
  const char* name;
  std::uint32_t keys;
  float seconds;
};
constexpr ClipFacts kClips[] = {
    {"walk", 34, 1.1f}, {"run", 43, 0.7f}, {"idle", 121, 4.0f}, {"talk", 181, 6.0f}, {"cheer", 49, 1.6f}};

TEST_P(EachSex, ClipsLoopAndAreInPlace) {
  const RawAsset& made = templatePerson(GetParam());
  ASSERT_EQ(made.clips.size(), std::size(kClips));
  for (std::size_t c = 0; c < made.clips.size(); ++c) {
    const Clip clip = sampleClip(made.skeleton, made.clips[c]);
    EXPECT_EQ(clip.name, kClips[c].name);
    EXPECT_EQ(clip.key_count, kClips[c].keys) << clip.name;
    EXPECT_NEAR(clip.seconds, kClips[c].seconds, 1e-4f) << clip.name;
    for (std::size_t b = 0; b < made.skeleton.bones.size(); ++b) {
      const Transform &first = clip.key(0)[b], &last = clip.key(clip.key_count - 1)[b];
      EXPECT_EQ(first.translation, last.translation);
      EXPECT_EQ(first.rotation, last.rotation);
      // No key jumps, over the seam neither: under 20 degrees from one to the next.
      for (std::uint32_t k = 0; k + 1 < clip.key_count; ++k) {
        EXPECT_GT(std::abs(glm::dot(clip.key(k)[b].rotation, clip.key(k + 1)[b].rotation)),
                  std::cos(radians(10.0f)))
            << clip.name << " key " << k << " " << made.skeleton.bones[b].name;
      }
    }
  }
}

/// How the soles of a body meet a ground that moves backwards under it.
struct Steps {
  float worst_drift = 0.0f;       // metres that a vertex moves on the ground while it stands
  float lowest = 0.0f;            // metres
  std::uint32_t airborne = 0;     // keys at which nothing touches the ground
  std::size_t most_standing = 0;  // vertices that stand at one key
};

Steps stepsOf(const RawAsset& made, const Clip& clip, float speed) {
  const std::vector<RawVertex> vertices = nodeVertices(made.meshes.front());
  const float step = clip.seconds / static_cast<float>(clip.key_count - 1);
  Steps steps;
  std::map<std::size_t, Vec3> standing;  // vertex, where on the ground it came down
  for (std::uint32_t key = 0; key < clip.key_count; ++key) {
    const std::vector<Mat4> now = skinningMatrices(made.skeleton, clip.key(key));
    const float ground = speed * step * static_cast<float>(key);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      if (vertices[v].position.y > 0.06f) continue;
      Vec3 position = skinPosition(vertices[v], now);
      steps.lowest = std::min(steps.lowest, position.y);
      position.z += ground;  // on the ground, which moves backwards under a figure in place
      if (position.y > 0.004f) {
        standing.erase(v);
        continue;
      }
      const auto [entry, came_down] = standing.try_emplace(v, position);
      if (came_down) continue;
      const Vec3 drift = position - entry->second;
      steps.worst_drift = std::max(steps.worst_drift, glm::length(Vec2(drift.x, drift.z)));
    }
    steps.airborne += standing.empty() ? 1 : 0;
    steps.most_standing = std::max(steps.most_standing, standing.size());
  }
  return steps;
}

/// The foot's lowest vertices must stand still on the moving ground while the foot stands.
TEST_P(EachSex, PlantedFeetDoNotSlide) {
  const RawAsset& made = templatePerson(GetParam());
  const Figure figure = makeFigure(configOf(GetParam()).figure);
  const std::map<std::string, float> speeds = {{"walk", walkSpeed(figure)}, {"run", runSpeed(figure)}};
  EXPECT_GT(speeds.at("walk"), 0.9f);
  EXPECT_LT(speeds.at("walk"), 1.4f);
  EXPECT_GT(speeds.at("run"), 2.2f);
  EXPECT_LT(speeds.at("run"), 3.2f);
  for (const RawClip& raw_clip : made.clips) {
    const Clip clip = sampleClip(made.skeleton, raw_clip);
    const float speed = speeds.contains(clip.name) ? speeds.at(clip.name) : 0.0f;
    const Steps steps = stepsOf(made, clip, speed);
    RecordProperty(clip.name + "_drift_mm", std::to_string(1000.0f * steps.worst_drift));
    EXPECT_LT(steps.worst_drift, 0.01f) << clip.name;
    EXPECT_GT(steps.lowest, -0.01f) << clip.name << ": a foot goes into the ground";
    EXPECT_GT(steps.most_standing, 10u) << clip.name << ": nobody floats";
    EXPECT_EQ(steps.airborne > 0, clip.name == "run") << clip.name;
    // The speed that tagging will find in the clip, from its feet alone.
    EXPECT_NEAR(groundSpeed(made.skeleton, clip), speed, 0.01f * speed) << clip.name;
  }
}

TEST(MakePeople, SameConfigurationGivesTheSameBytes) {
  PersonConfig config = configOf(Sex::kMale);
  config.outfits = {"cap", "shorts", "vest"};
  const MadePerson first = makePerson(config, 1), again = makePerson(config, 3);
  EXPECT_EQ(writeGlb(again.body), writeGlb(first.body));
  EXPECT_EQ(writeGlb(makeTemplatePerson(config)), writeGlb(first.body));
  ASSERT_EQ(again.outfits.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again.outfits[i].recipe.name, config.outfits[i]);
    EXPECT_EQ(writeGlb(again.outfits[i].outfit.asset), writeGlb(first.outfits[i].outfit.asset));
  }
}

TEST(MakePeople, FilesAreReadBackAsMade) {
  const testing::TemporaryFolder folder;
  PersonConfig config = configOf(Sex::kFemale);
  config.outfits = {"summer_dress"};
  const MadePerson made = makePerson(config);
  const auto files = writePerson(made, folder.path());
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0], folder.path() / "woman" / "template.glb");
  EXPECT_EQ(files[1], folder.path() / "woman" / "outfits" / "summer_dress.glb");
  const RawAsset body = readGltf(files[0]), outfit = readGltf(files[1]);
  EXPECT_TRUE(body.warnings.empty());
  ASSERT_EQ(body.meshes.size(), 1u);
  EXPECT_EQ(faceCount(body.meshes[0]), faceCount(made.body.meshes[0]));
  EXPECT_EQ(body.skeleton.joints.size(), 53u);
  ASSERT_EQ(body.clips.size(), 5u);
  EXPECT_EQ(body.clips[0].name, "walk");
  const RawAsset& dressed = made.outfits[0].outfit.asset;
  ASSERT_EQ(outfit.meshes.size(), dressed.meshes.size());
  for (std::size_t n = 0; n < outfit.meshes.size(); ++n) {
    EXPECT_EQ(outfit.meshes[n].name, dressed.meshes[n].name);
    EXPECT_EQ(faceCount(outfit.meshes[n]), faceCount(dressed.meshes[n]));
  }
}

TEST(MakePeople, ABodyThatCutsItselfIsRefused) {
  FieldMesh mesh;
  for (const float start : {0.0f, 0.2f}) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& corner : {Vec3(0.0f), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)})
      mesh.positions.push_back(corner + start);
    for (const Triangle& face : {Triangle{0, 2, 1}, Triangle{0, 1, 3}, Triangle{0, 3, 2}, Triangle{1, 2, 3}})
      mesh.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
    if (first == 0) {
      EXPECT_NO_THROW(requireSoundBody("ann", mesh));
    }
  }
  EXPECT_INPUT_ERROR(
      requireSoundBody("ann", mesh),
      "person 'ann': a body of 8 faces cuts itself at (0.53, 0.53, 0.20); give it more faces, or "
      "less extreme measures");
}

PeopleConfig parse(const std::string& text) { return parsePeopleConfig(text, "p.yaml"); }

TEST(PeopleConfig, ReadsEveryKey) {
  const PeopleConfig config = parse(
      "version: 1\n"
      "people:\n"
      "  - {name: ann, sex: female, age: old, height: 1.7, girth: -0.25, build: 0.5, seed: 7, skin: tan, "
      "hair: [1, 0, 0], outfits: "
      "[shirt, jeans], faces: 4000}\n"
      "  - {name: bob, sex: male}\n");
  ASSERT_EQ(config.people.size(), 2u);
  const PersonConfig& ann = config.people[0];
  EXPECT_EQ(ann.name, "ann");
  EXPECT_EQ(ann.figure.sex, Sex::kFemale);
  EXPECT_FLOAT_EQ(ann.figure.height, 1.7f);
  EXPECT_FLOAT_EQ(ann.figure.build, 0.5f);
  EXPECT_EQ(ann.figure.age, AgeGroup::kOld);
  EXPECT_FLOAT_EQ(ann.figure.girth, -0.25f);
  EXPECT_FLOAT_EQ(ann.figure.build, 0.5f);
  EXPECT_EQ(ann.seed, 7u);
  EXPECT_EQ(ann.colors.hair, Vec3(1.0f, 0.0f, 0.0f));
  EXPECT_EQ(ann.outfits, (std::vector<std::string>{"shirt", "jeans"}));
  EXPECT_EQ(ann.body_faces, 4000u);
  EXPECT_EQ(config.people[1].figure.sex, Sex::kMale);
  EXPECT_EQ(config.people[1].figure.age, AgeGroup::kAdult);
  EXPECT_FLOAT_EQ(config.people[1].figure.girth, 0.0f);
  EXPECT_TRUE(config.people[1].outfits.empty());
}

TEST(PeopleConfig, AgeSetsHeightAndHairUnlessTheyAreGiven) {
  const PeopleConfig config = parse(
      "version: 1\npeople: [{name: a, sex: male, age: young}, {name: b, sex: male, age: old}, "
      "{name: c, sex: male, age: old, height: 1.8, hair: black}]\n");
  EXPECT_FLOAT_EQ(config.people[0].figure.height, 1.65f);
  EXPECT_FLOAT_EQ(config.people[1].figure.height, 1.73f);
  EXPECT_EQ(config.people[1].colors.hair, linearFromSrgb(greyHair()));
  EXPECT_FLOAT_EQ(config.people[2].figure.height, 1.8f);
  EXPECT_NE(config.people[2].colors.hair, linearFromSrgb(greyHair()));
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
                     "p.yaml: 2:31: unknown key 'hight' in people.0; write 'height' (known: name, sex, age, "
                     "height, girth, build, seed, skin, hair, outfits, faces)");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a, sex: male, girth: 1.5}]\n"),
                     "p.yaml: 2:38: people.0.girth is '1.5'; give a number from -1 to 1");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a, sex: male, build: stout}]\n"),
                     "p.yaml: 2:38: people.0.build is 'stout'; give a number from -1 to 1");
  EXPECT_INPUT_ERROR(
      parse("version: 1\npeople: [{name: a, sex: male, age: 30}]\n"),
      "p.yaml: 2:36: people.0.age is '30'; give 'young', 'adult' or 'old'; the nearest is 'old'");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a, sex: male, skin: green}]\n"),
                     "p.yaml: 2:37: people.0.skin is 'green', which is no colour known here; write 'pale', "
                     "'fair', 'olive', 'tan', 'brown' or 'dark' or [r, g, b] from 0 to 1");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a, sex: male, outfits: [suite]}]\n"),
                     "p.yaml: 2:41: people.0.outfits.0 is 'suite', which is no recipe of the program's; did "
                     "you mean 'suit'? "
                     "There are " +
                         quotedList(builtInRecipeNames(), "and"));
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a, sex: male, outfits: [suit, suit]}]\n"),
                     "p.yaml: 2:47: people.0.outfits.1 is 'suit', which is there twice; leave one out");
  EXPECT_INPUT_ERROR(parse("version: 1\npeople: [{name: a, sex: male}, {name: a, sex: male}]\n"),
                     "p.yaml: 2:32: the name 'a' is there twice; give each person a name of its own");
}

}  // namespace
}  // namespace ensemble
