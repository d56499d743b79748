// `ensemble render --annotations` as a user runs it, against the AOVs that it writes beside them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"
#include "tests/renderer/read_exr.h"

namespace ensemble {
namespace {

namespace fs = std::filesystem;
using testing::ProgramResult;

class Annotations : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
    testing::writeTwelvePeople(folder_ / "scene.yaml", 3);
  }
  ProgramResult run(const std::string& arguments) { return testing::runProgram(arguments, folder_.path()); }
  std::string text(const std::string& file) { return testing::bytesOf(folder_ / file); }
  nlohmann::json json(const std::string& file) { return nlohmann::json::parse(text(file)); }

  testing::TemporaryFolder folder_;
};

TEST_F(Annotations, AgreeWithTheCharacterAov) {
  const ProgramResult result = run("render scene.yaml -o set/ --aov character --annotations set/all.json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(fs::exists(folder_ / "set/all.json.part"));
  const nlohmann::json document = json("set/all.json");
  EXPECT_EQ(document["schema"], "ensemble.annotations/1");
  EXPECT_EQ(document["width"], 96);
  EXPECT_EQ(document["height"], 64);
  EXPECT_EQ(document["fps"], 10.0);
  const nlohmann::json& wardrobe = document["wardrobes"][0];
  ASSERT_EQ(wardrobe["joints"].size(), wardrobe["parents"].size());
  EXPECT_EQ(wardrobe["parents"][0], -1);
  ASSERT_EQ(document["frames"].size(), 3u);
  const nlohmann::json ids = json("set/frame_0000.ids.json");
  for (int f = 0; f < 3; ++f) {
    const nlohmann::json& frame = document["frames"][f];
    const std::string name = "set/frame_000" + std::to_string(f);
    EXPECT_EQ(frame["frame"], f);
    EXPECT_EQ(frame["file"], name + ".png");
    EXPECT_NEAR(frame["seconds"], 0.1 * f, 1e-9);
    const testing_support::ExrPicture aov = testing_support::readExr(folder_ / (name + ".character.exr"));
    const std::vector<std::uint32_t> character = aov.uint_channels.at("id");
    std::vector<std::uint32_t> seen = character;
    std::sort(seen.begin(), seen.end());
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    EXPECT_EQ(frame["people"].size(), seen.size() - 1) << "all who show, and no one else; 0 is nobody";
    for (const nlohmann::json& person : frame["people"]) {
      const std::uint32_t id = person["id"];
      EXPECT_EQ(person["number"], id - 1);
      EXPECT_EQ(person["outfit"], ids["characters"][id - 1]["outfit"]);
      EXPECT_EQ(person["clip"], ids["characters"][id - 1]["clip"]);
      int left = 96, right = -1, top = 64, bottom = -1, pixels = 0;
      for (int i = 0; i < 96 * 64; ++i) {
        if (character[static_cast<std::size_t>(i)] != id) continue;
        left = std::min(left, i % 96);
        right = std::max(right, i % 96);
        top = std::min(top, i / 96);
        bottom = std::max(bottom, i / 96);
        ++pixels;
      }
      EXPECT_EQ(person["bbox"], nlohmann::json({left, top, right - left + 1, bottom - top + 1}));
      EXPECT_EQ(person["pixels"], pixels);
      EXPECT_NEAR(person["visible"], double{static_cast<double>(pixels)} / person["pixels_alone"].get<int>(),
                  1e-4);
      EXPECT_EQ(person["joints_3d"].size(), wardrobe["joints"].size());
      EXPECT_EQ(person["joints_2d"].size(), wardrobe["joints"].size());
    }
  }
}

TEST_F(Annotations, JointsFallWhereTheMatricesPutThem) {
  ASSERT_EQ(run("render scene.yaml -o one.png --frames 0 --annotations one.json").exit_code, 0);
  const nlohmann::json document = json("one.json");
  const nlohmann::json& camera = document["frames"][0]["camera"];
  for (const nlohmann::json& person : document["frames"][0]["people"]) {
    for (std::size_t j = 0; j < person["joints_3d"].size(); ++j) {
      const nlohmann::json& joint = person["joints_3d"][j];
      double eye[3] = {}, clip[4] = {};
      for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t k = 0; k < 4; ++k) {
          const double value = k < 3 ? joint[k].get<double>() : 1.0;
          if (row < 3) eye[row] += camera["camera_from_world"][row][k].get<double>() * value;
          clip[row] += camera["clip_from_world"][row][k].get<double>() * value;
        }
      }
      const nlohmann::json& k = camera["intrinsics"];
      const nlohmann::json& at = person["joints_2d"][j];
      EXPECT_NEAR(at[0], k[0][0].get<double>() * eye[0] / eye[2] + k[0][2].get<double>(), 0.05);
      EXPECT_NEAR(at[1], k[1][1].get<double>() * eye[1] / eye[2] + k[1][2].get<double>(), 0.05);
      EXPECT_NEAR(at[0], (0.5 + 0.5 * clip[0] / clip[3]) * 96, 0.05);
      EXPECT_NEAR(at[1], (0.5 + 0.5 * clip[1] / clip[3]) * 64, 0.05);
    }
  }
}

