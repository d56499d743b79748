// Garments as they come out of a workshop: open, non-manifold, inside out, cut by themselves, elsewhere.
// `ensemble tag
// --auto-occlusion` finds what they hide, or says what is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/atomic_file.h"
#include "core/gltf_file.h"
#include "tests/cli/run_program.h"
#include "tests/support/small_people.h"

namespace ensemble {
namespace {

using testing::kTubeSegments;
using testing::ProgramResult;

constexpr int kBodyFaces = 3 * testing::kFacesPerRegion;
/// A sleeve as close as a shirt, over the middle of the tube of radius 0.2 m, 1.8 m high.
RawPrimitive sleeve(float radius = 0.21f, float bottom = 0.3f, float top = 1.5f) {
  return testing::tubeBand(3, radius, bottom, top, 8);
}

class OddGarments : public ::testing::Test {
 protected:
  struct Tagged {
    std::string err;  ///< what the program says of it
    std::set<std::pair<std::string, int>> hidden;
  };

  void SetUp() override { writeFileAtomically(folder_ / "template.glb", writeGlb(testing::tubeTemplate())); }

  /// Tags the whole body under one garment.
  Tagged tag(const RawPrimitive& cloth, bool is_double_sided = true) const {
    RawAsset outfit = testing::tubeOutfit([](int, int) { return true; });
    outfit.materials.back().double_sided = is_double_sided;
    outfit.meshes.back().primitives = {cloth};
    writeFileAtomically(folder_ / "odd.glb", writeGlb(outfit));
    ProgramResult result = run("tag template.glb odd.glb -o w --auto-occlusion");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    Tagged tagged{result.err, {}};
    result = run("inspect w --visible odd -q --json -");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const nlohmann::json shown = nlohmann::json::parse(result.out);
    for (const auto& region : shown["regions"]) {
      const std::set<int> visible(region["faces"].begin(), region["faces"].end());
      for (int face = 0; face < testing::kFacesPerRegion; ++face) {
        if (!visible.contains(face)) tagged.hidden.emplace(region["name"], face);
      }
    }
    return tagged;
  }
  ProgramResult run(const std::string& arguments) const {
    return testing::runProgram(arguments, folder_.path());
  }

