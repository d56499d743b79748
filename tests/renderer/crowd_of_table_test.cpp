#include "renderer/crowd_of_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "core/atomic_file.h"
#include "core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

using ::testing::ElementsAre;

Wardrobe makeWardrobe(const std::vector<std::pair<std::string, std::string>>& outfits,
                      const std::vector<std::string>& clips) {
  Wardrobe wardrobe;
  for (const auto& [name, slot] : outfits) {
    Item item;
    item.name = name;
    item.slot = parseSlot(slot).value();
    wardrobe.items.push(std::move(item));
  }
  for (const std::string& name : clips) {
    Clip clip;
    clip.name = name;
    clip.seconds = 1.0f;
    clip.key_count = 2;
    clip.ground_speed = name == "walk" ? 1.2f : 0.0f;
    wardrobe.body.clips.push_back(std::move(clip));
  }
  return wardrobe;
}

std::vector<Wardrobe> one() {
  return {makeWardrobe({{"casual01", "full"}, {"sport01", "full"}, {"hat", "head"}}, {"walk", "idle"})};
}
std::vector<Wardrobe> two() {
  return {makeWardrobe({{"casual01", "full"}, {"dress01", "full"}}, {"walk", "idle", "dance"}),
          makeWardrobe({{"casual01", "full"}, {"sport01", "full"}}, {"idle", "walk"})};
}
const std::string kOne = "wardrobe: w\n";
const std::string kTwo = "wardrobe: {women: w, men: m}\n";

class CrowdOfTableTest : public ::testing::Test {
 protected:
  Scene parse(const std::string& text) const { return parseScene("version: 1\n" + text, folder_ / "a.yaml"); }
  /// A crowd from a table, with more keys of `crowd`.
  Crowd crowdOf(const std::string& wardrobes, const std::string& table, const std::string& keys = "") {
    writeFileAtomically(folder_ / "c.csv", std::string_view(table));
    return populateCrowd(parse(wardrobes + "crowd: {placement: {kind: file, file: c.csv}" + keys + "}\n"),
                         wardrobes == kOne ? one() : two());
  }
  /// The message, with the folder's name left out.
  std::string errorOf(const std::string& wardrobes, const std::string& table, const std::string& keys = "") {
    try {
      crowdOf(wardrobes, table, keys);
    } catch (const InputError& error) {
      std::string message = error.what();
      const std::string folder = folder_.path().string() + "/";
      for (std::size_t at = message.find(folder); at != std::string::npos; at = message.find(folder)) {
        message.erase(at, folder.size());
      }
      return message;
    }
    return "no error";
  }

  testing::TemporaryFolder folder_;
};

void expectSame(const Crowd& a, const Crowd& b) {
  ASSERT_EQ(a.characters.size(), b.characters.size());
  EXPECT_EQ(a.combinations, b.combinations);
  for (std::size_t i = 0; i < a.characters.size(); ++i) {
    const Character &x = a.characters[i], &y = b.characters[i];
    EXPECT_TRUE(x.wardrobe == y.wardrobe && x.combination == y.combination && x.clip == y.clip &&
                x.phase == y.phase && x.speed == y.speed && x.position == y.position &&
                x.heading == y.heading && x.scale == y.scale && x.tint_seed == y.tint_seed)
        << i;
  }
}

TEST_F(CrowdOfTableTest, ADumpedCrowdIsReadBackExactly) {
  const char* placements[] = {"{kind: disc, center: [0.1, 0.2, 0.3]}",
                              "{kind: grid, jitter: 0.4, heading: 33, heading_spread: 77}",
                              "{kind: formation, heading: -123.4}"};
  for (int seed = 1; seed <= 12; ++seed) {
    const Scene scene =
        parse(kTwo + "crowd: {count: 200, seed: " + std::to_string(seed) +
              ", scale: [0.9, 1.1], clips: {walk: 2, idle: 1}, placement: " + placements[seed % 3] + R"(}
people:
  - {wardrobe: men, outfit: sport01, clip: walk, phase: 0.1, speed: 0.3, position: [1.1, 2, -3], heading: 91.7, scale: 0.7, tint: 5}
  - {wardrobe: women, heading: -360}
)");
    const Crowd crowd = populateCrowd(scene, two());
    const DumpedCrowd dumped = tableOfCrowd(scene, two(), crowd);
    EXPECT_THAT(dumped.warnings, ElementsAre());
    expectSame(crowd, crowdOf(kTwo, crowdTableText(dumped.table)));
  }
}

