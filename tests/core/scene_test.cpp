#include "core/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "core/input_error.h"
#include "tests/core/scene_fixture.h"

namespace ensemble {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using testing::errorAfterHead;
using testing::errorOf;
using testing::kHead;
using testing::kSceneFile;
using testing::parse;

TEST(Scene, HasDefaults) {
  const Scene scene = parse(kHead);
  ASSERT_EQ(scene.wardrobes.size(), 1u);
  EXPECT_EQ(scene.wardrobes[0].key, "");
  EXPECT_EQ(scene.wardrobes[0].folder, "scenes/w");
  EXPECT_EQ(scene.wardrobes[0].mark.toString(), "2:11");
  EXPECT_EQ(scene.technique, Technique::kTagged);
  EXPECT_EQ(scene.output.width, 1280u);
  EXPECT_EQ(scene.output.samples, 4u);
  EXPECT_EQ(scene.output.frames, 1u);
  EXPECT_EQ(scene.crowd.count, 0u);
  EXPECT_TRUE(scene.people.empty());
  EXPECT_EQ(scene.camera.position, Vec3(0, 1.7f, 12));
  EXPECT_TRUE(scene.light.shadows);
  EXPECT_TRUE(scene.ground);
}

TEST(Scene, ReadsEveryKey) {
  const Scene scene = parse(R"(
version: 1
wardrobe: {women: ../w, men: /abs/m}
technique: naive
output: {width: 16384, height: 1, samples: 1, frames: 60, fps: 24.5, background: [0.25, 0, 1]}
crowd:
  count: 2000000
  seed: 18446744073709551615
  wardrobes: {women: 1, men: 2.5}
  placement: {kind: formation, spacing: .5, center: [1, -2, 3e1], heading: 90, heading_spread: 18, jitter: 0.45, columns: 7}
  outfits: {casual01: 2, men/sport01: 0}
  clips: {walk: 0.9, idle: 0.1}
  scale: [0.5, 2]
people:
  - {wardrobe: women, outfit: casual01, clip: walk, phase: 0.25, speed: 0, position: [1, 2, 3], heading: -90, scale: 1.5, tint: 4294967295}
  - {}
camera: {position: [1, 2, 3], target: [4, 5, 6], fov_y: 90, near: 1}
light: {direction: [0, -2, 0], shadows: false}
ground: false
)");
  EXPECT_EQ(scene.technique, Technique::kNaive);
  ASSERT_EQ(scene.wardrobes.size(), 2u);
  EXPECT_EQ(scene.wardrobes[0].key, "women");
  EXPECT_EQ(scene.wardrobes[0].folder, "scenes/../w");
  EXPECT_EQ(scene.wardrobes[1].folder, "/abs/m");
  EXPECT_EQ(scene.output.width, 16384u);
  EXPECT_EQ(scene.output.height, 1u);
  EXPECT_EQ(scene.output.samples, 1u);
  EXPECT_EQ(scene.output.frames, 60u);
  EXPECT_EQ(scene.output.fps, 24.5f);
  EXPECT_EQ(scene.output.background, BackgroundKind::kColor);
  EXPECT_EQ(scene.output.background_color, Vec3(0.25f, 0, 1));
  EXPECT_EQ(scene.crowd.count, 2'000'000u);
  EXPECT_EQ(scene.crowd.seed, UINT64_MAX);
  ASSERT_EQ(scene.crowd.wardrobes.size(), 2u);
  EXPECT_EQ(scene.crowd.wardrobes[1].name, "men");
  EXPECT_EQ(scene.crowd.wardrobes[1].weight, 2.5f);
  const ScenePlacement& placement = scene.crowd.placement;
  EXPECT_EQ(placement.kind, PlacementKind::kFormation);
  EXPECT_EQ(placement.spacing, 0.5f);
  EXPECT_EQ(placement.center, Vec3(1, -2, 30));
  EXPECT_EQ(placement.heading, radians(90.0f));
  EXPECT_EQ(placement.heading_spread, radians(18.0f));
  EXPECT_EQ(placement.jitter, 0.45f);
  EXPECT_EQ(placement.columns, 7u);
  ASSERT_EQ(scene.crowd.outfits.size(), 2u);
  EXPECT_EQ(scene.crowd.outfits[1].name, "men/sport01");
  EXPECT_EQ(scene.crowd.outfits[1].mark.toString(), "11:39");
  EXPECT_EQ(scene.crowd.outfits[1].mark.key_path, "crowd.outfits.men/sport01");
  ASSERT_EQ(scene.crowd.clips.size(), 2u);
  EXPECT_THAT(scene.crowd.scale, ElementsAre(0.5f, 2.0f));
  ASSERT_EQ(scene.people.size(), 2u);
  const ScenePerson& person = scene.people[0];
  EXPECT_EQ(person.wardrobe.value, "women");
  EXPECT_EQ(person.outfit.value, "casual01");
  EXPECT_EQ(person.outfit.mark.toString(), "15:31");
  EXPECT_EQ(person.clip.value, "walk");
  EXPECT_EQ(person.phase, 0.25f);
  EXPECT_EQ(person.speed, 0.0f);
  EXPECT_EQ(person.position, Vec3(1, 2, 3));
  EXPECT_EQ(person.heading, radians(-90.0f));
  EXPECT_EQ(person.scale, 1.5f);
  EXPECT_EQ(person.tint, UINT32_MAX);
  EXPECT_FALSE(scene.people[1].tint.has_value());
  EXPECT_EQ(scene.people[1].mark.toString(), "16:5");
  EXPECT_EQ(scene.camera.target, Vec3(4, 5, 6));
  EXPECT_EQ(scene.camera.fov_y, radians(90.0f));
  EXPECT_EQ(scene.camera.near_plane, 1.0f);
  EXPECT_EQ(scene.light.direction, Vec3(0, -2, 0));
  EXPECT_FALSE(scene.light.shadows);
  EXPECT_FALSE(scene.ground);
}

TEST(Scene, WordsMayStandInQuotes) {
  const Scene scene = parse(kHead + "technique: \"naive\"\noutput: {background: \"transparent\"}\n");
  EXPECT_EQ(scene.technique, Technique::kNaive);
  EXPECT_EQ(scene.output.background, BackgroundKind::kTransparent);
}

TEST(Scene, TakesOneNumberForScaleAndWordsForTheBackground) {
  const Scene scene = parse(kHead + "crowd: {count: 1, scale: 1.1}\noutput: {background: transparent}\n");
  EXPECT_THAT(scene.crowd.scale, ElementsAre(1.1f, 1.1f));
  EXPECT_EQ(scene.output.background, BackgroundKind::kTransparent);
  EXPECT_EQ(parse(kHead + "output: {background: sky}\n").output.background, BackgroundKind::kSky);
}

TEST(SceneErrors, WhatMustBeThere) {
  EXPECT_EQ(errorOf(""), "input: scenes/a.yaml: the scene is empty; begin with 'version: 1'");
  EXPECT_EQ(errorOf("# nothing\n"), "input: scenes/a.yaml: the scene is empty; begin with 'version: 1'");
  EXPECT_EQ(errorOf("wardrobe: w\n"),
            "input: scenes/a.yaml: 1:1: the scene has no version; add 'version: 1'");
  EXPECT_EQ(errorOf("version: 1\n"),
            "input: scenes/a.yaml: 1:1: the scene has no wardrobe; add 'wardrobe: FOLDER'");
  EXPECT_EQ(errorOf("version: 2\nwardrobe: w\n"),
            "input: scenes/a.yaml: 1:10: version is '2', but this program reads version 1; write "
            "'version: 1', or use the program the scene was made for");
  EXPECT_EQ(errorAfterHead("crowd: {seed: 1}\n"), "3:8: the crowd has no count; add 'count: 1000'");
  EXPECT_EQ(errorAfterHead("crowd:\n"), "3:1: crowd has no value; give one, or remove the key");
  EXPECT_EQ(errorOf("version: 1\nwardrobe: {}\n"),
            "input: scenes/a.yaml: 2:11: wardrobe is an empty map; give at least one 'KEY: FOLDER'");
  EXPECT_EQ(errorOf("version: 1\nwardrobe: {a/b: w}\n"),
            "input: scenes/a.yaml: 2:17: the wardrobe key 'a/b' has a '/'; name it without one: KEY/NAME "
            "means an outfit");
  EXPECT_EQ(errorOf("version: 1\nwardrobe: [w]\n"),
            "input: scenes/a.yaml: 2:11: wardrobe is a list; give a wardrobe folder, or a map of them");
  EXPECT_EQ(errorOf("just text"),
            "input: scenes/a.yaml: 1:1: the file is 'just text'; give a map of the keys version, wardrobe, "
            "technique, output, raster, culling, occlusion, debug, poses, environment, crowd, people, "
            "camera, light, ground");
}

TEST(SceneErrors, UnknownKeysNameTheNearest) {
  EXPECT_EQ(errorAfterHead("outptu: {}\n"),
            "3:1: unknown key 'outptu'; write 'output' (known: version, wardrobe, technique, output, "
            "raster, culling, occlusion, debug, poses, environment, crowd, people, camera, light, ground)");
  EXPECT_EQ(errorAfterHead("output:\n  widht: 3\n"),
            "4:3: unknown key 'widht' in output; write 'width' (known: width, height, samples, frames, fps, "
            "background)");
  EXPECT_EQ(errorAfterHead("people:\n  - {cloth: a}\n"),
            "4:6: unknown key 'cloth' in people.0; write 'clip' (known: wardrobe, outfit, wears, clip, "
            "phase, speed, "
            "position, heading, scale, tint)");
  EXPECT_EQ(errorAfterHead("technique: taged\n"),
            "3:12: technique is 'taged'; give 'naive', 'prefitted' or 'tagged'; the nearest is 'tagged'");
}

TEST(Scene, DebugTellsHowAPictureWasDrawn) {
  EXPECT_EQ(parse(kHead).debug, DebugKind::kNone);
  EXPECT_EQ(parse(kHead + "debug: none\n").debug, DebugKind::kNone);
  EXPECT_EQ(parse(kHead + "debug: rasteriser\n").debug, DebugKind::kRasteriser);
  EXPECT_EQ(parse(kHead + "debug: pose\n").debug, DebugKind::kPose);
  EXPECT_EQ(parse(kHead + "debug: overdraw\n").debug, DebugKind::kOverdraw);
  const SceneOverride override("debug", "pose");
  EXPECT_EQ(parseScene(kHead, "scenes/a.yaml", std::span(&override, 1)).debug, DebugKind::kPose);
  EXPECT_EQ(errorAfterHead("debug: poses\n"),
            "3:8: debug is 'poses'; give 'none', 'rasteriser', 'pose' or 'overdraw'; the nearest is 'pose'");
}

TEST(Scene, RasterisersHaveNames) {
  for (const RasterKind kind : kAllRasterKinds) EXPECT_EQ(parseRasterKind(toString(kind)), kind);
  EXPECT_EQ(parseRasterKind("gpu"), std::nullopt);
  EXPECT_EQ(parse(kHead + "raster: compute\n").raster, RasterKind::kCompute);
}

TEST(Scene, CullingIsTheHostsOrTheDevices) {
  EXPECT_FALSE(parse(kHead).occlusion);
  EXPECT_TRUE(parse(kHead + "occlusion: true\n").occlusion);
  EXPECT_EQ(parse(kHead).culling, CullingKind::kAuto);
  EXPECT_EQ(parse(kHead + "culling: auto\n").culling, CullingKind::kAuto);
  EXPECT_EQ(parse(kHead + "culling: host\n").culling, CullingKind::kHost);
  EXPECT_EQ(parse(kHead, {{"culling", "device"}}).culling, CullingKind::kDevice);
  EXPECT_EQ(errorAfterHead("culling: gpu\n"),
            "3:10: culling is 'gpu'; give 'auto', 'host' or 'device'; the nearest is 'auto'");
}

TEST(Scene, AnEnvironmentTakesThePlaceOfTheGround) {
  const Scene scene = parse(kHead + "environment: sets/street.glb\n");
  EXPECT_EQ(scene.environment.value, "scenes/sets/street.glb");
  EXPECT_EQ(scene.environment.mark.toString(), "3:14");
  EXPECT_FALSE(scene.ground);
  EXPECT_TRUE(parse(kHead + "ground: true\nenvironment: street.glb\n").ground);
  EXPECT_TRUE(parse(kHead).environment.value.empty());
  const Scene set = parse(kHead, {{"environment", "/abs/a.glb"}});
  EXPECT_EQ(set.environment.value, "/abs/a.glb");
  EXPECT_EQ(set.environment.mark.toString(), "environment");
  EXPECT_EQ(errorAfterHead("environment: [a.glb]\n"), "3:14: environment is a list; give a glTF file");
  EXPECT_EQ(errorAfterHead("environment: ''\n"), "3:14: environment is the text ''; give a glTF file");
  EXPECT_EQ(errorAfterHead("environment:\n"), "3:1: environment has no value; give one, or remove the key");
}

TEST(SceneErrors, NumbersAreStrict) {
  const std::string mend = "; give a whole number from 0 to 2000000";
  for (const char* bad : {"010", "0x10", "1.5", "1e3", "-1", "2000001", "many", "1_000",
                          "18446744073709551616", "+5", ".inf"}) {
    EXPECT_EQ(errorAfterHead(std::string("crowd: {count: ") + bad + "}\n"),
              std::string("3:16: crowd.count is '") + bad + "'" + mend);
  }
  EXPECT_EQ(errorAfterHead("crowd: {count: '5'}\n"), "3:16: crowd.count is the text '5'" + mend);
  EXPECT_EQ(errorAfterHead("crowd: {count: [5]}\n"), "3:16: crowd.count is a list" + mend);
  EXPECT_EQ(errorAfterHead("crowd: {count: ~}\n"),
            "3:9: crowd.count has no value; give one, or remove the key");
  for (const char* bad : {"1e999", ".nan", "nan", "inf", "010.5", "0x1p3", "1.5m", "-", ".", "1e", "0"}) {
    EXPECT_EQ(errorAfterHead(std::string("output: {fps: ") + bad + "}\n"),
              std::string("3:15: output.fps is '") + bad +
                  "'; give a number greater than 0 and at most 1000 (frames a second)");
  }
  for (const char* good : {"1", "1.", ".5", "+2.5", "1e2", "1.5E+1", "100e-2"}) {
    EXPECT_EQ(errorAfterHead(std::string("output: {fps: ") + good + "}\n"), "no error") << good;
  }
}

TEST(SceneErrors, RangesAreNamed) {
  EXPECT_EQ(errorAfterHead("output: {width: 0}\n"),
            "3:17: output.width is '0'; give a whole number from 1 to 16384");
  EXPECT_EQ(errorAfterHead("output: {height: 16385}\n"),
            "3:18: output.height is '16385'; give a whole number from 1 to 16384");
  EXPECT_EQ(errorAfterHead("output: {samples: 2}\n"), "3:19: output.samples is '2'; give 1 or 4");
  EXPECT_EQ(
      errorAfterHead("output: {background: blue}\n"),
      "3:22: output.background is 'blue'; give sky, transparent or a colour [r, g, b], each from 0 to 1");
  EXPECT_EQ(errorAfterHead("output: {background: [0, 1, 255]}\n"),
            "3:29: output.background.2 is '255'; give a number from 0 to 1");
  EXPECT_EQ(errorAfterHead("camera: {fov_y: 180}\n"),
            "3:17: camera.fov_y is '180'; give a number greater than 0 and less than 180 (degrees)");
  EXPECT_EQ(
      errorAfterHead("camera: {fov_y: 179.999999999}\n"),
      "3:17: camera.fov_y is '179.999999999'; give a number greater than 0 and less than 180 (degrees)");
  EXPECT_EQ(errorAfterHead("camera: {fov_y: 0}\n"),
            "3:17: camera.fov_y is '0'; give a number greater than 0 and less than 180 (degrees)");
  EXPECT_EQ(errorAfterHead("camera: {position: [1, 2]}\n"),
            "3:20: camera.position is a list of 2; give [x, y, z], each a number from -1000000 to 1000000 "
            "(metres)");
  EXPECT_EQ(errorAfterHead("light: {shadows: yes}\n"), "3:18: light.shadows is 'yes'; give true or false");
  EXPECT_EQ(errorAfterHead("ground: 1\n"), "3:9: ground is '1'; give true or false");
  EXPECT_EQ(errorAfterHead("people: {a: 1}\n"), "3:9: people is a map; give a list of people");
  EXPECT_EQ(errorAfterHead("people: [{outfit: [a, b]}]\n"),
            "3:19: people.0.outfit is a list; give an outfit's name");
  EXPECT_EQ(errorAfterHead("people: [{outfit: ''}]\n"),
            "3:19: people.0.outfit is the text ''; give an outfit's name");
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, scale: [2, 1]}\n"),
            "3:26: crowd.scale begins with the greater number; give [least, most]");
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, scale: [2]}\n"),
            "3:26: crowd.scale is a list of 1; give [least, most] or one number");
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, scale: 0}\n"),
            "3:26: crowd.scale is '0'; give a number from 0.01 to 100");
  EXPECT_EQ(errorAfterHead("output: 5\n"),
            "3:9: output is '5'; give a map of the keys width, height, samples, frames, fps, background");
}

