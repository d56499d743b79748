// `ensemble render` and `ensemble bench` as a user runs them, on the kept wardrobe of version 1.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"
#include "tests/core/glb_builder.h"

namespace ensemble {
namespace {

namespace fs = std::filesystem;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using testing::ProgramResult;
using ::testing::StartsWith;

class RenderCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream scene(folder_ / "scene.yaml");
    scene << "version: 1\nwardrobe: " << fs::absolute("tests/formats/wardrobe-1").string()
          << "\noutput: {width: 96, height: 64, samples: 4, frames: 4, fps: 10}\n"
             "crowd: {count: 6, seed: 3, placement: {spacing: 1.0}}\n"
             "camera: {position: [0, 1.6, 5], target: [0, 0.9, 0]}\n";
  }
  ProgramResult run(const std::string& arguments) { return testing::runProgram(arguments, folder_.path()); }
  nlohmann::json json(const std::string& file) {
    return nlohmann::json::parse(std::ifstream(folder_ / file));
  }
  std::string bytes(const std::string& file) { return testing::bytesOf(folder_ / file); }

  testing::TemporaryFolder folder_;
};

TEST_F(RenderCommand, WritesFramesAndFigures) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  const ProgramResult result = run("render scene.yaml -o frames/ --json figures.json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "") << "no bar where standard error is no terminal";
  const nlohmann::json figures = json("figures.json");
  EXPECT_EQ(figures["schema"], "ensemble.render/1");
  EXPECT_FALSE(figures["device"].get<std::string>().empty());
  ASSERT_EQ(figures["frames"].size(), 4u);
  for (int i = 0; i < 4; ++i) {
    const nlohmann::json& frame = figures["frames"][i];
    EXPECT_EQ(frame["index"], i);
    EXPECT_EQ(frame["file"], "frames/frame_000" + std::to_string(i) + ".png");
    EXPECT_THAT(bytes(frame["file"]), StartsWith("\x89PNG"));
    EXPECT_EQ(frame["characters_drawn"], 6);
    EXPECT_GT(frame["frame_ms"], 0.0);
    EXPECT_GT(frame["vertex_invocations"], 0);
    EXPECT_EQ(frame["triangles"], frame["passes"]["main"]["triangles"].get<int>() +
                                      frame["passes"]["shadow"]["triangles"].get<int>());
    EXPECT_GT(frame["draw_calls"], 0);
  }
}

TEST_F(RenderCommand, AFrameIsTheSameAloneAndInAnyOrder) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  ASSERT_EQ(run("render scene.yaml -o all/").exit_code, 0);
  ASSERT_EQ(run("render scene.yaml -o some/ --frames 3,1-2,3").exit_code, 0);
  ASSERT_EQ(run("render scene.yaml -o one.png --frames 2").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "some" / "frame_0000.png"));
  for (const char* name : {"/frame_0001.png", "/frame_0002.png", "/frame_0003.png"}) {
    EXPECT_EQ(bytes(std::string("all") + name), bytes(std::string("some") + name)) << name;
  }
  EXPECT_EQ(bytes("one.png"), bytes("all/frame_0002.png"));
  EXPECT_NE(bytes("all/frame_0001.png"), bytes("all/frame_0002.png"));
}

TEST_F(RenderCommand, AovsAreExplained) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  const ProgramResult result = run("render scene.yaml -o one.png --frames 0 --aov character,normal");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(fs::exists(folder_ / "one.character.exr"));
  EXPECT_TRUE(fs::exists(folder_ / "one.normal.exr"));
  EXPECT_FALSE(fs::exists(folder_ / "one.depth.exr"));
  const nlohmann::json ids = json("one.ids.json");
  EXPECT_EQ(ids["schema"], "ensemble.ids/1");
  ASSERT_EQ(ids["characters"].size(), 6u);
  EXPECT_EQ(ids["characters"][5]["id"], 6);
  EXPECT_EQ(ids["characters"][5]["outfit"], "tunic");
  EXPECT_EQ(ids["characters"][5]["clip"], "sway");
  EXPECT_EQ(ids["regions"][2]["id"], 3);
  EXPECT_EQ(ids["regions"][2]["name"], "head");
  EXPECT_EQ(ids["garments"][0]["id"], 4);
  EXPECT_EQ(ids["garments"][0]["name"], "garment.tunic");
  EXPECT_EQ(ids["outfits"][0]["garments"][0], 4);
}