TEST_F(CrowdOfTableTest, WhatNoColumnTellsIsAsForAnyCrowd) {
  const std::string weights =
      ", seed: 9, wardrobes: {women: 3, men: 1}, clips: {walk: 1, idle: 1}, scale: [0.5, 2]";
  const Crowd grid = populateCrowd(parse(kTwo + "crowd: {count: 3" + weights + "}\n"), two());
  const Crowd read = crowdOf(kTwo, "x,z\n1,2\n3,4\n5,6\n", weights);
  ASSERT_EQ(read.characters.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const Character &a = grid.characters[i], &b = read.characters[i];
    EXPECT_EQ(a.wardrobe, b.wardrobe);
    EXPECT_EQ(a.clip, b.clip);
    EXPECT_EQ(a.phase, b.phase);
    EXPECT_EQ(a.heading, b.heading);
    EXPECT_EQ(a.scale, b.scale);
    EXPECT_EQ(a.tint_seed, b.tint_seed);
    EXPECT_EQ(b.position, Vec3(2.0f * static_cast<float>(i) + 1.0f, 0, 2.0f * static_cast<float>(i) + 2.0f));
  }
  EXPECT_EQ(grid.combinations, read.combinations);
}

TEST_F(CrowdOfTableTest, OutfitsAreDrawnFromTheWardrobeOfTheRow) {
  const Crowd crowd = crowdOf(kTwo, "x,z,wardrobe\n0,0,men\n1,0,men\n2,0,men\n3,0,men\n",
                              ", outfits: {sport01: 1, dress01: 1}");
  EXPECT_THAT(crowd.combinations, ElementsAre(WornCombination{1, {ItemId(1)}}));
  for (const Character& person : crowd.characters) EXPECT_EQ(person.wardrobe, 1u);
  // Nobody is a woman, so that women need no clip of that name.
  EXPECT_EQ(errorOf(kTwo, "x,z,wardrobe\n0,0,women\n", ", clips: {dance: 1}"), "no error");
}

TEST_F(CrowdOfTableTest, EmptyFieldsMeanWhatLeftOutKeysMeanForPeople) {
  const Crowd crowd = crowdOf(
      kOne,
      "x,z,wardrobe,outfit,clip,phase,speed,heading,scale\n0,0,,,,,,,\n1,0,,hat+casual01,idle,1,0,9,2\n");
  const Character& plain = crowd.characters[0];
  EXPECT_THAT(crowd.combinations[plain.combination].items, ElementsAre());
  EXPECT_EQ(plain.clip, 0u);
  EXPECT_EQ(plain.phase, 0.0f);
  EXPECT_EQ(plain.speed, 1.0f);
  EXPECT_EQ(plain.heading, 0.0f);
  EXPECT_EQ(plain.scale, 1.0f);
  EXPECT_THAT(crowd.combinations[crowd.characters[1].combination].items, ElementsAre(ItemId(0), ItemId(2)));
  EXPECT_EQ(crowd.characters[1].clip, 1u);
}

