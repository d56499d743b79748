// The scene's keys, one function per map of the file. docs/scene.md is their reference.
#include "core/scene.h"

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "core/input_error.h"
#include "core/nearest_name.h"
#include "core/yaml_reader.h"

namespace ensemble {
namespace {

constexpr std::uint64_t kVersion = 1;
constexpr std::uint64_t kMaxCrowd = 2'000'000;
constexpr std::uint64_t kMaxFrames = 1'000'000;

constexpr NumberRange kPositionRange{-1e6, 1e6, false, false, "metres"};
constexpr NumberRange kDirectionRange{-1e6, 1e6};
constexpr NumberRange kHeadingRange{-360.0, 360.0, false, false, "degrees"};
constexpr NumberRange kHeadingSpreadRange{0.0, 180.0, false, false, "degrees"};
constexpr NumberRange kFovRange{0.0, 180.0, true, true, "degrees"};
constexpr NumberRange kNearRange{1e-4, 1000.0, false, false, "metres"};
constexpr NumberRange kSpacingRange{0.01, 1000.0, false, false, "metres"};
constexpr NumberRange kJitterRange{0.0, 0.45, false, false, "share of the spacing"};
constexpr NumberRange kFpsRange{0.0, 1000.0, true, false, "frames a second"};
constexpr NumberRange kWeightRange{0.0, 1e6};
constexpr NumberRange kScaleRange{0.01, 100.0};
constexpr NumberRange kSpeedRange{0.0, 100.0};
constexpr NumberRange kShareRange{0.0, 1.0};

float headingRadians(const YamlValue& value) { return radians(value.numberFloat(kHeadingRange)); }

Marked<std::string> readName(const YamlValue& value, const char* what) {
  return {value.text(what), value.mark()};
}

void readVersion(const YamlValue& root) {
  const std::optional<YamlValue> version = root.find("version");
  if (!version) root.fail("the scene has no version", "add 'version: 1'");
  if (!version->isWord("1")) {
    version->fail(version->description() + fmt::format(", but this program reads version {}", kVersion),
                  "write 'version: 1', or use the program the scene was made for");
  }
}

void checkWardrobeKey(const YamlValue& value) {
  const std::string key = value.key();
  if (key.find('/') == std::string::npos) return;
  value.fail(fmt::format("the wardrobe key {} has a '/'", quotedName(key)),
             "name it without one: KEY/NAME means an outfit");
}

SceneWardrobe readWardrobe(const YamlValue& value, const std::filesystem::path& base, std::string key) {
  return {std::move(key), base / value.text("a wardrobe folder"), value.mark()};
}

void readWardrobes(const YamlValue& root, Scene& scene) {
  const std::filesystem::path base = scene.file.parent_path();
  const std::optional<YamlValue> value = root.find("wardrobe");
  if (!value) root.fail("the scene has no wardrobe", "add 'wardrobe: FOLDER'");
  if (!value->isMap()) {
    if (!value->isScalar()) value->fail(value->description(), "give a wardrobe folder, or a map of them");
    scene.wardrobes.push_back(readWardrobe(*value, base, ""));
    return;
  }
  for (const YamlValue& member : value->members("a map of wardrobe folders")) {
    checkWardrobeKey(member);
    scene.wardrobes.push_back(readWardrobe(member, base, member.key()));
  }
  if (scene.wardrobes.empty()) value->fail("wardrobe is an empty map", "give at least one 'KEY: FOLDER'");
}

void readBackground(const YamlValue& value, SceneOutput& output) {
  if (value.isSequence()) {
    output.background = BackgroundKind::kColor;
    output.background_color = value.vector(kShareRange);
  } else if (value.isWord("sky")) {
    output.background = BackgroundKind::kSky;
  } else if (value.isWord("transparent")) {
    output.background = BackgroundKind::kTransparent;
  } else {
    value.fail(value.description(), "give sky, transparent or a colour [r, g, b], each from 0 to 1");
  }
}

void readOutput(const YamlValue& value, SceneOutput& output) {
  value.expectKeys({"width", "height", "samples", "frames", "fps", "background"});
  const auto size = [](const YamlValue& v) { return static_cast<std::uint32_t>(v.wholeNumber(1, 16384)); };
  if (const auto width = value.find("width")) output.width = size(*width);
  if (const auto height = value.find("height")) output.height = size(*height);
  if (const auto samples = value.find("samples")) {
    if (!samples->isWord("1") && !samples->isWord("4")) samples->fail(samples->description(), "give 1 or 4");
    output.samples = samples->isWord("1") ? 1 : 4;
  }
  if (const auto frames = value.find("frames")) {
    output.frames = static_cast<std::uint32_t>(frames->wholeNumber(1, kMaxFrames));
  }
  if (const auto fps = value.find("fps")) output.fps = fps->numberFloat(kFpsRange);
  if (const auto background = value.find("background")) readBackground(*background, output);
}

std::vector<WeightedName> readWeights(const YamlValue& value) {
  std::vector<WeightedName> weights;
  float sum = 0.0f;
  for (const YamlValue& member : value.members("a map of names and weights")) {
    weights.push_back({member.key(), member.numberFloat(kWeightRange), member.mark()});
    sum += weights.back().weight;
  }
  if (weights.empty()) {
    value.fail(value.path() + " is an empty map", "give at least one 'NAME: WEIGHT', or remove the key");
  }
  if (sum <= 0.0f) value.fail("every weight in " + value.path() + " is 0", "give at least one above 0");
  return weights;
}

std::array<float, 2> readScaleRange(const YamlValue& value) {
  if (!value.isSequence()) {
    const float scale = value.numberFloat(kScaleRange);
    return {scale, scale};
  }
  const std::vector<YamlValue> ends = value.items("");
  if (ends.size() != 2) {
    value.fail(fmt::format("{} is a list of {}", value.path(), ends.size()),
               "give [least, most] or one number");
  }
  const std::array<float, 2> range{ends[0].numberFloat(kScaleRange), ends[1].numberFloat(kScaleRange)};
  if (range[0] > range[1]) {
    value.fail(fmt::format("{} begins with the greater number", value.path()), "give [least, most]");
  }
  return range;
}

PlacementKind readPlacementKind(const YamlValue& value) {
  if (value.isWord("paths") || value.isWord("file")) {
    value.fail(fmt::format("the placement {} is not supported by this version yet", value.text("")),
               "give 'grid', 'disc' or 'formation'");
  }
  constexpr PlacementKind kKinds[] = {PlacementKind::kGrid, PlacementKind::kDisc, PlacementKind::kFormation};
  return kKinds[value.word({"grid", "disc", "formation"})];
}

void readPlacement(const YamlValue& value, ScenePlacement& placement) {
  value.expectKeys({"kind", "spacing", "center", "heading", "heading_spread", "jitter", "columns"},
                   {"paths", "file"});
  if (const auto kind = value.find("kind")) placement.kind = readPlacementKind(*kind);
  if (const auto spacing = value.find("spacing")) placement.spacing = spacing->numberFloat(kSpacingRange);
  if (const auto center = value.find("center")) placement.center = center->vector(kPositionRange);
  if (const auto heading = value.find("heading")) placement.heading = headingRadians(*heading);
  if (const auto spread = value.find("heading_spread")) {
    placement.heading_spread = radians(spread->numberFloat(kHeadingSpreadRange));
    if (!placement.heading && placement.kind != PlacementKind::kFormation) {
      spread->fail("heading_spread without heading, where headings are random", "add a heading");
    }
  }
  const auto jitter = value.find("jitter");
  if (jitter) placement.jitter = jitter->numberFloat(kJitterRange);
  const auto columns = value.find("columns");
  if (columns) placement.columns = static_cast<std::uint32_t>(columns->wholeNumber(0, kMaxCrowd));
  for (const auto& option : {jitter, columns}) {
    if (!option || placement.kind != PlacementKind::kDisc) continue;
    option->fail(fmt::format("{} means nothing for a disc", option->path()),
                 "remove it, or give 'kind: grid' or 'kind: formation'");
  }
}

void readCrowd(const YamlValue& value, SceneCrowd& crowd) {
  value.expectKeys({"count", "seed", "wardrobes", "placement", "outfits", "clips", "scale"});
  if (const auto count = value.find("count")) {
    crowd.count = static_cast<std::uint32_t>(count->wholeNumber(0, kMaxCrowd));
  } else {
    value.fail("the crowd has no count", "add 'count: 1000'");
  }
  if (const auto seed = value.find("seed")) crowd.seed = seed->wholeNumber(0, UINT64_MAX);
  if (const auto wardrobes = value.find("wardrobes")) crowd.wardrobes = readWeights(*wardrobes);
  if (const auto placement = value.find("placement")) readPlacement(*placement, crowd.placement);
  if (const auto outfits = value.find("outfits")) crowd.outfits = readWeights(*outfits);
  if (const auto clips = value.find("clips")) crowd.clips = readWeights(*clips);
  if (const auto scale = value.find("scale")) crowd.scale = readScaleRange(*scale);
}

ScenePerson readPerson(const YamlValue& value) {
  value.expectKeys({"wardrobe", "outfit", "clip", "phase", "speed", "position", "heading", "scale", "tint"});
  ScenePerson person;
  person.mark = value.mark();
  if (const auto wardrobe = value.find("wardrobe")) {
    person.wardrobe = readName(*wardrobe, "the key of a wardrobe");
  }
  if (const auto outfit = value.find("outfit")) person.outfit = readName(*outfit, "an outfit's name");
  if (const auto clip = value.find("clip")) person.clip = readName(*clip, "a clip's name");
  if (const auto phase = value.find("phase")) person.phase = phase->numberFloat(kShareRange);
  if (const auto speed = value.find("speed")) person.speed = speed->numberFloat(kSpeedRange);
  if (const auto position = value.find("position")) person.position = position->vector(kPositionRange);
  if (const auto heading = value.find("heading")) person.heading = headingRadians(*heading);
  if (const auto scale = value.find("scale")) person.scale = scale->numberFloat(kScaleRange);
  if (const auto tint = value.find("tint")) {
    person.tint = static_cast<std::uint32_t>(tint->wholeNumber(0, UINT32_MAX));
  }
  return person;
}

void readCamera(const YamlValue& value, SceneCamera& camera) {
  value.expectKeys({"position", "target", "fov_y", "near"}, {"keys"});
  const auto position = value.find("position");
  if (position) camera.position = position->vector(kPositionRange);
  const auto target = value.find("target");
  if (target) camera.target = target->vector(kPositionRange);
  if (const auto fov = value.find("fov_y")) camera.fov_y = radians(fov->numberFloat(kFovRange));
  if (const auto near_plane = value.find("near")) camera.near_plane = near_plane->numberFloat(kNearRange);
  if (glm::distance(camera.position, camera.target) < 1e-4f) {
    (target     ? *target
     : position ? *position
                : value)
        .fail("the camera's target is where the camera stands", "move one of them");
  }
}

void readLight(const YamlValue& value, SceneLight& light) {
  value.expectKeys({"direction", "shadows"});
  if (const auto direction = value.find("direction")) {
    light.direction = direction->vector(kDirectionRange);
    if (glm::length(light.direction) < 1e-6f) {
      direction->fail("light.direction has no length", "give the way the light travels, such as [0, -1, 0]");
    }
  }
  if (const auto shadows = value.find("shadows")) light.shadows = shadows->boolean();
}

void readScene(const YamlValue& root, Scene& scene) {
  if (root.kind() == YamlKind::kNull) root.fail("the scene is empty", "begin with 'version: 1'");
  root.expectKeys(
      {"version", "wardrobe", "technique", "output", "crowd", "people", "camera", "light", "ground"},
      {"environment"});
  readVersion(root);
  readWardrobes(root, scene);
  if (const auto technique = root.find("technique")) {
    scene.technique = kAllTechniques[technique->word({"naive", "prefitted", "tagged"})];
  }
  if (const auto output = root.find("output")) readOutput(*output, scene.output);
  if (const auto crowd = root.find("crowd")) readCrowd(*crowd, scene.crowd);
  if (const auto people = root.find("people")) {
    for (const YamlValue& person : people->items("a list of people")) {
      scene.people.push_back(readPerson(person));
    }
  }
  if (const auto camera = root.find("camera")) readCamera(*camera, scene.camera);
  if (const auto light = root.find("light")) readLight(*light, scene.light);
  if (const auto ground = root.find("ground")) scene.ground = ground->boolean();
}

}  // namespace

SceneOverride parseSceneOverride(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError({"", "--set " + text, "there is no KEY=VALUE", "write --set crowd.count=100"});
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

Scene parseScene(const std::string& text, const std::filesystem::path& file,
                 std::span<const SceneOverride> overrides) {
  YamlDocument document = YamlDocument::parse(text, file);
  for (const auto& [key_path, value] : overrides) document.set(key_path, value);
  Scene scene;
  scene.file = file;
  readScene(document.root(), scene);
  return scene;
}

Scene loadScene(const std::filesystem::path& file, std::span<const SceneOverride> overrides) {
  const std::vector<std::byte> bytes = readFile(file, YamlLimits().max_bytes);
  return parseScene(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), file, overrides);
}

}  // namespace ensemble