TEST(SceneErrors, ValuesThatMakeNoSense) {
  EXPECT_EQ(errorAfterHead("camera: {position: [1, 1, 1], target: [1, 1, 1]}\n"),
            "3:39: the camera's target is where the camera stands; move one of them");
  EXPECT_EQ(errorAfterHead("camera: {position: [0, 1, 0]}\n"),
            "3:20: the camera's target is where the camera stands; move one of them");
  EXPECT_EQ(errorAfterHead("light: {direction: [0, 0, 0]}\n"),
            "3:20: light.direction has no length; give the way the light travels, such as [0, -1, 0]");
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, outfits: {a: 0, b: 0}}\n"),
            "3:28: every weight in crowd.outfits is 0; give at least one above 0");
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, clips: {}}\n"),
            "3:26: crowd.clips is an empty map; give at least one 'NAME: WEIGHT', or remove the key");
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, clips: [walk]}\n"),
            "3:26: crowd.clips is a list; give a map of names and weights");
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, clips: {walk: -1}}\n"),
            "3:33: crowd.clips.walk is '-1'; give a number from 0 to 1000000");
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, placement: {kind: disc, jitter: 0.1}}\n"),
            "3:51: crowd.placement.jitter means nothing for 'kind: disc'; remove it, or give 'kind: grid'");
  EXPECT_EQ(errorAfterHead("crowd: {count: 1, placement: {heading_spread: 5}}\n"),
            "3:47: heading_spread without heading, where headings are random; add a heading");
}

