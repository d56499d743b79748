// A wardrobe of single items, as a user tags, reports and renders it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/gltf_file.h"
#include "tests/cli/run_program.h"
#include "tests/support/small_people.h"

namespace ensemble {
namespace {

using ::testing::HasSubstr;
using testing::ProgramResult;

class MixAndMatch : public ::testing::Test {
 protected:
  void SetUp() override {
    writeFileAtomically(folder_ / "template.glb", writeGlb(testing::tubeTemplate()));
    writeItem("tshirt", "upper", 0.23f, [](int region, int face) { return region != 1 || face % 2 == 0; });
    writeItem("jumper", "upper", 0.24f, [](int region, int face) { return region != 1 || face < 10; });
    writeItem("jeans", "lower", 0.25f, [](int region, int) { return region != 0; });
    writeItem("shorts", "lower", 0.26f, [](int region, int face) { return region != 0 || face < 20; });
    writeItem("shoes", "feet", 0.27f, [](int region, int face) { return region != 0 || face >= 8; });
    write("scene.yaml",
          "crowd: {count: 40, seed: 2, wear: {feet: {shoes: 1, none: 1}, lower: {jeans: 2, shorts: 1}}}\n"
          "people: [{wears: [shoes, tshirt, jeans], position: [1, 0, 2]}]\n");
  }
  template <class Keep>
  void writeItem(const std::string& name, const std::string& slot, float radius, const Keep& keep) {
    RawAsset item = testing::tubeOutfit(keep, radius);
    item.materials.back().double_sided = false;  // else one sees its inside through the tube's open ends
    item.scene_extras_json = R"({"ensemble": {"slot": ")" + slot + R"("}})";
    writeFileAtomically(folder_ / (name + ".glb"), writeGlb(item));
  }
  void write(const std::string& file, const std::string& keys) const {
    writeFileAtomically(folder_ / file,
                        std::string_view("version: 1\nwardrobe: w\noutput: {width: 96, height: 64}\n"
                                         "camera: {position: [0, 1.6, 5], target: [0, 0.9, 0]}\n" +
                                         keys));
  }
  ProgramResult run(const std::string& arguments) const {
    return testing::runProgram(arguments, folder_.path());
  }
  ProgramResult tag() const {
    return run("tag template.glb tshirt.glb jumper.glb jeans.glb shorts.glb shoes.glb -o w");
  }
  std::string bytes(const std::string& file) const {
    const std::vector<std::byte> read = readFile(folder_ / file);
    return {reinterpret_cast<const char*>(read.data()), read.size()};
  }

  testing::TemporaryFolder folder_;
};

TEST_F(MixAndMatch, TheReportCountsCombinations) {
  ASSERT_EQ(tag().exit_code, 0);
  const ProgramResult result = run("report w --json report.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("\n8 combinations of 2 upper, 2 lower, 1 feet\n"));
  const nlohmann::json report = nlohmann::json::parse(bytes("report.json"));
  const nlohmann::json& combinations = report["combinations"];
  EXPECT_EQ(combinations["count"], 8);
  EXPECT_EQ(combinations["items"]["upper"], 2);
  EXPECT_EQ(combinations["items"]["full"], 0);
  EXPECT_EQ(combinations["stored"]["visible_bodies"], 6) << "jeans hide what shoes do";
  // Of the torso 32 and 10 faces; of the legs 20 under shorts, 12 under shorts and shoes.
  EXPECT_EQ(combinations["stored"]["dedicated_sub_meshes"], 4);
  EXPECT_EQ(combinations["stored"]["tagged_bytes"].get<int>() -
                combinations["stored"]["lower_bound_bytes"].get<int>(),
            6 * (32 + 10 + 20 + 12));
  EXPECT_EQ(combinations["stored"]["lower_bound_bytes"], report["lower_bound_bytes"]);
}

TEST_F(MixAndMatch, WhatItemsHideOfOneAnotherIsFoundOnceAndKept) {
  writeItem("jacket", "over", 0.232f, [](int, int) { return true; });
  ASSERT_EQ(run("tag template.glb tshirt.glb jeans.glb jacket.glb -o w").exit_code, 0);
  write("layers.yaml", "people: [{wears: [tshirt, jeans]}, {wears: [tshirt, jeans, jacket]}]\n");
  const auto report = [&] { return run("report layers.yaml --json report.json"); };
  const ProgramResult first = report();
  EXPECT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("\n1 pair of items is worn over one another; of the garments' faces "));
  const nlohmann::json layers = nlohmann::json::parse(bytes("report.json"))["layers"];
  EXPECT_EQ(layers["pairs"], 1) << "the jeans stand off";
  EXPECT_EQ(layers["garment_faces"], 5 * 80);
  EXPECT_GT(layers["hidden_garment_faces"], 0);
  EXPECT_LE(layers["hidden_garment_faces"], 80);
  const auto files = [&] {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "w" / "layers"))
      found.push_back(entry);
    return found;
  };
  EXPECT_EQ(files().size(), 2u);
  EXPECT_EQ(report().out, first.out);
  EXPECT_EQ(run("render layers.yaml -o a.png").err, "");
  // What can't be kept is found all the same.
  std::filesystem::remove_all(folder_ / "w" / "layers");
  write("w/layers", "");
  const ProgramResult unkept = report();
  EXPECT_EQ(unkept.exit_code, 0);
  EXPECT_EQ(unkept.out, first.out);
  EXPECT_EQ(unkept.err,
            "ensemble: warning: w: what items hide of one another can't be kept here and is found anew each "
            "time (w/layers: can't be written: File exists; choose another place)\n");
  std::filesystem::remove(folder_ / "w" / "layers");
  report();
  EXPECT_EQ(files().size(), 2u);
  EXPECT_EQ(run("remove w jacket").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "w" / "layers"));
}