TEST_F(CrowdOfTableTest, TakesTheFirstRowsAroundACenter) {
  writeFileAtomically(folder_ / "c.csv", std::string_view("x,y,z\n1,2,3\n4,5,6\n7,8,9\n"));
  const Scene scene =
      parse(kOne +
            "crowd: {count: 2, placement: {kind: file, file: c.csv, center: [10, 20, 30], heading: 90}}\n"
            "people: [{position: [5, 5, 5]}]\n");
  const Crowd crowd = populateCrowd(scene, one());
  ASSERT_EQ(crowd.characters.size(), 3u);
  EXPECT_EQ(crowd.characters[0].position, Vec3(5, 5, 5)) << "people come first";
  EXPECT_EQ(crowd.characters[1].position, Vec3(11, 22, 33));
  EXPECT_EQ(crowd.characters[2].position, Vec3(14, 25, 36));
  EXPECT_EQ(crowd.characters[1].heading, radians(90.0f));
}

TEST_F(CrowdOfTableTest, NamesAreRefusedAtTheirPlaceInTheTable) {
  EXPECT_EQ(errorOf(kOne, "x,z,outfit\n0,0,casual01\n0,0,casul01\n"),
            "c.csv: 3:5: the wardrobe 'w' has no outfit 'casul01'; write 'casual01'");
  EXPECT_EQ(errorOf(kTwo, "x,z,wardrobe,clip\n0,0,women,dance\n0,0,men,dance\n"),
            "c.csv: 3:9: the wardrobe 'men' has no clip 'dance'; write 'idle' or 'walk'");
  EXPECT_EQ(errorOf(kTwo, "x,z,wardrobe\n0,0,womn\n"),
            "c.csv: 2:5: there is no wardrobe 'womn'; write 'women'");
  EXPECT_EQ(errorOf(kTwo, "x,z,wardrobe\n0,0,\n"),
            "c.csv: 2:5: the row names none of 2 wardrobes; write 'women' or 'men'");
  EXPECT_EQ(errorOf(kTwo, "x,z,outfit\n0,0,dress01\n"),
            "c.csv: 1:1: the table tells outfits, but not of which of 2 wardrobes; add a column 'wardrobe'");
  EXPECT_EQ(errorOf(kOne, "x,z,outfit\n0,0,casual01+sport01\n"),
            "c.csv: 2:5: 'casual01' and 'sport01' are both of the slot 'full'; write one of them");
  EXPECT_EQ(errorOf(kOne, "x,z,outfit\n0,0,hat+hat\n"),
            "c.csv: 2:5: 'hat' and 'hat' are both of the slot 'head'; write one of them");
  EXPECT_EQ(errorOf(kOne, "x,z,outfit\n0,0,hat+\n"),
            "c.csv: 2:5: the wardrobe 'w' has no outfit ''; write 'casual01', 'sport01' or 'hat'");
}

TEST_F(CrowdOfTableTest, KeysThatColumnsLeaveNothingToAreRefused) {
  const std::string table = "x,z,wardrobe,outfit,clip,heading,scale\n0,0,women,,,,\n";
  EXPECT_EQ(errorOf(kTwo, table, ", wardrobes: {women: 1}"),
            "a.yaml: 3:66: crowd.wardrobes chooses what a column of c.csv tells; remove it, or the column "
            "'wardrobe'");
  EXPECT_EQ(errorOf(kTwo, table, ", outfits: {dress01: 1}"),
            "a.yaml: 3:66: crowd.outfits chooses what a column of c.csv tells; remove it, or the column "
            "'outfit'");
  EXPECT_EQ(
      errorOf(kTwo, table, ", clips: {walk: 1}"),
      "a.yaml: 3:61: crowd.clips chooses what a column of c.csv tells; remove it, or the column 'clip'");
  EXPECT_EQ(
      errorOf(kTwo, table, ", scale: 1"),
      "a.yaml: 3:54: crowd.scale chooses what a column of c.csv tells; remove it, or the column 'scale'");
  writeFileAtomically(
      folder_ / "heading.yaml",
      std::string_view(
          "version: 1\nwardrobe: w\ncrowd: {placement: {kind: file, file: c.csv, heading: 1}}\n"));
  const Scene scene = loadScene(folder_ / "heading.yaml");
  try {
    populateCrowd(scene, one());
    ADD_FAILURE() << "did not throw";
  } catch (const InputError& error) {
    EXPECT_EQ(error.text().where, "3:55");
    EXPECT_EQ(error.text().mend, "remove it, or the column 'heading'");
  }
  EXPECT_EQ(errorOf(kTwo, "x,z\n0,0\n", ", count: 2"),
            "a.yaml: crowd.count: 2 people, but c.csv has 1; lower crowd.count, or leave it out to have all");
}