TEST_F(RenderCommand, WithoutADeviceOneLineTellsHowToMend) {
  const ProgramResult result = testing::runProgram("--version", folder_.path());
  ASSERT_EQ(result.exit_code, 0);
  setenv("VK_ICD_FILENAMES", "/nowhere", 1);
  setenv("VK_DRIVER_FILES", "/nowhere", 1);
  const ProgramResult render = run("render scene.yaml -o one.png --frames 0");
  const ProgramResult version = run("--version");
  unsetenv("VK_ICD_FILENAMES");
  unsetenv("VK_DRIVER_FILES");
  EXPECT_EQ(render.exit_code, 1);
  EXPECT_EQ(render.err,
            "ensemble: Vulkan: there is no Vulkan driver; install a Vulkan 1.3 driver, e.g. apt install "
            "mesa-vulkan-drivers\n");
  EXPECT_FALSE(fs::exists(folder_ / "one.png"));
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, HasSubstr("Vulkan device: none"));
}

TEST_F(RenderCommand, AnEnvironmentIsCountedApart) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  testing::TestGlb set = testing::triangleGlb();
  set.add("cameras", {{"type", "perspective"}});
  const std::vector<std::byte> glb = set.bytes();
  std::ofstream(folder_ / "set.glb", std::ios::binary)
      .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
  const std::string said = "ensemble: warning: set.glb: not used and dropped: cameras\n";
  const std::string options = " --set environment=set.glb --set 'output={width: 64, height: 48}'";
  ProgramResult result = run("render scene.yaml -o one.png --json f.json" + options);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, said);
  const nlohmann::json frame = json("f.json")["frames"][0];
  EXPECT_EQ(frame["environment"]["triangles"], 2) << "in the picture and in the shadow map";
  EXPECT_EQ(frame["environment"]["draw_calls"], 2);
  EXPECT_EQ(frame["environment_bytes"], 3 * 24 + 3 * 2);
  result = run("bench scene.yaml --rounds 1 --json b.json" + options);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, said) << "once, not for each technique";
  const nlohmann::json figures = json("b.json");
  for (const nlohmann::json& row : figures["rows"]) {
    EXPECT_EQ(row["environment"]["triangles"], 2);
    EXPECT_EQ(row["environment_bytes"], 3 * 24 + 3 * 2);
  }
  std::ofstream(folder_ / "set.yaml") << "version: 1\nwardrobe: w\nenvironment: set.glb\n";
  EXPECT_THAT(run("inspect set.yaml").out, HasSubstr("\nenvironment set.glb\n"));
}

TEST_F(RenderCommand, APictureLargerThanATileIsDrawn) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  const ProgramResult result =
      run("render scene.yaml -o one.png --frames 0 --set output.width=16384 --set output.height=20 --json "
          "f.json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(bytes("one.png").substr(16, 8), std::string("\0\0\x40\0\0\0\0\x14", 8));
  EXPECT_EQ(json("f.json")["frames"][0]["characters_drawn"], 6);
}

TEST_F(RenderCommand, WritesLinearPicturesAndVideos) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  ProgramResult result = run("render scene.yaml -o l/a_%02d.exr --frames 1-2 --json figures.json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json("figures.json")["frames"][1]["file"], "l/a_02.exr");
  EXPECT_THAT(bytes("l/a_02.exr"), StartsWith("\x76\x2f\x31\x01"));
  EXPECT_THAT(bytes("l/a_02.exr"), HasSubstr("chromaticities"));
  result = run("render scene.yaml -o v/a.mp4 --frames 3,1-2 --aov character --json figures.json");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json("figures.json")["frames"].size(), 3u);
  EXPECT_EQ(json("figures.json")["frames"][0]["index"], 3);
  EXPECT_EQ(json("figures.json")["frames"][0]["file"], "v/a.mp4");
  EXPECT_THAT(bytes("v/a.mp4").substr(4), StartsWith("ftyp"));
  EXPECT_TRUE(fs::exists(folder_ / "v" / "a_0003.character.exr"));
  EXPECT_TRUE(fs::exists(folder_ / "v" / "a_0001.ids.json"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "v"), {}), 7);
  ASSERT_EQ(run("render scene.yaml -o again.mp4 --frames 3,1-2").exit_code, 0);
  EXPECT_EQ(bytes("again.mp4"), bytes("v/a.mp4"));
}

TEST_F(RenderCommand, AVideoOfWhatItCantHoldIsRefused) {
  EXPECT_EQ(
      run("render scene.yaml -o a.mp4 --resume").err,
      "ensemble: --resume: a video is written as a whole and can't be gone on with; leave --resume out, "
      "or write name_%04d.png and make the video of them\n");
  EXPECT_EQ(run("render scene.yaml -o a.mp4 --resume").exit_code, 2);
  EXPECT_EQ(run("render scene.yaml -o a.mp4 --set output.width=95").exit_code, 2);
  EXPECT_EQ(run("render scene.yaml -o a.mp4 --set output.background=transparent").exit_code, 2);
  EXPECT_FALSE(fs::exists(folder_ / "a.mp4"));
}

