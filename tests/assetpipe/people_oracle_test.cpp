// The tagging of real people against the oracle that came with them (../shared/people).
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "assetpipe/pipeline.h"
#include "assetpipe/report.h"
#include "core/gltf_file.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

namespace fs = std::filesystem;

const fs::path kPeople = "../shared/people";  // tests run in the project's folder

class PeopleOracle : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!fs::exists(kPeople / "expected.json")) {
      GTEST_SKIP() << "LOUD: ../shared/people is absent, so the tagging of real people was not checked";
    }
    std::ifstream(kPeople / "expected.json") >> expected_;
  }

  std::vector<fs::path> outfitFiles() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(kPeople / GetParam() / "outfits"))
      files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
  }

  nlohmann::json expected_;
  testing::TemporaryFolder folder_;
};

TEST_P(PeopleOracle, ClassesCountsAndTotalsAreExact) {
  const nlohmann::json& sex = expected_[GetParam()];
  tagWardrobe(kPeople / GetParam() / "template.glb", outfitFiles(), folder_.path(), {});
  const Wardrobe wardrobe = loadWardrobe(folder_.path());
  EXPECT_EQ(wardrobe.body.faces.size(), sex["template"]["faces"]);
  EXPECT_EQ(wardrobe.items.size(), sex["outfits"].size());
  for (const Item& item : wardrobe.items) {
    const nlohmann::json& outfit = sex["outfits"][item.name];
    EXPECT_EQ(item.garmentFaceCount(), outfit["garment_faces"]) << item.name;
    EXPECT_EQ(item.visibleBodyFaceCount(), outfit["visible_body_faces"]) << item.name;
    EXPECT_EQ(item.dedicatedFaceCount(), outfit["dedicated_faces"]) << item.name;
    for (std::size_t r = 0; r < wardrobe.body.regions.size(); ++r) {
      const nlohmann::json& region = outfit["regions"][wardrobe.body.regions[RegionId(r)].name];
      EXPECT_EQ(toString(item.tags[RegionId(r)].visibility), region["class"]) << item.name;
      EXPECT_EQ(item.tags[RegionId(r)].visible_faces, region["embedded"]) << item.name;
    }
  }

  const Report report = makeReport(wardrobe);
  EXPECT_EQ(report.faces[Technique::kNaive], sex["totals"]["naive"]);
  EXPECT_EQ(report.faces[Technique::kPrefitted], sex["totals"]["prefitted"]);
  EXPECT_EQ(report.faces[Technique::kTagged], sex["totals"]["tagged"]);
  EXPECT_LE(static_cast<double>(report.bytes[2]), 1.015 * static_cast<double>(report.lower_bound_bytes));
  EXPECT_LT(report.bytes[2], report.bytes[1]);
}

TEST_P(PeopleOracle, GroundSpeedIsTheAuthors) {
  tagWardrobe(kPeople / GetParam() / "template.glb", {}, folder_.path(), {});
  const Wardrobe wardrobe = loadWardrobe(folder_.path());
  for (const Clip& clip : wardrobe.body.clips) {
    const float authored = clip.name != "walk" ? 0.0f : GetParam() == "female" ? 1.073f : 1.141f;
    EXPECT_NEAR(clip.ground_speed, authored, 0.01f) << clip.name;
  }
}

// The unfitted outfits hold complete bodies: what their makers removed elsewhere is to be found by rays.
TEST_P(PeopleOracle, FindsWhatTheMakersRemoved) {
  std::vector<fs::path> unfitted;
  for (const fs::path& file : outfitFiles())
    unfitted.push_back(kPeople / GetParam() / "unfitted" / file.filename());
  PipelineOptions options;
  options.tag.occlusion = Occlusion::kAuto;
  tagWardrobe(kPeople / GetParam() / "template.glb", unfitted, folder_ / "found", options);
  tagWardrobe(kPeople / GetParam() / "template.glb", outfitFiles(), folder_ / "authored", {});
  const Wardrobe found = loadWardrobe(folder_ / "found"), authored = loadWardrobe(folder_ / "authored");
  std::size_t by_hand = 0, by_rays = 0, both = 0;
  for (std::size_t i = 0; i < found.items.size(); ++i) {
    const Item &here = found.items[ItemId(i)], &there = authored.items[ItemId(i)];
    ASSERT_EQ(here.name, there.name);
    for (std::size_t f = 0; f < found.body.faces.size(); ++f) {
      const bool hand = there.visible[FaceId(f)] == 0, rays = here.visible[FaceId(f)] == 0;
      by_hand += hand;
      by_rays += rays;
      both += hand && rays;
    }
  }
  const double share = static_cast<double>(both) / static_cast<double>(by_hand);
  RecordProperty("found_of_removed", std::to_string(share));
  std::printf("%s: %zu faces removed by hand, %.1f %% of them found; %zu found in all\n", GetParam().c_str(),
              by_hand, 100.0 * share, by_rays);
  EXPECT_GT(share, 0.96);
  EXPECT_GE(by_rays, by_hand);
}

INSTANTIATE_TEST_SUITE_P(BothSexes, PeopleOracle, ::testing::Values("female", "male"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace ensemble