TEST(SceneErrors, YamlThatIsRefused) {
  EXPECT_EQ(errorAfterHead("light: {shadows: true}\nlight: {shadows: false}\n"),
            "4:1: the key 'light' is here a second time (first at 3:1); remove one of them");
  EXPECT_EQ(errorAfterHead("output: &a {}\n"),
            "3:9: anchors (&) and aliases (*) are not accepted; write the value out");
  EXPECT_EQ(errorAfterHead("people: &a [*a]\n"),
            "3:9: anchors (&) and aliases (*) are not accepted; write the value out");
  EXPECT_EQ(errorAfterHead("output: !!map {}\n"),
            "3:9: the tag 'tag:yaml.org,2002:map' is not accepted; remove it");
  EXPECT_EQ(errorAfterHead("---\nversion: 1\n"),
            "3:1: a second YAML document begins here; remove the line '---' and what follows it");
  EXPECT_EQ(errorAfterHead("? [a]\n: 1\n"), "3:3: a key must be a text; write 'key: value'");
  EXPECT_EQ(errorAfterHead("output: {width: 1\n"),
            "4:1: not valid YAML: end of map flow not found; look at the indentation, colons, quotes and "
            "brackets here");
  EXPECT_EQ(errorAfterHead(std::string("ground: true\x04\n")),
            "3:13: a control character (byte 4); save the file as plain UTF-8 text");
  EXPECT_EQ(errorAfterHead("people: [{outfit: \xc3\xa9\xff}]\n"),
            "3:20: byte 255 is not UTF-8 here; save the file as plain UTF-8 text");
  EXPECT_EQ(errorAfterHead("people: " + std::string(40, '[') + std::string(40, ']')),
            "3:40: lists and maps are nested more than 32 deep; nest them less");
  EXPECT_EQ(errorOf(std::string((4u << 20) + 1, ' ')),
            "input: scenes/a.yaml: the file has more than 4 MiB; keep data per person out of YAML");
  std::string many = kHead + "people: [";
  for (int i = 0; i < 500'000; ++i) many += "a,\n";
  EXPECT_THAT(errorOf(many + "]"), HasSubstr("more than 500000 values; keep data per person out of YAML"));
}

TEST(SceneErrors, NamesWithControlCharactersStayOnOneLine) {
  EXPECT_EQ(errorAfterHead("people: [{outfit: \"a\\nb\"}]\n"),
            "3:19: people.0.outfit is the text 'a?b'; give an outfit's name");
}

TEST(SceneOverrides, ReplaceAddAndReachIntoLists) {
  const std::string text = kHead + "people:\n  - {phase: 0.1}\n  - {phase: 0.2}\ncrowd: {count: 3}\n";
  const Scene scene = parse(text, {{"crowd.count", "5"},
                                   {"output.width", "64"},
                                   {"people.1.phase", "0.5"},
                                   {"camera.position", "[0, 2, 8]"},
                                   {"crowd.outfits", "{casual.01: 1}"},
                                   {"crowd.outfits.casual.01", "4"},
                                   {"wardrobe", "../other"},
                                   {"crowd.count", "6"}});
  EXPECT_EQ(scene.crowd.count, 6u);
  EXPECT_EQ(scene.output.width, 64u);
  EXPECT_EQ(scene.people[0].phase, 0.1f);
  EXPECT_EQ(scene.people[1].phase, 0.5f);
  EXPECT_EQ(scene.camera.position, Vec3(0, 2, 8));
  ASSERT_EQ(scene.crowd.outfits.size(), 1u);
  EXPECT_EQ(scene.crowd.outfits[0].weight, 4.0f);
  EXPECT_EQ(scene.crowd.outfits[0].mark.toString(), "crowd.outfits.casual.01");
  EXPECT_EQ(scene.wardrobes[0].folder, "scenes/../other");
}

TEST(SceneOverrides, SayWhatIsWrongWithThem) {
  const std::string text = kHead + "people: [{phase: 0.1}]\ntechnique: tagged\n";
  EXPECT_EQ(errorOf(text, {{"crowd.cuont", "5"}}),
            "usage: --set crowd.cuont=5: unknown key 'cuont' in crowd; write 'count' (known: count, seed, "
            "wardrobes, placement, outfits, wear, clips, scale)");
  EXPECT_EQ(errorOf(text, {{"output.width", "wide"}}),
            "usage: --set output.width=wide: output.width is 'wide'; give a whole number from 1 to 16384");
  EXPECT_EQ(errorOf(text, {{"output.width", ""}}),
            "usage: --set output.width=: output.width has no value; give one, or remove the key");
  EXPECT_EQ(
      errorOf(text, {{"people.1.phase", "0"}}),
      "usage: --set people.1.phase=0: people is a list, in which there is no '1'; give a number from 0 to "
      "0");
  EXPECT_EQ(errorOf(text, {{"people.x", "0"}}),
            "usage: --set people.x=0: people is a list, in which there is no 'x'; give a number from 0 to 0");
  EXPECT_EQ(errorOf(text, {{"technique.a", "0"}}),
            "usage: --set technique.a=0: technique is a single value, without keys; set it as a whole");
  EXPECT_EQ(errorOf(text, {{"output..width", "1"}}),
            "usage: --set output..width=1: a part of the key is empty; write --set KEY.KEY=VALUE");
  EXPECT_EQ(errorOf(text, {{"output", "{width: 1, width: 2}"}}),
            "usage: --set output={width: 1, width: 2}: the key 'width' is here a second time (first at 1:2); "
            "remove one of them");
  EXPECT_EQ(errorOf(text, {{"output", "{"}}).rfind("usage: --set output={: not valid YAML: ", 0), 0u);
}

TEST(SceneOverrides, AreSplitAtTheFirstEqualsSign) {
  EXPECT_EQ(parseSceneOverride("a.b=c=d"), (SceneOverride{"a.b", "c=d"}));
  EXPECT_EQ(parseSceneOverride("a="), (SceneOverride{"a", ""}));
  for (const char* bad : {"a", "=a", ""}) {
    try {
      parseSceneOverride(bad);
      FAIL() << bad;
    } catch (const UsageError& error) {
      EXPECT_EQ(error.what(),
                std::string("--set ") + bad + ": there is no KEY=VALUE; write --set crowd.count=100");
    }
  }
}

TEST(Scene, IsReadFromAFile) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / "ensemble_scene_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.yaml") << kHead << "ground: false\n";
  const std::vector<SceneOverride> overrides{{"crowd.count", "2"}};
  const Scene scene = loadScene(folder / "a.yaml", overrides);
  EXPECT_FALSE(scene.ground);
  EXPECT_EQ(scene.crowd.count, 2u);
  EXPECT_EQ(scene.wardrobes[0].folder, folder / "w");
  EXPECT_THROW(loadScene(folder / "missing.yaml"), InputError);
  std::filesystem::remove_all(folder);
}