/// Files by name, with their bytes.
std::map<std::string, std::string> filesIn(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    files[entry.path().filename().string()] = testing::bytesOf(entry.path());
  }
  return files;
}

TEST_F(RenderCommand, ResumesWhereItWasKilled) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  const std::string options = "--set output.frames=40 --aov face,depth ";
  ASSERT_EQ(run("render scene.yaml -o whole/ " + options).exit_code, 0);
  fs::create_directory(folder_ / "cut");
  // Kill it as soon as its fifth frame is there.
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(folder_.path().c_str()) != 0) _exit(127);
    execl(ENSEMBLE_PROGRAM, "ensemble", "render", "scene.yaml", "-o", "cut/", "--set", "output.frames=40",
          "--aov", "face,depth", static_cast<char*>(nullptr));
    _exit(127);
  }
  ASSERT_GT(child, 0);
  while (!fs::exists(folder_ / "cut" / "frame_0004.png") && waitpid(child, nullptr, WNOHANG) == 0)
    usleep(500);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  ASSERT_TRUE(fs::exists(folder_ / "cut" / "frame_0004.png"));
  ASSERT_FALSE(fs::exists(folder_ / "cut" / "frame_0039.ids.json")) << "it was killed too late";
  // And some harm besides: what is cut off, missing or of another scene is made again.
  fs::resize_file(folder_ / "cut" / "frame_0000.png", fs::file_size(folder_ / "cut" / "frame_0000.png") - 1);
  fs::resize_file(folder_ / "cut" / "frame_0001.face.exr", 300);
  fs::remove(folder_ / "cut" / "frame_0002.depth.exr");
  std::ofstream(folder_ / "cut" / "frame_0003.ids.json") << "{}\n";

  const ProgramResult result = run("render scene.yaml -o cut/ --resume --json figures.json " + options);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::map<std::string, std::string> files = filesIn(folder_ / "cut");
  std::erase_if(files, [](const auto& file) { return file.first.starts_with('.'); });  // killed writers'
  EXPECT_TRUE(files == filesIn(folder_ / "whole"));
  const nlohmann::json figures = json("figures.json");
  EXPECT_EQ(figures["frames"].size() + figures["skipped"].size(), 40u);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(figures["frames"][i]["index"], i);

  ASSERT_EQ(run("render scene.yaml -o cut/ --resume --json figures.json " + options).exit_code, 0);
  EXPECT_EQ(json("figures.json")["frames"].size(), 0u);
  EXPECT_EQ(json("figures.json")["skipped"].size(), 40u);
  EXPECT_EQ(json("figures.json")["skipped"][39], 39);
  ASSERT_EQ(run("render scene.yaml -o cut/ --resume --json figures.json --frames 3 --set output.width=98 " +
                options)
                .exit_code,
            0);
  EXPECT_EQ(json("figures.json")["skipped"].size(), 0u) << "of another size";
}

TEST_F(RenderCommand, DebugIsInPicturesThatPeopleLookAt) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  ASSERT_EQ(run("render scene.yaml -o plain.png --frames 0").exit_code, 0);
  for (const char* debug : {"rasteriser", "pose", "overdraw"}) {
    const ProgramResult result =
        run(std::string("render scene.yaml -o one.png --frames 0 --set debug=") + debug);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(bytes("one.png"), bytes("plain.png")) << debug;
    EXPECT_FALSE(fs::exists(folder_ / "one.character.exr"));
  }
  const ProgramResult linear = run("render scene.yaml -o one.exr --frames 0 --set debug=pose");
  EXPECT_EQ(linear.exit_code, 2);
  EXPECT_EQ(
      linear.err,
      "ensemble: -o one.exr: what `debug` lays over a picture is no light, and not in an EXR; write .png, or "
      "--set debug=none\n");
  // Not compared: what is laid over a picture costs time of its own.
  ASSERT_EQ(
      run("bench scene.yaml --techniques tagged --rounds 1 --json b.json --set debug=overdraw").exit_code, 0);
}

