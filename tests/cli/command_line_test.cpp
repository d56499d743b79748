// The program's contract with the scripts that call it: exit codes, messages, streams.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "core/atomic_file.h"
#include "core/gltf_file.h"
#include "tests/cli/run_program.h"
#include "tests/support/small_people.h"

namespace ensemble {
namespace {

using ::testing::HasSubstr;
using testing::ProgramResult;

class CommandLine : public ::testing::Test {
 protected:
  CommandLine() {
    writeFileAtomically(folder_ / "template.glb", writeGlb(testing::tubeTemplate()));
    writeFileAtomically(folder_ / "tunic.glb", writeGlb(testing::tubeOutfit([](int region, int face) {
                          return region == 0 || (region == 1 && face % 2 == 0);
                        })));
  }

  ProgramResult run(const std::string& arguments) const {
    return testing::runProgram(arguments, folder_.path());
  }

  std::string text(const std::string& file) const {
    const std::vector<std::byte> bytes = readFile(folder_ / file);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  testing::TemporaryFolder folder_;
};

TEST_F(CommandLine, HelpAndVersion) {
  const ProgramResult help = run("--help");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command :
       {"tag", "add", "remove", "report", "inspect", "render", "bench", "author", "people"}) {
    EXPECT_THAT(help.out, HasSubstr(std::string("  ") + command)) << "not in --help";
    const ProgramResult own = run(std::string(command) + " --help");
    EXPECT_EQ(own.exit_code, 0) << command;
    EXPECT_THAT(own.out, ::testing::StartsWith("ensemble " + std::string(command) + " - "));
    EXPECT_THAT(own.out, HasSubstr("Usage: ensemble " + std::string(command) + " [OPTIONS]"));
    EXPECT_THAT(own.out, HasSubstr("\nFiles:\n"));
    EXPECT_THAT(own.out, HasSubstr("\nExit codes:\n  0  done\n"));
    EXPECT_THAT(own.out, HasSubstr("Example:\n  ensemble " + std::string(command)));
    std::stringstream lines(own.out.substr(0, own.out.find("Example:")));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80u) << command << ": " << line;
    for (const char* option : {"--json", "--quiet", "--verbose"})
      EXPECT_THAT(own.out, HasSubstr(option)) << command;
  }
  const ProgramResult version = run("--version");
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, ::testing::StartsWith("ensemble 0.1.0 ("));
  EXPECT_THAT(version.out, HasSubstr("Vulkan device: "));
}

TEST_F(CommandLine, WrongUsageIsTwo) {
  for (const char* arguments : {"", "fly", "tag", "tag template.glb", "report --extrapolate 0 w", "add w",
                                "tag template.glb -o w --tolerance -1", "tag template.glb -o w -q -v"}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, ::testing::MatchesRegex("ensemble: [^\n]+\n")) << arguments;
  }
}

TEST_F(CommandLine, HiddenFacesAreAuthoredFoundOrBoth) {
  // The author removed the head and every second face of the torso; a tight tunic hides a belt of the torso.
  writeFileAtomically(
      folder_ / "tunic.glb",
      writeGlb(testing::tubeOutfit(
          [](int region, int face) { return region == 0 || (region == 1 && face % 2 == 0); }, 0.22f)));
  const auto visibleFaces = [&](const std::string& option) {
    const ProgramResult result = run("tag template.glb tunic.glb -o w -q --json - " + option);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const nlohmann::json manifest = nlohmann::json::parse(result.out);
    std::vector<int> counts;
    for (const auto& region : manifest["outfits"][0]["regions"]) counts.push_back(region["visible_faces"]);
    return counts;
  };
  EXPECT_EQ(visibleFaces("--occlusion authored"), (std::vector<int>{64, 32, 0}));
  const std::vector<int> found = visibleFaces("--auto-occlusion");
  EXPECT_EQ(found[0], 64);
  EXPECT_LT(found[1], 64);
  EXPECT_EQ(found[2], 64) << "what the author removed does not matter";
  EXPECT_EQ(visibleFaces("--occlusion auto"), found);
  const std::vector<int> both = visibleFaces("--occlusion both");
  EXPECT_LT(both[1], found[1]);
  EXPECT_LT(both[1], 32);
  EXPECT_EQ(both[2], 0);
}

TEST_F(CommandLine, ExplainTellsWhyFacesAreKept) {
  writeFileAtomically(folder_ / "tunic.glb",
                      writeGlb(testing::tubeOutfit([](int, int) { return true; }, 0.22f)));
  const ProgramResult result = run("tag template.glb tunic.glb -o w -q --auto-occlusion --explain why");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::ifstream file(folder_ / "why" / "tunic.json");
  const nlohmann::json why = nlohmann::json::parse(file);
  EXPECT_EQ(why["schema"], "ensemble.explain/1");
  std::size_t kept = 0;
  for (const auto& region : why["regions"]) {
    EXPECT_EQ(region["kept"].get<int>() + region["hidden"].get<int>(), 64);
    for (const auto& face : region["faces"]) {
      if (face["verdict"] != "kept") continue;
      ++kept;
      EXPECT_TRUE(face["share"] > 0.25 || face["mm2"] > 12.0) << face;
      EXPECT_TRUE(face["clip"].is_string()) << face;
    }
  }
  EXPECT_GT(kept, 64u) << "head and legs at least";
  EXPECT_TRUE(std::filesystem::exists(folder_ / "why" / "tunic.png"));
  EXPECT_EQ(run("tag template.glb tunic.glb -o w -q --auto-occlusion --explain /dev/null/why").exit_code, 1);
}