/// docs/scene.md. Tests run in the project's root.
std::string sceneDocs() {
  std::ifstream stream("docs/scene.md");
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The keys that a map takes, from the message about an unknown one.
std::vector<std::string> knownKeys(const std::string& text, const std::string& map) {
  const std::string message = errorOf(text, {{map.empty() ? "zzz" : map + ".zzz", "1"}});
  const std::size_t begin = message.find("(known: "), end = message.rfind(')');
  std::vector<std::string> keys;
  if (begin == std::string::npos) return keys;
  std::stringstream list(message.substr(begin + 8, end - begin - 8));
  for (std::string key; std::getline(list, key, ',');) keys.push_back(key.substr(key.find_first_not_of(' ')));
  return keys;
}

TEST(ReferenceScene, HoldsEveryKeyAndTheDocsDescribeIt) {
  const std::string docs = sceneDocs(), text = referenceScene();
  const Scene scene = parse(text);
  EXPECT_EQ(scene.crowd.count, 60u);
  EXPECT_EQ(scene.people.size(), 1u);
  EXPECT_EQ(scene.camera.keys.size(), 2u);
  int key_count = 0;
  for (const std::string map :
       {"", "output", "poses", "crowd", "crowd.placement", "crowd.placement.paths.0",
        "crowd.placement.paths.0.stops.0", "people.0", "camera", "camera.keys.0", "light"}) {
    const std::vector<std::string> keys = knownKeys(text, map);
    ASSERT_FALSE(keys.empty()) << map;
    for (const std::string& key : keys) {
      std::string in_table = map.empty() ? key : map + "." + key;
      for (std::size_t at; (at = in_table.find(".0")) != std::string::npos;) in_table.erase(at, 2);
      ++key_count;
      EXPECT_TRUE(text.find(key + ":") != std::string::npos) << in_table << " is not in the reference scene";
      const bool is_map = in_table == "output" || in_table == "poses" || in_table == "crowd" ||
                          in_table == "people" || in_table == "camera" || in_table == "light" ||
                          in_table == "crowd.placement";
      if (is_map) continue;
      EXPECT_TRUE(docs.find("| `" + in_table + "` |") != std::string::npos)
          << in_table << " is not in docs/scene.md";
    }
  }
  EXPECT_EQ(key_count, 15 + 6 + 2 + 8 + 15 + 6 + 2 + 10 + 7 + 4 + 2);
}

TEST(ReferenceScene, ItsAlternativesAreScenesToo) {
  const std::string text = referenceScene();
  std::stringstream lines(text);
  int count = 0;
  for (std::string line; std::getline(lines, line);) {
    for (const std::string key : {"placement", "camera", "wardrobe"}) {
      const std::size_t at = line.find("# " + key + ": ");
      if (at == std::string::npos) continue;
      ++count;
      const std::string path = key == "placement" ? "crowd.placement" : key;
      EXPECT_NO_THROW(parseScene(text, "scene.yaml",
                                 std::vector<SceneOverride>{{path, line.substr(at + key.size() + 4)}}))
          << line;
    }
  }
  EXPECT_EQ(count, 7);
}

}  // namespace
}  // namespace ensemble
