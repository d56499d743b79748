// `ensemble render` of a sequence with several renderers: the files of one, whatever happens on the way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"

namespace ensemble {
namespace {

namespace fs = std::filesystem;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using testing::ProgramResult;

using Files = std::map<std::string, std::string>;

Files filesIn(const fs::path& folder) {
  Files files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[fs::relative(entry.path(), folder).string()] = testing::bytesOf(entry.path());
  }
  return files;
}

class Sequences : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
    testing::writeTwelvePeople(folder_ / "scene.yaml", 11);
  }
  /// Runs `ensemble render` in a folder of its own. @param arguments after the scene
  ProgramResult render(const std::string& name, const std::string& arguments) {
    fs::create_directories(folder_ / name);
    return testing::runProgram("render ../scene.yaml --json ../figures.json " + arguments, folder_ / name);
  }
  nlohmann::json figures() { return nlohmann::json::parse(std::ifstream(folder_ / "figures.json")); }

  testing::TemporaryFolder folder_;
};

TEST_F(Sequences, AreTheSameFilesWithAnyNumberOfRenderers) {
  const std::string all = " --aov character,region,face,depth,normal --annotations a.json --dump-crowd c.csv";
  const std::string kinds[] = {"-o p/ --set raster=pipeline" + all,
                               "-o e_%02d.exr --set raster=compute --frames 7-10,2-4" + all,
                               "-o v.mp4 --frames 0-10 --aov face",
                               "-o t_%d.png --frames 0-3 --set output.width=4200 --set output.height=30"};
  for (const std::string& arguments : kinds) {
    const std::string number = std::to_string(&arguments - kinds);
    ASSERT_EQ(render("one" + number, arguments + " --renderers 1").exit_code, 0);
    const nlohmann::json one = figures();
    EXPECT_EQ(one["renderers"], 1);
    const Files truth = filesIn(folder_ / ("one" + number));
    EXPECT_GE(truth.size(), number == "2" ? 23u : 4u);
    for (const std::string count : {"2", "3"}) {
      const ProgramResult result = render(count + "_" + number, arguments + " --renderers " + count);
      ASSERT_EQ(result.exit_code, 0) << result.err;
      EXPECT_EQ(result.err, "");
      EXPECT_TRUE(filesIn(folder_ / (count + "_" + number)) == truth) << arguments << ", " << count;
      const nlohmann::json several = figures();
      EXPECT_EQ(several["renderers"].dump(), count);
      ASSERT_EQ(several["frames"].size(), one["frames"].size());
      for (std::size_t i = 0; i < one["frames"].size(); ++i) {
        for (const char* key : {"index", "file", "characters_drawn", "characters_computed", "draw_calls",
                                "vertex_invocations", "triangles", "gpu_mesh_bytes"})
          EXPECT_EQ(several["frames"][i][key], one["frames"][i][key]) << key << " of " << i;
      }
    }
  }
}

TEST_F(Sequences, AreGoneOnWithWhateverIsMissing) {
  const std::string arguments = "-o p/ --aov depth --annotations a.json ";
  ASSERT_EQ(render("whole", arguments + "--renderers 1").exit_code, 0);
  ASSERT_EQ(render("cut", arguments + "--renderers 3").exit_code, 0);
  EXPECT_EQ(figures()["renderers"], 3);
  fs::remove(folder_ / "cut/p/frame_0000.png");
  fs::resize_file(folder_ / "cut/p/frame_0004.depth.exr", 300);
  fs::remove(folder_ / "cut/p/frame_0007.ids.json");
  fs::remove(folder_ / "cut/p/frame_0010.png");
  const ProgramResult result = render("cut", arguments + "--renderers 3 --resume");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(filesIn(folder_ / "cut") == filesIn(folder_ / "whole"));
  EXPECT_EQ(figures()["skipped"], nlohmann::json({1, 2, 3, 5, 6, 8, 9}));
  for (const std::size_t i : {0u, 1u, 2u, 3u})
    EXPECT_EQ(figures()["frames"][i]["index"], (std::vector{0, 4, 7, 10})[i]);
  ASSERT_EQ(render("cut", arguments + "--renderers 3 --resume").exit_code, 0);
  EXPECT_EQ(figures()["frames"].size(), 0u);
  EXPECT_EQ(figures()["renderers"], 1);
  EXPECT_TRUE(filesIn(folder_ / "cut") == filesIn(folder_ / "whole"));
}

TEST_F(Sequences, EndAtAnErrorWithAllFramesBeforeIt) {
  Files cut, whole;  // as one renderer leaves them
  for (const std::string count : {"1", "2", "3"}) {
    fs::create_directories(folder_ / count / "p/frame_0005.png");
    const ProgramResult result = render(count, "-o p/ --aov depth --annotations a.json --renderers " + count);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err,
              "ensemble: p/frame_0005.png: can't be written: Is a directory; choose another place\n");
    EXPECT_FALSE(fs::exists(folder_ / "figures.json"));
    const Files files = filesIn(folder_ / count);
    EXPECT_EQ(files.size(), 5u * 3 + 1) << "picture, depth and ids of each frame; annotations";
    EXPECT_TRUE(files.contains("p/frame_0004.ids.json"));
    if (count == "1") cut = files;
    EXPECT_TRUE(files == cut) << count;
    EXPECT_THAT(files.at("a.json.part"), HasSubstr("{\"frame\":4"));
    fs::remove(folder_ / count / "p/frame_0005.png");
    ASSERT_EQ(render(count, "-o p/ --aov depth --annotations a.json --resume --renderers " + count).exit_code,
              0);
    EXPECT_EQ(figures()["skipped"].size(), 5u);
    if (count == "1") whole = filesIn(folder_ / count);
    EXPECT_TRUE(filesIn(folder_ / count) == whole) << count;
    fs::remove(folder_ / "figures.json");
  }
}

TEST_F(Sequences, ASinglePictureHasOneRendererAndNumbersAreChecked) {
  ASSERT_EQ(render("one", "-o one.png --frames 3 --renderers 4").exit_code, 0);
  EXPECT_EQ(figures()["renderers"], 1);
  for (const char* count : {"0", "65", "two"}) {
    const ProgramResult result = render("bad", std::string("-o p/ --renderers ") + count);
    EXPECT_EQ(result.exit_code, 2) << count;
    EXPECT_THAT(result.err, HasSubstr("--renderers"));
    EXPECT_THAT(result.err, EndsWith("see `ensemble --help`\n"));
  }
}

TEST_F(Sequences, AreValidatedWholly) {
  const ProgramResult result = render("v", "-o p/ --frames 0-4 --renderers 2 --aov face --validate");
  if (result.err.find("the validation layer is not installed") != std::string::npos)
    GTEST_SKIP() << result.err;
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(figures()["renderers"], 2);
}

}  // namespace
}  // namespace ensemble
