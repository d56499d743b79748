#include "core/wardrobe_files.h"

#include <gtest/gtest.h>

#include "tests/support/expect_error.h"

namespace ensemble {
namespace {

Manifest smallManifest() {
  Manifest manifest;
  manifest.body = {"template.glb",
                   std::string(64, 'a'),
                   std::string(64, 'b'),
                   10,
                   12,
                   3,
                   {{"head", 4}, {"legs", 6}},
                   {{"walk", 1.1f, 34, 1.073f}}};
  manifest.outfits.push_back({"casual",
                              "outfits/casual.0123456789ab.glb",
                              std::string(64, 'c'),
                              Slot::kFull,
                              0,
                              {{"garment.shirt", 20}},
                              {{"head", Visibility::kFull, 4, 4}, {"legs", Visibility::kPartial, 6, 2}}});
  return manifest;
}

/// The manifest's text with one part replaced.
std::string edited(const std::string& from, const std::string& to) {
  std::string text = writeManifest(smallManifest());
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

constexpr const char* kMend = "make the wardrobe again with `ensemble tag`";

TEST(Manifest, SurvivesWritingAndReading) {
  const std::string text = writeManifest(smallManifest());
  EXPECT_EQ(writeManifest(parseManifest(text, "wardrobe.json")), text);
  EXPECT_NE(text.find("\"ground_speed\": 1.073\n"), std::string::npos) << text;
}

TEST(Manifest, RefusesAnotherVersionByName) {
  EXPECT_INPUT_ERROR(
      parseManifest(edited("ensemble.wardrobe/1", "ensemble.wardrobe/9"), "wardrobe.json"),
      "wardrobe.json: /schema: schema \"ensemble.wardrobe/9\" is not \"ensemble.wardrobe/1\"; make the "
      "wardrobe again with this version's `ensemble tag`");
  EXPECT_INPUT_ERROR(parseManifest("[]", "wardrobe.json"),
                     "wardrobe.json: /schema: this is not a wardrobe manifest; expected \"schema\": "
                     "\"ensemble.wardrobe/1\"");
}

TEST(Manifest, RefusesMalformedText) {
  const auto refused = [](const std::string& text, const std::string& message) {
    EXPECT_INPUT_ERROR(parseManifest(text, "wardrobe.json"), "wardrobe.json: " + message + "; " + kMend);
  };
  refused("", "1:1: the JSON is malformed");
  refused("{\n  \"a\": tru\n}", "2:11: the JSON is malformed");
  refused("{\"a\": 1e999}", "the JSON has a number that is out of range");
  refused(std::string(100000, '['), "byte 16: the JSON is nested more than 16 deep");
}

TEST(Manifest, ChecksItsSchemaAndTellsWhere) {
  const auto where = [](const std::string& text) {
    try {
      parseManifest(text, "wardrobe.json");
    } catch (const InputError& error) {
      EXPECT_EQ(error.text().mend, kMend);
      return error.text().where;
    }
    return std::string("accepted");
  };
  EXPECT_EQ(where(edited("\"faces\": 10", "\"faces\": -1")), "/template/faces");
  EXPECT_EQ(where(edited("\"faces\": 10", "\"faces\": 1.5")), "/template/faces");
  EXPECT_EQ(where(edited("\"sha256\": \"cc", "\"sha256\": \"xx")), "/outfits/0/sha256");
  EXPECT_EQ(where(edited("\"partial\"", "\"some\"")), "/outfits/0/regions/1/visibility");
  EXPECT_EQ(where(edited("\"layer\": 0", "\"layer\": \"top\"")), "/outfits/0/layer");
  EXPECT_EQ(where(edited("\"slot\"", "\"slots\"")), "/outfits/0");
  EXPECT_INPUT_ERROR(
      parseManifest(edited("\"slot\": \"full\"", "\"slot\": \"top\""), "wardrobe.json"),
      "wardrobe.json: /outfits/0/slot: 'top' is no slot: not hair, head, upper, lower, full, feet "
      "or over; make the wardrobe again with `ensemble tag`");
}

TEST(Manifest, RefusesFilesOutsideTheFolder) {
  for (const char* path : {"../casual.glb", "/etc/passwd", "outfits/../../x.glb", "outfits\\\\x.glb"}) {
    try {
      parseManifest(edited("outfits/casual.0123456789ab.glb", path), "wardrobe.json");
      ADD_FAILURE() << path;
    } catch (const InputError& error) {
      EXPECT_EQ(error.text().where, "/outfits/0/file");
      EXPECT_NE(error.text().what.find("is not in the wardrobe's folder"), std::string::npos);
    }
  }
}

TEST(Manifest, RefusesNamesThatStandTwice) {
  Manifest manifest = smallManifest();
  manifest.outfits.push_back(manifest.outfits.front());
  EXPECT_INPUT_ERROR(parseManifest(writeManifest(manifest), "wardrobe.json"),
                     std::string("wardrobe.json: /outfits/1/name: name 'casual' stands twice; ") + kMend);
}

TEST(ItemNames, CanStandInFileNamesAndScenes) {
  EXPECT_TRUE(isValidItemName("casual 01 (blue)"));
  EXPECT_TRUE(isValidItemName("robe-à-la-française"));
  for (const char* bad : {"", ".hidden", "a/b", "a\\b", "a\nb"}) EXPECT_FALSE(isValidItemName(bad)) << bad;
  EXPECT_FALSE(isValidItemName(std::string(101, 'a')));
}

}  // namespace
}  // namespace ensemble
