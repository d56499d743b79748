// The people of `ensemble people` in our recipes, auto-tagged, from all sides and in motion: where naive
// shows a body face that tagging removed, something else must lie close under it.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <set>

#include "assetpipe/make_people.h"
#include "assetpipe/pipeline.h"
#include "core/clip.h"
#include "renderer/renderer.h"
#include "tests/assetpipe/person_config.h"
#include "tests/pictures/all_sides.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kSize = 256;

/// Counts of pixels over many pictures.
struct Holes {
  std::size_t people = 0;  ///< that naive shows somebody in
  std::size_t deep = 0;    ///< nothing, or something deeper than cloth may lie under the skin
  std::size_t inside = 0;  ///< the inside of a garment, less deep
  void add(const Holes& other) { people += other.people, deep += other.deep, inside += other.inside; }
  double share(std::size_t pixels) const {
    return 100.0 * static_cast<double>(pixels) / static_cast<double>(people);
  }
};

class OwnPeoplePictures : public ::testing::TestWithParam<Sex> {
 protected:
  void SetUp() override {
    PersonConfig config = testing::configOf(GetParam());
    if (!testing::isFull()) {
      config.outfits = GetParam() == Sex::kFemale ? std::vector<std::string>{"summer_dress", "shirt"}
                                                  : std::vector<std::string>{"jeans", "suit"};
    }
    const MadePerson person = makePerson(config);
    std::vector<fs::path> files = writePerson(person, folder_.path());
    PipelineOptions options;
    options.tag.occlusion = Occlusion::kAuto;
    tagWardrobe(files.front(), std::vector<fs::path>(files.begin() + 1, files.end()), folder_ / "w", options);
    wardrobe_.push_back(loadWardrobe(folder_ / "w"));
  }

  void load(const Item& item, const Clip& clip) {
    naive_.load(testing::sceneOfOne(item.name, clip.name, Technique::kNaive, kSize), wardrobe_);
    const Scene scene = testing::sceneOfOne(item.name, clip.name, Technique::kTagged, kSize);
    tagged_.load(scene, wardrobe_);
    views_ = testing::viewsFromAllSides(scene);
  }

  std::vector<Picture> draw(Renderer& renderer, double seconds) const {
    std::vector<Picture> pictures(views_.size());
    renderer.render(views_, seconds, pictures);
    return pictures;
  }

  /// Whether a face of a garment turns its back on the camera. @param number of the garment, from 0
  bool isBack(const Item& item, std::size_t number, std::size_t face, const std::vector<Mat4>& pose,
              const Vec3& camera) const {
    for (const ItemPart& part : item.garments[number].parts) {
      if (face >= part.faces.size()) {
        face -= part.faces.size();
        continue;
      }
      std::array<Vec3, 3> p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = skinPosition(part.vertices[part.faces[face][k]], pose);
      return glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), camera - p[0]) < 0.0f;
    }
    ADD_FAILURE() << "no face of that number";
    return false;
  }

  void countPixel(const Item& item, const Picture& naive, const Picture& tagged, std::size_t pixel,
                  const std::vector<Mat4>& pose, const Vec3& camera, Holes& holes) const {
    const TemplateBody& body = wardrobe_[0].body;
    if (naive.character[pixel] == 0) return;
    ++holes.people;
    if (naive.region[pixel] > body.regions.size() || item.visible[FaceId(naive.face[pixel] - 1)] != 0) return;
    const bool is_deep = tagged.character[pixel] == 0 ||
                         tagged.depth[pixel] - naive.depth[pixel] > HiddenFaceOptions().tolerance;
    holes.deep += is_deep ? 1 : 0;
    if (is_deep || tagged.region[pixel] <= body.regions.size()) return;
    const std::size_t garment = tagged.region[pixel] - body.regions.size() - 1;
    holes.inside += isBack(item, garment, tagged.face[pixel] - 1, pose, camera) ? 1 : 0;
  }

  /// @pre load() of both
  Holes look(const Item& item, const Clip& clip, double seconds) {
    const std::vector<Picture> naive = draw(naive_, seconds), tagged = draw(tagged_, seconds);
    const float key = static_cast<float>(seconds / double{clip.seconds} * (clip.key_count - 1));
    const std::vector<Mat4> pose = skinningMatricesAt(wardrobe_[0].body.skeleton, clip, key);
    Holes holes;
    for (std::size_t v = 0; v < naive.size(); ++v) {
      for (std::size_t p = 0; p < naive[v].character.size(); ++p)
        countPixel(item, naive[v], tagged[v], p, pose, views_[v].camera.position, holes);
    }
    return holes;
  }

  testing::TemporaryFolder folder_;
  std::vector<Wardrobe> wardrobe_;
  std::vector<View> views_;
  Renderer naive_, tagged_;
};

TEST_P(OwnPeoplePictures, HardlyMissWhatTheirClothesHide) {
  const std::set<std::string> sample = {"walk", "run"};
  Holes all;
  double worst = 0.0;
  for (const Item& item : wardrobe_[0].items.raw()) {
    Holes of_item;
    for (const Clip& clip : wardrobe_[0].body.clips) {
      if (!testing::isFull() && !sample.contains(clip.name)) continue;
      const int steps = testing::isFull() ? static_cast<int>(clip.key_count - 1) / 4 : 2;
      load(item, clip);
      for (int step = 0; step < steps; ++step)  // between key frames, too
        of_item.add(look(item, clip, double{clip.seconds} * (step + 0.3) / steps));
    }
    std::printf("%s %-14s of %zu pixels %zu are holes (%.4f %%), %zu the inside of cloth (%.4f %%)\n",
                GetParam() == Sex::kFemale ? "woman" : "man", item.name.c_str(), of_item.people, of_item.deep,
                of_item.share(of_item.deep), of_item.inside, of_item.share(of_item.inside));
    std::fflush(stdout);
    worst = std::max(worst, of_item.share(of_item.deep));
    all.add(of_item);
  }
  std::printf(
      "%s: of %zu pixels %zu are holes (%.4f %%, %.4f %% at worst), %zu the inside of cloth (%.4f %%)\n",
      GetParam() == Sex::kFemale ? "woman" : "man", all.people, all.deep, all.share(all.deep), worst,
      all.inside, all.share(all.inside));
  ASSERT_GT(all.people, 100000u);
  // Measured: the woman 0.120, the man 0.043; at full length the woman 0.100, and most in long skirts, hers
  // 0.370, his 0.307. Holes that are left are those that --hole allows.
  EXPECT_LT(all.share(all.deep), 0.15);
  EXPECT_LT(worst, 0.4);
  EXPECT_LT(all.share(all.inside), 0.01);
}

INSTANTIATE_TEST_SUITE_P(People, OwnPeoplePictures, ::testing::Values(Sex::kFemale, Sex::kMale),
                         [](const auto& sex) { return sex.param == Sex::kFemale ? "Woman" : "Man"; });

}  // namespace
}  // namespace ensemble