TEST_F(Annotations, AreGoneOnWithAfterAnInterruption) {
  const std::string command = "render scene.yaml -o set/ --annotations all.json --json figures.json ";
  ASSERT_EQ(run(command).exit_code, 0);
  const std::string whole = text("all.json");
  // As a kill leaves it: two frames in FILE.part, the third cut off.
  const std::size_t third = whole.find("{\"frame\":2");
  ASSERT_NE(third, std::string::npos);
  fs::remove(folder_ / "all.json");
  std::ofstream(folder_ / "all.json.part") << whole.substr(0, third + 200);
  ASSERT_EQ(run(command + "--resume").exit_code, 0);
  EXPECT_EQ(text("all.json"), whole);
  EXPECT_FALSE(fs::exists(folder_ / "all.json.part"));
  EXPECT_EQ(json("figures.json")["skipped"], nlohmann::json({0, 1}));

  // A finished run again: nothing is drawn, the same document stays. One frame more: only that is drawn.
  ASSERT_EQ(run(command + "--resume").exit_code, 0);
  EXPECT_EQ(text("all.json"), whole);
  EXPECT_EQ(json("figures.json")["frames"].size(), 0u);
  ASSERT_EQ(run(command + "--resume --frames 0-3").exit_code, 0);
  EXPECT_EQ(json("figures.json")["frames"].size(), 1u);
  EXPECT_EQ(json("all.json")["frames"].size(), 4u);

  // Other people: nothing of the old ones stays.
  ASSERT_EQ(run(command + "--resume --set crowd.seed=4").exit_code, 0);
  EXPECT_EQ(json("figures.json")["frames"].size(), 3u);
  EXPECT_NE(json("all.json")["crowd_sha256"], nlohmann::json::parse(whole)["crowd_sha256"]);
}

TEST_F(Annotations, ThatCantBeWrittenAreAnError) {
  fs::create_directory(folder_ / "all.json");
  const ProgramResult result = run("render scene.yaml -o set/ --annotations all.json");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err,
            "ensemble: all.json: is not a regular file, and can't be replaced by one; choose another name\n");
  const ProgramResult nowhere = run("render scene.yaml -o set/ --annotations scene.yaml/all.json");
  EXPECT_EQ(nowhere.exit_code, 1);
  EXPECT_EQ(nowhere.err,
            "ensemble: scene.yaml/all.json: can't be written: Not a directory; choose another place\n");
  EXPECT_FALSE(fs::exists(folder_ / "set/frame_0000.png")) << "it is said before anything is drawn";
}

}  // namespace
}  // namespace ensemble