  testing::TemporaryFolder folder_;
};

TEST_F(OddGarments, OpenMeshesHideWhatNoOneLooksInAt) {
  const Tagged closed_all_around = tag(sleeve());
  EXPECT_EQ(closed_all_around.err, "");
  EXPECT_GE(closed_all_around.hidden.size(), 64u) << "open at both ends";
  EXPECT_LT(closed_all_around.hidden.size(), std::size_t{kBodyFaces});
  RawPrimitive slit = sleeve();  // and without a strip of an eighth from hem to hem
  std::erase_if(slit.faces, [](const Triangle& face) {
    return std::all_of(face.begin(), face.end(), [](std::uint32_t v) { return v % kTubeSegments <= 1; });
  });
  const Tagged open = tag(slit);
  EXPECT_EQ(open.err, "");
  EXPECT_GE(open.hidden.size(), 32u);
  EXPECT_LT(open.hidden.size(), closed_all_around.hidden.size());
  EXPECT_TRUE(std::includes(closed_all_around.hidden.begin(), closed_all_around.hidden.end(),
                            open.hidden.begin(), open.hidden.end()));
}

TEST_F(OddGarments, EdgesOfManyFacesAndFacesOfNoAreaChangeNothing) {
  const Tagged plain = tag(sleeve());
  RawPrimitive odd = sleeve();
  // A fin on every edge of a ring, all faces a second time, faces that are a line or a point.
  const auto base = static_cast<std::uint32_t>(odd.vertices.size());
  const std::vector<Triangle> faces = odd.faces;
  for (std::uint32_t s = 0; s < kTubeSegments; ++s) {
    RawVertex tip = odd.vertices[s];
    tip.position *= Vec3(1.2f, 1.0f, 1.2f);
    odd.vertices.push_back(tip);
    odd.faces.push_back({s, (s + 1) % kTubeSegments, base + s});
    odd.faces.push_back({s, s, (s + 1) % kTubeSegments});
    odd.faces.push_back({s, s, s});
  }
  odd.faces.insert(odd.faces.end(), faces.begin(), faces.end());
  const Tagged tagged = tag(odd);
  EXPECT_EQ(tagged.err, "");
  EXPECT_EQ(tagged.hidden, plain.hidden);
}

TEST_F(OddGarments, InsideOutHidesAlikeWhereItsBacksAreDrawnAndElseIsTold) {
  RawPrimitive inverted = sleeve();
  for (Triangle& face : inverted.faces) std::swap(face[1], face[2]);
  for (RawVertex& vertex : inverted.vertices) vertex.normal = -vertex.normal;
  EXPECT_EQ(tag(inverted, true).hidden, tag(sleeve(), true).hidden);
  EXPECT_EQ(tag(sleeve(), false).err, "");
  const Tagged unseen = tag(inverted, false);
  EXPECT_EQ(unseen.hidden.size(), 0u);
  EXPECT_EQ(
      unseen.err,
      "ensemble: warning: odd.glb: its clothes hide no face of the body, but would if the backs of their "
      "faces were drawn; turn the faces to the outside, or make the materials double-sided\n");
}

TEST_F(OddGarments, ThatCutThemselvesHideWhatEitherPartHides) {
  RawPrimitive twice = sleeve(0.205f, 0.3f, 1.05f);
  const RawPrimitive upper = sleeve(0.215f, 0.75f, 1.5f);
  const Tagged lower_alone = tag(twice), upper_alone = tag(upper);
  const auto base = static_cast<std::uint32_t>(twice.vertices.size());
  for (RawVertex vertex : upper.vertices) {
    // Wavy, so that it runs through the lower one again and again.
    if (vertex.position.y < 1.05f && vertex.position.x > 0.0f) vertex.position *= Vec3(0.94f, 1.0f, 0.94f);
    twice.vertices.push_back(vertex);
  }
  for (const Triangle& face : upper.faces)
    twice.faces.push_back({face[0] + base, face[1] + base, face[2] + base});
  const Tagged both = tag(twice);
  EXPECT_EQ(both.err, "");
  EXPECT_GE(both.hidden.size(), std::max(lower_alone.hidden.size(), upper_alone.hidden.size()));
  EXPECT_TRUE(std::includes(both.hidden.begin(), both.hidden.end(), lower_alone.hidden.begin(),
                            lower_alone.hidden.end()));
}

TEST_F(OddGarments, ThatHideAllOfTheBodyAreTold) {
  RawPrimitive sack = testing::tubeBand(3, 0.21f, -0.9f, 2.7f, 24);
  for (const std::uint32_t ring : {0u, 24u}) {
    const auto center = static_cast<std::uint32_t>(sack.vertices.size());
    sack.vertices.push_back(sack.vertices[ring * kTubeSegments]);
    sack.vertices.back().position.x = sack.vertices.back().position.z = 0.0f;
    for (std::uint32_t s = 0; s < kTubeSegments; ++s) {
      sack.faces.push_back(
          {center, ring * kTubeSegments + s, ring * kTubeSegments + (s + 1) % kTubeSegments});
    }
  }
  const Tagged tagged = tag(sack);
  EXPECT_EQ(tagged.hidden.size(), std::size_t{kBodyFaces});
  EXPECT_EQ(tagged.err,
            "ensemble: warning: odd.glb: nothing of the body shows under it; if that is not meant, look at "
            "--explain\n");
}

TEST_F(OddGarments, FarFromTheBodyAreTold) {
  RawPrimitive far = sleeve();
  for (RawVertex& vertex : far.vertices) vertex.position.x += 3.0f;
  const Tagged tagged = tag(far);
  EXPECT_EQ(tagged.hidden.size(), 0u);
  EXPECT_EQ(
      tagged.err,
      "ensemble: warning: odd.glb: its clothes hide no face of the body\n"
      "ensemble: warning: odd.glb: garment 'garment.tunic' lies 2.59 m from the body; is it in other units, "
      "or elsewhere?\n");
}

TEST_F(OddGarments, WithoutFacesHideNothing) {
  RawPrimitive lost = sleeve();
  lost.faces.clear();
  const Tagged tagged = tag(lost);
  EXPECT_EQ(tagged.hidden.size(), 0u);
  EXPECT_EQ(tagged.err, "ensemble: warning: odd.glb: its clothes hide no face of the body\n");
}

}  // namespace
}  // namespace ensemble
