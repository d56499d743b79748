// naive, pre-fitted and tagged draw the same people (issue: "What it must show").
#include "tests/renderer/gpu_fixture.h"

namespace ensemble {
namespace {

using testing::GpuTest;

/// Cameras that see people near, from above, and cut by the picture's border.
std::vector<SceneCamera> cameras() {
  return {{.position = Vec3(0.4f, 1.8f, 5.0f), .target = Vec3(0.0f, 0.9f, 0.0f)},
          {.position = Vec3(-1.0f, 6.0f, 3.0f), .target = Vec3(0.0f, 0.5f, 0.0f)},
          {.position = Vec3(1.2f, 1.0f, 1.6f), .target = Vec3(0.0f, 1.0f, 0.0f)}};
}

class Techniques : public GpuTest, public ::testing::WithParamInterface<std::uint32_t> {
 protected:
  struct Drawn {
    std::unique_ptr<Renderer> renderer;
    std::vector<Picture> pictures;
  };
  Drawn drawAll(Technique technique) {
    Scene scene = testing::tubeScene(12);
    scene.technique = technique;
    for (const char* outfit : outfits_) scene.crowd.outfits.push_back({outfit, 1.0f, {}});
    Drawn drawn{makeRenderer(scene), {}};
    for (const SceneCamera& camera : cameras()) {
      for (const double seconds : {0.0, 0.43}) {
        View view = viewOf(scene);
        view.camera = camera;
        view.samples = GetParam();
        view.aovs = testing::allAovs();
        drawn.pictures.push_back(draw(*drawn.renderer, view, seconds));
      }
    }
    return drawn;
  }
  std::vector<const char*> outfits_;  ///< worn; empty: all
};

TEST_P(Techniques, TaggedIsPrefittedByteForByte) {
  const Drawn tagged = drawAll(Technique::kTagged), prefitted = drawAll(Technique::kPrefitted);
  for (std::size_t i = 0; i < tagged.pictures.size(); ++i) {
    const Picture &a = tagged.pictures[i], &b = prefitted.pictures[i];
    EXPECT_GT(testing::countPeoplePixels(a), a.character.size() / 10) << i;
    EXPECT_EQ(a.color.rgba, b.color.rgba) << i;
    EXPECT_EQ(a.character, b.character) << i;
    EXPECT_EQ(a.region, b.region) << i;
    EXPECT_EQ(a.face, b.face) << i;
    EXPECT_EQ(a.depth, b.depth) << i;
    EXPECT_EQ(a.normal, b.normal) << i;
    EXPECT_EQ(a.stats.triangles(), b.stats.triangles()) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, Techniques, ::testing::Values(1u, 4u));

class NaiveTechnique : public Techniques {};
INSTANTIATE_TEST_SUITE_P(Samples, NaiveTechnique, ::testing::Values(1u));

// Shadows are on: hidden faces must not cast any, or other pixels would differ.
TEST_P(NaiveTechnique, DiffersOnlyWhereItShowsAHiddenFace) {
  outfits_ = {"tunic", "net"};  // Body faces that the template lacks have face numbers of their own.
  const Drawn tagged = drawAll(Technique::kTagged), naive = drawAll(Technique::kNaive);
  std::size_t hidden_pixels = 0, differing = 0;
  for (std::size_t i = 0; i < tagged.pictures.size(); ++i) {
    const Picture& picture = naive.pictures[i];
    for (const std::size_t pixel : testing::differingPixels(tagged.pictures[i].color, picture.color)) {
      EXPECT_TRUE(testing::showsHiddenFace(picture, pixel, *naive.renderer, wardrobes_))
          << i << ", pixel " << pixel;
      ++differing;
    }
    for (std::size_t pixel = 0; pixel < picture.face.size(); ++pixel) {
      hidden_pixels += testing::showsHiddenFace(picture, pixel, *naive.renderer, wardrobes_);
      EXPECT_FALSE(testing::showsHiddenFace(tagged.pictures[i], pixel, *tagged.renderer, wardrobes_));
    }
  }
  EXPECT_GT(differing, 100u) << "the outfits are made so that naive shows hidden faces";
  EXPECT_GE(hidden_pixels, differing);
}

TEST_F(GpuTest, HiddenFacesCostNaiveVerticesAndTriangles) {
  Scene scene = testing::tubeScene(12);
  std::map<Technique, FrameStats> stats;
  for (const Technique technique : kAllTechniques) {
    scene.technique = technique;
    stats[technique] = drawScene(scene, viewOf(scene)).stats;
  }
  const FrameStats &naive = stats[Technique::kNaive], &tagged = stats[Technique::kTagged],
                   &prefitted = stats[Technique::kPrefitted];
  EXPECT_LT(tagged.triangles(), naive.triangles());
  EXPECT_EQ(tagged.triangles(), prefitted.triangles());
  ASSERT_TRUE(tagged.vertexInvocations().has_value()) << "lavapipe counts them";
  EXPECT_LT(*tagged.vertexInvocations(), *naive.vertexInvocations());
  EXPECT_LE(static_cast<double>(*tagged.vertexInvocations()),
            1.02 * static_cast<double>(*prefitted.vertexInvocations()));
  EXPECT_GT(*tagged.main.vertex_invocations, 0u);
  EXPECT_GT(*tagged.shadow.vertex_invocations, 0u);
}

// What a frame draws follows from lists and crowd alone.
TEST_F(GpuTest, CountsAreThoseOfTheLists) {
  Scene scene = testing::tubeScene(12);
  scene.light.shadows = false;
  const auto renderer = makeRenderer(scene);
  const FrameStats stats = draw(*renderer, viewOf(scene)).stats;
  const Crowd& crowd = renderer->crowd();
  std::vector<Combination> combinations;
  for (const WornCombination& worn : crowd.combinations) combinations.push_back(worn.items);
  const SubMeshLists lists = buildSubMeshLists(wardrobes_[0], combinations, Technique::kTagged);
  std::uint64_t triangles = 0;
  std::set<std::uint32_t> drawn;
  for (const Character& person : crowd.characters) {
    for (const SubMeshId id : lists.shown[person.combination]) {
      triangles += lists.index_lists[lists.sub_meshes[id].list].indices.size() / 3;
      drawn.insert(id.value);
    }
  }
  EXPECT_EQ(stats.characters_drawn, 12u);
  EXPECT_EQ(stats.main.triangles, triangles);
  EXPECT_EQ(stats.main.draw_calls, drawn.size());
  EXPECT_EQ(stats.gpu_mesh_bytes, lists.meshBytes());
  EXPECT_EQ(stats.shadow.triangles, 0u);
  EXPECT_EQ(stats.shadow.draw_calls, 0u);
  EXPECT_EQ(stats.shadow.vertex_invocations, 0u);
}

}  // namespace
}  // namespace ensemble
