// The three techniques' pictures of real people (../shared/people), pixel by pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include "assetpipe/pipeline.h"
#include "renderer/renderer.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

namespace fs = std::filesystem;

const fs::path kPeople = "../shared/people";  // tests run in the project's folder

struct Shot {
  const char* camera;
  double seconds;
};
/// Far, near, from above and from the ground; people stand in random headings in walk and idle.
constexpr Shot kShots[] = {{"{position: [0, 1.7, 9], target: [0, 0.9, 0], fov_y: 45}", 0.0},
                           {"{position: [2.4, 1.1, 2.4], target: [0, 0.9, 0], fov_y: 40}", 0.37},
                           {"{position: [0, 7, 0.5], target: [0, 0, 0], fov_y: 50}", 1.0},
                           {"{position: [-3, 0.15, 1], target: [0, 0.4, 0], fov_y: 60}", 2.81}};

class PeoplePictures : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!fs::exists(kPeople)) {
      GTEST_SKIP() << "LOUD: ../shared/people is absent, so the pictures of real people were not compared";
    }
    std::vector<fs::path> outfits;
    for (const auto& entry : fs::directory_iterator(kPeople / GetParam() / "outfits"))
      outfits.push_back(entry.path());
    std::sort(outfits.begin(), outfits.end());
    tagWardrobe(kPeople / GetParam() / "template.glb", outfits, folder_ / "wardrobe", {});
    wardrobes_.push_back(loadWardrobe(folder_ / "wardrobe"));
  }

  Scene scene(Technique technique, const char* camera, std::uint32_t samples) const {
    const std::string text = std::string("version: 1\nwardrobe: wardrobe\ntechnique: ") +
                             toString(technique) +
                             "\noutput: {width: 480, height: 360, samples: " + std::to_string(samples) +
                             "}\ncrowd: {count: 28, seed: 5, placement: {kind: disc, spacing: 0.8}, "
                             "clips: {walk: 0.8, idle: 0.2}}\ncamera: " +
                             camera + "\n";
    return parseScene(text, folder_ / "scene.yaml");
  }

  Picture render(Technique technique, const Shot& shot, std::uint32_t samples) {
    const Scene made = scene(technique, shot.camera, samples);
    renderer_.load(made, wardrobes_);
    View view = viewOf(made);
    if (samples == 1) view.aovs = {Aov::kCharacter, Aov::kRegion, Aov::kFace, Aov::kDepth, Aov::kNormal};
    Picture picture;
    renderer_.render(std::span(&view, 1), shot.seconds, std::span(&picture, 1));
    return picture;
  }

  /// Whether what a pixel shows is a body face that the author of the person's outfit removed.
  bool showsRemovedFace(const Picture& naive, std::size_t pixel) const {
    if (naive.character[pixel] == 0) return false;
    const Crowd& crowd = renderer_.crowd();
    const Character& person = crowd.characters[naive.character[pixel] - 1];
    const TemplateBody& body = wardrobes_[0].body;
    if (naive.region[pixel] == 0 || naive.region[pixel] > body.regions.size()) return false;
    if (naive.face[pixel] > body.faces.size()) return false;  // geometry of the outfit
    const FaceId face(naive.face[pixel] - 1);
    EXPECT_EQ(body.region_of_face[face], RegionId(naive.region[pixel] - 1));
    const Combination& items = crowd.combinations[person.combination].items;
    return std::any_of(items.begin(), items.end(),
                       [&](ItemId item) { return wardrobes_[0].items[item].visible[face] == 0; });
  }

  testing::TemporaryFolder folder_;
  std::vector<Wardrobe> wardrobes_;
  Renderer renderer_;
};

bool samePixel(const Picture& a, const Picture& b, std::size_t pixel) {
  return std::memcmp(&a.color.rgba[4 * pixel], &b.color.rgba[4 * pixel], 4) == 0 &&
         a.character[pixel] == b.character[pixel] && a.region[pixel] == b.region[pixel] &&
         a.face[pixel] == b.face[pixel] && a.depth[pixel] == b.depth[pixel] &&
         std::equal(&a.normal[3 * pixel], &a.normal[3 * pixel] + 3, &b.normal[3 * pixel]);
}

TEST_P(PeoplePictures, TaggedEqualsPrefittedByteForByte) {
  for (const Shot& shot : kShots) {
    for (const std::uint32_t samples : {1u, 4u}) {
      const Picture prefitted = render(Technique::kPrefitted, shot, samples);
      const Picture tagged = render(Technique::kTagged, shot, samples);
      EXPECT_EQ(tagged.color.rgba, prefitted.color.rgba) << shot.camera << ", " << samples << " samples";
      EXPECT_EQ(tagged.character, prefitted.character);
      EXPECT_EQ(tagged.region, prefitted.region);
      EXPECT_EQ(tagged.face, prefitted.face);
      EXPECT_EQ(tagged.depth, prefitted.depth);
      EXPECT_EQ(tagged.normal, prefitted.normal);
      EXPECT_GE(tagged.stats.characters_drawn, 5u) << "hardly anybody is in the picture";
    }
  }
}

TEST_P(PeoplePictures, NaiveDiffersOnlyWhereItShowsRemovedFaces) {
  std::size_t removed_pixels = 0;
  for (const Shot& shot : kShots) {
    const Picture naive = render(Technique::kNaive, shot, 1);
    const std::size_t pixels = naive.face.size();
    std::vector<bool> removed(pixels);
    for (std::size_t p = 0; p < pixels; ++p) removed[p] = showsRemovedFace(naive, p);
    const Picture tagged = render(Technique::kTagged, shot, 1);
    for (std::size_t p = 0; p < pixels; ++p) {
      ASSERT_EQ(samePixel(naive, tagged, p), !removed[p])
          << "pixel " << p % naive.color.width << ", " << p / naive.color.width << " of " << shot.camera;
      removed_pixels += removed[p] ? 1 : 0;
    }
  }
  EXPECT_GT(removed_pixels, 0u) << "no removed face shows anywhere, so the comparison proved nothing";
}

TEST_P(PeoplePictures, TaggedDoesThePrefittedsWorkAndLessThanNaives) {
  std::array<FrameStats, 3> stats;
  for (const Technique technique : kAllTechniques) {
    stats[static_cast<std::size_t>(technique)] = render(technique, kShots[0], 1).stats;
  }
  if (!stats[0].vertexInvocations()) GTEST_SKIP() << "LOUD: the device counts no vertex invocations";
  EXPECT_LE(static_cast<double>(*stats[2].vertexInvocations()),
            1.02 * static_cast<double>(*stats[1].vertexInvocations()));
  EXPECT_LT(*stats[2].vertexInvocations(), *stats[0].vertexInvocations());
  EXPECT_EQ(stats[2].triangles(), stats[1].triangles());
  EXPECT_LT(stats[2].gpu_mesh_bytes, stats[1].gpu_mesh_bytes);
}

INSTANTIATE_TEST_SUITE_P(BothSexes, PeoplePictures, ::testing::Values("female", "male"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace ensemble
