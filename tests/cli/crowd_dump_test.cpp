// `ensemble render --dump-crowd`, and tables read back, as a user runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <map>

#include "tests/cli/run_program.h"

namespace ensemble {
namespace {

namespace fs = std::filesystem;
using testing::ProgramResult;

class CrowdDump : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string wardrobe = fs::absolute("tests/formats/wardrobe-1").string();
    head_ = "version: 1\nwardrobe: {a: " + wardrobe + ", b: " + wardrobe +
            "}\noutput: {width: 160, height: 90, samples: 4, frames: 8, fps: 7}\n"
            "camera: {position: [0, 1.6, 6], target: [0, 0.9, 0]}\n";
    write("scene.yaml", head_ + R"(crowd:
  count: 30
  seed: 3
  scale: [0.8, 1.2]
  placement: {kind: disc, spacing: 0.8, center: [0.1, 0, -1.3], heading: 20, heading_spread: 100}
people:
  - {wardrobe: b, outfit: tunic, phase: 0.2, speed: 0.6, position: [1.23, 0.1, 2], heading: -77.7, scale: 1.1, tint: 9}
  - {wardrobe: a, position: [-1.1, 0, 2]}
)");
    write("back.yaml", head_ + "crowd: {placement: {kind: file, file: one/crowd.csv}}\n");
  }
  void write(const std::string& file, const std::string& text) { std::ofstream(folder_ / file) << text; }
  ProgramResult run(const std::string& arguments) { return testing::runProgram(arguments, folder_.path()); }
  std::map<std::string, std::string> filesIn(const std::string& name) const {
    std::map<std::string, std::string> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / name)) {
      files[entry.path().filename().string()] = testing::bytesOf(entry.path());
    }
    return files;
  }

  testing::TemporaryFolder folder_;
  std::string head_;
};

TEST_F(CrowdDump, ReadBackGivesTheSamePicturesAndAovsByteForByte) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  const std::string options = " --frames 0,5 --aov character,region,face,depth,normal --dump-crowd ";
  ProgramResult result = run("render scene.yaml -o one/" + options + "one/crowd.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  result = run("render back.yaml -o two/" + options + "two/crowd.csv");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::map<std::string, std::string> one = filesIn("one"), two = filesIn("two");
  ASSERT_EQ(one.size(), 15u) << "two frames of a picture, five AOVs and IDs; the table";
  for (const auto& [name, bytes] : one) EXPECT_TRUE(two.contains(name) && bytes == two.at(name)) << name;
  EXPECT_NE(one.at("frame_0000.png"), one.at("frame_0005.png"));
  const std::string& table = one.at("crowd.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 33);
  EXPECT_THAT(table,
              ::testing::StartsWith("number,wardrobe,outfit,clip,phase,speed,x,y,z,heading,scale,tint\n"
                                    "0,b,tunic,sway,0.2,0.6,1.23,0.1,2,-77.69999,1.1,9\n"
                                    "1,a,,sway,0,1,-1.1,0,2,0,1,"));

  result = run("render scene.yaml -o one.png --frames 3 --dump-crowd -");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, table) << "the table is of time 0, whatever is drawn";
}

TEST_F(CrowdDump, MistakesAreToldBeforeAnythingIsDrawn) {
  const std::string render = "render scene.yaml -o a.png --frames 0 --dump-crowd ";
  ProgramResult result = run(render + "crowd.txt");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "ensemble: --dump-crowd crowd.txt: a crowd table's name ends in .csv: a scene knows it by that; "
            "write --dump-crowd crowd.csv\n");
  result = run(render + "- --json -");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(
      result.err,
      "ensemble: --dump-crowd -: --json writes to standard output, too; give one of them a file's name\n");
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  result = run(render + "nowhere/crowd.csv");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err,
            "ensemble: nowhere/crowd.csv: can't be written: No such file or directory; make its "
            "folder first\n");
  EXPECT_FALSE(fs::exists(folder_ / "a.png"));
}

}  // namespace
}  // namespace ensemble