TEST_F(RenderCommand, WrongUsageIsRefused) {
  const auto frames = [](const std::string& part) {
    return "ensemble: --frames: '" + part +
           "' is no frame and no range of frames; write numbers and ranges A-B from 0 to 999999, parted by "
           "commas: "
           "0-9,20\n";
  };
  for (const char* part : {"3-1", "x", "", "1-", "-1", "1000000", "4294967296", "1-2-3"}) {
    const ProgramResult result = run("render scene.yaml -o frames/ --frames 0,'" + std::string(part) + "'");
    EXPECT_EQ(result.exit_code, 2) << part;
    EXPECT_EQ(result.err, frames(part));
  }
  EXPECT_EQ(run("render scene.yaml").exit_code, 2) << "-o is missing";
  EXPECT_EQ(run("render scene.yaml -o one.png --frames 0 --aov depth,colour").exit_code, 2);
  EXPECT_EQ(run("render nowhere.yaml -o one.png").exit_code, 3);
}

TEST_F(RenderCommand, ValidationIsClean) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  const ProgramResult result =
      run("render scene.yaml -o one.png --frames 1 --aov character,region,face,depth,normal --validate");
  if (result.err.find("the validation layer is not installed") != std::string::npos)
    GTEST_SKIP() << result.err;
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(RenderCommand, BenchComparesTechniques) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  const ProgramResult result =
      run("bench scene.yaml --counts 3,9 --rounds 2 --json bench.json --csv bench.csv --html bench.html");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("technique "));
  EXPECT_THAT(result.out, HasSubstr("tagged / naive by auto, 9 people: "));
  const nlohmann::json bench = json("bench.json");
  EXPECT_EQ(bench["schema"], "ensemble.bench/1");
  EXPECT_EQ(bench["width"], 96);
  EXPECT_EQ(bench["height"], 64);
  ASSERT_EQ(bench["rows"].size(), 6u);
  ASSERT_EQ(bench["ratios"].size(), 6u);
  EXPECT_EQ(bench["ratios"][2]["versus"], "prefitted");
  EXPECT_EQ(bench["rounds"], 2);
  const std::string csv = bytes("bench.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
  EXPECT_THAT(csv, HasSubstr("\ntagged,9,9,2," + bench["rows"][5]["frame_ms"]["min"].dump() + ","));
  EXPECT_THAT(bytes("bench.html"), HasSubstr("<h1>Three techniques compared: scene.yaml</h1>"));
  for (const nlohmann::json& row : bench["rows"]) {
    EXPECT_EQ(row["rounds"], 2);
    EXPECT_EQ(row["frame_ms_of_rounds"].size(), 2u);
    EXPECT_EQ(row["vertex_invocations_differ_by"], 0);
    EXPECT_LE(row["frame_ms"]["min"], row["frame_ms"]["median"]);
    EXPECT_LE(row["frame_ms"]["median"], row["frame_ms"]["max"]);
    EXPECT_GT(row["gpu_mesh_bytes"], 0);
  }
  const nlohmann::json &naive = bench["rows"][3], &prefitted = bench["rows"][4], &tagged = bench["rows"][5];
  EXPECT_EQ(naive["technique"], "naive");
  EXPECT_EQ(naive["characters"], 9);
  EXPECT_EQ(tagged["triangles"], prefitted["triangles"]);
  EXPECT_LT(tagged["triangles"], naive["triangles"]);
  EXPECT_LT(tagged["vertex_invocations"], naive["vertex_invocations"]);
}

/// The scene with 120 people at key frames, which `auto` gives to the compute rasteriser.
const std::string kManySmall = " --set crowd.count=120 --set output.samples=1 --set poses.snap_below=1000 ";

TEST_F(RenderCommand, BenchComparesRasterisersOverFrames) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  const ProgramResult result =
      run("bench scene.yaml --techniques prefitted,tagged --rasterisers pipeline,compute,auto --frames 2-5 "
          "--rounds 6 --set camera.orbit.seconds=2 --json bench.json --csv bench.csv --html bench.html" +
          kManySmall);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json bench = json("bench.json");
  EXPECT_EQ(bench["frames"], (nlohmann::json{2, 3, 4, 5}));
  EXPECT_EQ(bench["warm_up_rounds"], 4);
  ASSERT_EQ(bench["rows"].size(), 6u);
  ASSERT_EQ(bench["ratios"].size(), 3u + 2 * 3u);
  ASSERT_EQ(bench["picture_errors"].size(), 2 * 3u);
  const nlohmann::json& pipeline = bench["rows"][3];
  EXPECT_EQ(pipeline["technique"], "tagged");
  EXPECT_EQ(pipeline["raster"], "pipeline");
  EXPECT_EQ(pipeline["share_of_people_computed"], 0.0);
  for (const std::size_t i : {4u, 5u}) {
    const nlohmann::json& row = bench["rows"][i];
    EXPECT_GT(row["share_of_people_computed"], 0.9) << row;
    EXPECT_GT(row["share_of_triangles_computed"], 0.5);
    EXPECT_EQ(row["triangles"], pipeline["triangles"]);
    EXPECT_GE(row["vertex_invocations"], 3 * row["triangles_computed"].get<std::uint64_t>()) << "each corner";
    EXPECT_GT(row["poses"]["kept"], 0);
    EXPECT_EQ(row["poses"]["skinned"], 0) << "the warm-up rounds have skinned all";
    EXPECT_EQ(row["poses"]["share_kept"], 1.0);
    EXPECT_EQ(row["pose_bytes"], bench["rows"][4]["pose_bytes"]) << "each has a cache of its own";
  }
  for (const nlohmann::json& error : bench["picture_errors"]) {
    EXPECT_EQ(error["frames"], 4);
    EXPECT_LE(error["mean_share"], error["worst_share"]);
  }
  EXPECT_THAT(bytes("bench.html"), HasSubstr("<h1>Techniques and rasterisers compared: scene.yaml</h1>"));
  EXPECT_THAT(bytes("bench.csv"), HasSubstr(",picture_vs_compute_worst,"));
}