TEST_F(CrowdOfTableTest, WalkersAreDumpedWhereTheyAreAtTime0) {
  writeFileAtomically(folder_ / "ways.txt",
                      std::string_view("# framerate: 1\n1 0 0 0\n1 9 9 0\n2 3 0 5\n2 9 6 5\n"
                                       "3 0 2 2\n3 9 2 2\n"));
  const Scene scene = parse(kOne + "crowd: {placement: {kind: file, file: ways.txt, smoothing: 0}}\n");
  const Crowd crowd = populateCrowd(scene, one());
  const DumpedCrowd dumped = tableOfCrowd(scene, one(), crowd);
  EXPECT_THAT(dumped.warnings,
              ElementsAre("2 of 3 people walk along paths or trajectories; the table has where they are at "
                          "time 0, not their ways",
                          "1 of 3 people are not there at time 0 and left out"));
  ASSERT_EQ(dumped.table.rows.size(), 2u);
  EXPECT_EQ(dumped.table.rows[0].number, 0u);
  EXPECT_EQ(dumped.table.rows[0].position, Vec3(0, 0, 0));
  EXPECT_NEAR(dumped.table.rows[0].heading, radians(90.0f), 1e-5f);
  EXPECT_EQ(dumped.table.names[dumped.table.rows[0].clip.name], "walk");
  EXPECT_EQ(dumped.table.rows[1].number, 2u);
  EXPECT_EQ(dumped.table.rows[1].position, Vec3(2, 0, -2));
  EXPECT_EQ(dumped.table.names[dumped.table.rows[1].clip.name], "idle") << "who stands";
}

TEST_F(CrowdOfTableTest, NamesThatATableCantTellAreRefused) {
  std::vector<Wardrobe> wardrobes = {makeWardrobe({{"a", "full"}, {"b", "head"}, {"a+b", "full"}}, {"", ""})};
  const Scene scene = parse(kOne);
  const auto dumpError = [&](const Combination& items, std::uint32_t clip) -> std::string {
    Crowd crowd;
    crowd.combinations = {{0, items}};
    crowd.characters.emplace_back().clip = clip;
    try {
      const CrowdTable table = tableOfCrowd(scene, wardrobes, crowd).table;
      return table.names[table.rows[0].outfit.name];
    } catch (const InputError& error) {
      return std::string(error.what()).substr((folder_ / "a.yaml: ").string().size());
    }
  };
  EXPECT_EQ(dumpError({ItemId(2)}, 0), "a+b");
  EXPECT_EQ(dumpError({}, 0), "");
  EXPECT_EQ(dumpError({ItemId(0), ItemId(1)}, 0),
            "--dump-crowd: the outfit 'a+b' of the wardrobe '" + (folder_ / "w").string() +
                "' can't be told by its name in a table; rename it, an outfit to a name without '+'");
  EXPECT_EQ(dumpError({ItemId(1), ItemId(2)}, 0).substr(0, 30), "--dump-crowd: the outfit 'b+a+");
  EXPECT_EQ(dumpError({}, 1).substr(0, 26), "--dump-crowd: the clip '' ");
  wardrobes[0].items[ItemId(2)].name = "c";
  EXPECT_EQ(dumpError({ItemId(0), ItemId(1)}, 0), "a+b");
}

}  // namespace
}  // namespace ensemble