TEST_F(MixAndMatch, TheReportOfASceneCountsWhatIsWorn) {
  ASSERT_EQ(tag().exit_code, 0);
  const ProgramResult result = run("report scene.yaml --set crowd.wear.upper.tshirt=1 --json report.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("41 people in 4 combinations\n3 different visible bodies, "));
  const nlohmann::json report = nlohmann::json::parse(bytes("report.json"));
  EXPECT_EQ(report["schema"], "ensemble.scene_report/1");
  EXPECT_EQ(report["people"], 41);
  EXPECT_EQ(report["combinations"], 4);
  EXPECT_EQ(report["wardrobes"][0]["stored"], report["stored"]);
  EXPECT_GT(report["stored"]["prefitted_vs_tagged"], 1.0);
  for (const char* option : {"--csv a.csv", "--extrapolate 5"}) {
    const ProgramResult refused = run(std::string("report scene.yaml ") + option);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(
        refused.err,
        "ensemble: " + std::string(option).substr(0, std::string(option).find(' ')) +
            ": a scene is reported as text, JSON and a web page only; give the folder of a wardrobe, or "
            "leave the option out\n");
  }
  ASSERT_EQ(run("report scene.yaml --set crowd.wear.upper.tshirt=1 --html page.html").exit_code, 0);
  EXPECT_THAT(bytes("page.html"), HasSubstr("<p>41 people in 4 combinations of items."));
  const ProgramResult refused = run("report w --set crowd.count=5");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err,
            "ensemble: --set: a wardrobe has no keys to set; give a scene, or leave the option out\n");
}

TEST_F(MixAndMatch, ATableTellsCombinationsAndReadsBack) {
  ASSERT_EQ(tag().exit_code, 0);
  const ProgramResult first = run("render scene.yaml -o one.png --aov character --dump-crowd crowd.csv");
  if (first.err.find("Vulkan") != std::string::npos) GTEST_SKIP() << "there is no Vulkan device";
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(bytes("crowd.csv"), HasSubstr("\n0,,tshirt+jeans+shoes,sway,"));
  const nlohmann::json ids = nlohmann::json::parse(bytes("one.ids.json"));
  EXPECT_EQ(ids["characters"][0]["outfit"], "tshirt+jeans+shoes");
  write("back.yaml", "crowd: {placement: {kind: file, file: crowd.csv}}\n");
  ASSERT_EQ(run("render back.yaml -o two.png --dump-crowd again.csv").exit_code, 0);
  EXPECT_EQ(bytes("one.png"), bytes("two.png"));
  EXPECT_EQ(bytes("crowd.csv"), bytes("again.csv"));
}

TEST_F(MixAndMatch, MistakesAreToldInOneLine) {
  writeItem("cap", "top", 0.23f, [](int, int) { return true; });
  ProgramResult result = run("tag template.glb cap.glb -o w");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(
      result.err,
      "ensemble: cap.glb: /scenes: the custom property 'slot' is 'top'; set hair, head, upper, lower, full, "
      "feet or over\n");
  ASSERT_EQ(run("tag template.glb tshirt.glb shoes.glb -o w").exit_code, 0);
  write("bare.yaml", "crowd: {count: 2}\n");
  result = run("report bare.yaml");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(
      result.err,
      "ensemble: bare.yaml: crowd: the wardrobe 'w' has no item of the slot 'lower' and none of 'full'; "
      "add one, or "
      "name what people wear in crowd.outfits\n");
}

}  // namespace
}  // namespace ensemble