TEST_F(RenderCommand, BenchDrawsTheFramesThatRenderDraws) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  const std::string camera =
      " --set 'camera.keys=[{time: 0, position: [0, 1.6, 5], target: [0, 0.9, 0]}, {time: 1, position: [0, "
      "1.6, 1]}]'";
  ASSERT_EQ(run("render scene.yaml -o all/ --json render.json" + camera + kManySmall).exit_code, 0);
  const nlohmann::json frames = json("render.json")["frames"];
  ASSERT_GT(frames[0]["characters_drawn"], frames[3]["characters_drawn"]) << "the camera goes nearer";
  for (const int frame : {0, 3}) {
    ASSERT_EQ(run("bench scene.yaml --techniques tagged --rounds 2 --json bench.json --frames " +
                  std::to_string(frame) + camera + kManySmall)
                  .exit_code,
              0);
    const nlohmann::json row = json("bench.json")["rows"][0];
    for (const char* key :
         {"characters_drawn", "characters_computed", "triangles", "triangles_computed", "draw_calls"})
      EXPECT_EQ(row[key], frames[frame][key]) << frame << " " << key;
  }
}

TEST_F(RenderCommand, BenchWithoutEnoughWarmUpSkinsPoses) {
  if (!testing::hasVulkanDevice()) GTEST_SKIP() << "there is no Vulkan device";
  ASSERT_EQ(run("bench scene.yaml --techniques tagged --rasterisers compute --frames 0-19 --warm-up 1 --json "
                "b.json" +
                kManySmall + "--set crowd.count=3")
                .exit_code,
            0);
  const nlohmann::json bench = json("b.json");
  EXPECT_EQ(bench["rounds"], 20) << "once through the frames";
  EXPECT_EQ(bench["warm_up_rounds"], 1);
  EXPECT_GT(bench["rows"][0]["poses"]["skinned"], 0);
  EXPECT_LT(bench["rows"][0]["poses"]["share_kept"], 1.0);
}

TEST_F(RenderCommand, BenchRefusesWhatItDoesNotKnow) {
  const ProgramResult rasterisers = run("bench scene.yaml --rasterisers pipeline,gpu");
  EXPECT_EQ(rasterisers.exit_code, 2);
  EXPECT_EQ(rasterisers.err,
            "ensemble: --rasterisers: unknown rasteriser 'gpu'; choose from auto,pipeline,compute\n");
  EXPECT_EQ(run("bench scene.yaml --warm-up 0").exit_code, 2);
  EXPECT_EQ(run("bench scene.yaml --frames 0-10000").err,
            "ensemble: --frames: 10001 frames are more than the 10000 that bench draws; list fewer\n");
  EXPECT_EQ(
      run("bench scene.yaml --frames 3-1").err,
      "ensemble: --frames: '3-1' is no frame and no range of frames; write numbers and ranges A-B from 0 to "
      "999999, parted by commas: 0-9,20\n");
  EXPECT_EQ(run("bench scene.yaml --techniques naive,taged").err,
            "ensemble: --techniques: unknown technique 'taged'; choose from naive,prefitted,tagged\n");
  const ProgramResult counts = run("bench scene.yaml --counts 10,0");
  EXPECT_EQ(counts.exit_code, 2);
  EXPECT_EQ(
      counts.err,
      "ensemble: --counts: '0' is no number of people; write numbers parted by commas, e.g. 100,1000\n");
  EXPECT_EQ(run("bench scene.yaml --rounds 0").exit_code, 2);
}

}  // namespace
}  // namespace ensemble