TEST_F(CommandLine, WhatIsTaggedAlreadyStaysAsItIsAndIsTold) {
  ASSERT_EQ(run("tag template.glb tunic.glb -o w -q").exit_code, 0);
  std::filesystem::path tagged;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "w" / "outfits"))
    tagged = entry.path();
  const auto tag = [&](const std::string& options) {
    return run("tag template.glb w/outfits/" + tagged.filename().string() + " -o w2" + options).err;
  };
  const std::string begin = "ensemble: warning: w/outfits/" + tagged.filename().string() +
                            ": it is tagged already, so its hidden faces stay as they are";
  EXPECT_EQ(tag(""), "");
  EXPECT_EQ(tag(" --auto-occlusion"), begin + "; give the file that it was tagged from\n");
  EXPECT_EQ(tag(" --auto-occlusion --explain why"),
            begin + " and --explain has nothing to tell; give the file that it was tagged from\n");
}

TEST_F(CommandLine, InvalidInputIsThree) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"tag none.glb -o w", "ensemble: none.glb: no such file; check the path\n"},
      {"report nowhere",
       "ensemble: nowhere: there is no wardrobe here (no wardrobe.json); give a folder made by `ensemble "
       "tag`\n"},
      {"inspect none.glb", "ensemble: none.glb: no such file; check the path\n"}};
  for (const auto& [arguments, message] : cases) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 3) << arguments;
    EXPECT_EQ(result.err, message);
  }
}

TEST_F(CommandLine, WhatCantBeDoneIsOne) {
  // Unlike permissions, these fail for root as well.
  const ProgramResult no_folder = run("tag template.glb tunic.glb -o tunic.glb/wardrobe");
  EXPECT_EQ(no_folder.exit_code, 1);
  EXPECT_EQ(no_folder.err,
            "ensemble: tunic.glb/wardrobe: the folder can't be made: Not a directory; choose a place that "
            "you may write to\n");
  ASSERT_EQ(run("-q tag template.glb tunic.glb -o w").exit_code, 2) << "-q belongs to the subcommand";
  ASSERT_EQ(run("tag -q template.glb tunic.glb -o w").exit_code, 0);
  const ProgramResult full = run("report w --json /dev/full");
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_THAT(full.err, HasSubstr("ensemble: /dev/full: can't be written: "));
  const ProgramResult no_output = run("report w 3>&1 >/dev/full 2>&2; exit $?; #");
  EXPECT_EQ(no_output.exit_code, 1);
}

TEST_F(CommandLine, TagReportInspectAddRemove) {
  const ProgramResult tagged = run("tag template.glb tunic.glb -o w");
  EXPECT_EQ(tagged.exit_code, 0) << tagged.err;
  EXPECT_EQ(tagged.out,
            "tunic: legs full, torso partial (32/64), head hidden\nw: 192 faces, 3 regions, 1 outfits\n");
  EXPECT_EQ(tagged.err, "");

  const ProgramResult report = run("report w --json -");
  EXPECT_EQ(report.exit_code, 0);
  const nlohmann::json figures = nlohmann::json::parse(report.out);
  EXPECT_EQ(figures["schema"], "ensemble.report/1");
  EXPECT_EQ(figures["techniques"]["tagged"]["faces"], 192 + 80 + 32);
  EXPECT_EQ(figures["outfits"][0]["dedicated_faces"], 32);

  EXPECT_EQ(run("report w -q --extrapolate 5 --csv w.csv --html w.html").exit_code, 0);
  EXPECT_THAT(text("w.csv"), HasSubstr("\ntotal,,tagged,192,80,32,304,"));
  EXPECT_THAT(text("w.csv"), HasSubstr("\nmeasured,1,tagged,,,,304,"));
  EXPECT_THAT(text("w.html"), HasSubstr("<h1>What tagging saves: w</h1>"));

  const nlohmann::json visible = nlohmann::json::parse(run("inspect w --visible tunic --json -").out);
  ASSERT_EQ(visible["regions"].size(), 3u);
  EXPECT_EQ(visible["regions"][0]["faces"].size(), 64u);
  EXPECT_EQ(visible["regions"][1]["visibility"], "partial");
  EXPECT_EQ(visible["regions"][1]["faces"][1], 2) << "every second face was kept";
  EXPECT_EQ(visible["regions"][2]["faces"].size(), 0u);
  EXPECT_EQ(run("inspect w --visible tunik").err,
            "ensemble: w: the wardrobe has no outfit 'tunik'; did you mean 'tunic'?\n");

  EXPECT_EQ(run("remove w tunic").out, "w: 192 faces, 3 regions, 0 outfits\n");
  EXPECT_EQ(run("add w tunic.glb -q").out, "");
  EXPECT_EQ(run("add w tunic.glb").exit_code, 3);
}

TEST_F(CommandLine, PeopleAreToldAsTheyAreWritten) {
  writeFileAtomically(folder_ / "p.yaml",
                      std::string_view("version: 1\npeople:\n  - {name: ann, sex: female, "
                                       "faces: 1500, outfits: [hair_short]}\n"));
  const ProgramResult made = run("people p.yaml -o out -q --json -");
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const nlohmann::json told = nlohmann::json::parse(made.out);
  const nlohmann::json& outfit = told["people"][0]["outfits"][0];
  EXPECT_EQ(outfit["name"], "hair_short");
  EXPECT_EQ(outfit["slot"], "hair");
  EXPECT_GT(outfit["garments"][0]["faces"], 100);
  EXPECT_NO_THROW(readGltf(folder_ / "out/ann/template.glb"));
  EXPECT_NO_THROW(readGltf(folder_ / "out/ann/outfits/hair_short.glb"));
}

}  // namespace
}  // namespace ensemble
