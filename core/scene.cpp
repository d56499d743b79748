// The scene's keys, one function per map of the file. docs/scene.md is their reference.
#include "core/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "core/atomic_file.h"
#include "core/input_error.h"
#include "core/nearest_name.h"
#include "core/scene_keys.h"
#include "core/yaml_reader.h"
#include "embedded/kReferenceScene.h"

namespace ensemble {
namespace {

constexpr std::uint64_t kVersion = 1;
constexpr std::uint64_t kMaxFrames = 1'000'000;

constexpr NumberRange kDirectionRange{-1e6, 1e6};
constexpr NumberRange kFovRange{0.0, 180.0, true, true, "degrees"};
constexpr NumberRange kNearRange{1e-4, 1000.0, false, false, "metres"};
constexpr NumberRange kScaleRange{0.01, 100.0};
constexpr NumberRange kSpeedRange{0.0, 100.0};
constexpr NumberRange kShareRange{0.0, 1.0};
constexpr NumberRange kTimeRange{0.0, 1e6, false, false, "seconds"};
constexpr NumberRange kPixelRange{0.0, 1e6, false, false, "pixels"};
constexpr std::uint64_t kMostCache = 1u << 16;  // MiB
constexpr NumberRange kTurnRange{-1e5, 1e5, false, false, "seconds"};

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
  } else if (value.isText("sky")) {
    output.background = BackgroundKind::kSky;
  } else if (value.isText("transparent")) {
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

void readSlotWeights(const YamlValue& value, Slot slot, SceneCrowd& crowd) {
  crowd.wear.push_back({slot, readWeights(value), value.mark()});
  if (isOptional(slot) || slot == Slot::kFull) return;
  if (const auto none = value.find("none")) {
    none->fail(fmt::format("{}: who wears nothing full needs an item of '{}'", none->path(), toString(slot)),
               "remove it");
  }
}

void readWear(const YamlValue& value, SceneCrowd& crowd) {
  if (!crowd.outfits.empty()) {
    value.fail("crowd.outfits and crowd.wear both tell what people wear", "remove one of them");
  }
  value.expectKeys(kSlotNames);
  for (const Slot slot : kAllSlots) {
    if (const auto weights = value.find(toString(slot))) readSlotWeights(*weights, slot, crowd);
  }
  const auto full = value.find("full"), half = value.find(value.find("upper") ? "upper" : "lower");
  const bool leaves_some = full && full->find("none") && full->find("none")->number(kWeightRange) > 0.0;
  if (full && half && !leaves_some) {
    half->fail(
        fmt::format("{} is never worn: crowd.wear.full leaves nobody without an item of it", half->path()),
        "add 'none: WEIGHT' to crowd.wear.full, or remove the key");
  }
}

std::vector<Marked<std::string>> readWears(const YamlValue& value) {
  std::vector<Marked<std::string>> names;
  for (const YamlValue& item : value.items("a list of items"))
    names.push_back(readName(item, "an item's name"));
  return names;
}

void readCrowd(const YamlValue& value, const std::filesystem::path& base, SceneCrowd& crowd) {
  value.expectKeys({"count", "seed", "wardrobes", "placement", "outfits", "wear", "clips", "scale"});
  if (const auto placement = value.find("placement")) readPlacement(*placement, base, crowd.placement);
  crowd.count.reset();
  if (const auto count = value.find("count")) {
    crowd.count = static_cast<std::uint32_t>(count->wholeNumber(0, kMaxCrowd));
  } else if (crowd.placement.kind != PlacementKind::kFile && crowd.placement.kind != PlacementKind::kTable) {
    value.fail("the crowd has no count", "add 'count: 1000'");
  }
  if (const auto seed = value.find("seed")) crowd.seed = seed->wholeNumber(0, UINT64_MAX);
  if (const auto wardrobes = value.find("wardrobes")) crowd.wardrobes = readWeights(*wardrobes);
  if (const auto outfits = value.find("outfits")) crowd.outfits = readWeights(*outfits);
  if (const auto wear = value.find("wear")) readWear(*wear, crowd);
  if (const auto clips = value.find("clips")) crowd.clips = readWeights(*clips);
  if (const auto scale = value.find("scale")) {
    crowd.scale = readSpan(*scale, kScaleRange);
    crowd.scale_mark = scale->mark();
  }
}

ScenePerson readPerson(const YamlValue& value) {
  value.expectKeys(
      {"wardrobe", "outfit", "wears", "clip", "phase", "speed", "position", "heading", "scale", "tint"});
  ScenePerson person;
  person.mark = value.mark();
  if (const auto wardrobe = value.find("wardrobe")) {
    person.wardrobe = readName(*wardrobe, "the key of a wardrobe");
  }
  if (const auto outfit = value.find("outfit")) person.outfit = readName(*outfit, "an outfit's name");
  if (const auto wears = value.find("wears")) {
    if (!person.outfit.value.empty()) {
      wears->fail("the person has an outfit and wears something else", "remove 'outfit' or 'wears'");
    }
    person.wears = readWears(*wears);
  }
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

void checkCamera(Vec3 position, Vec3 target, const YamlValue& value) {
  if (glm::distance(position, target) >= 1e-4f) return;
  value.fail("the camera's target is where the camera stands", "move one of them");
}

/// What a key leaves out is as in the key before it, in the first as the camera has it.
void readCameraKeys(const YamlValue& value, SceneCamera& camera) {
  SceneCameraKey key{-1.0f, camera.position, camera.target, camera.fov_y};
  for (const YamlValue& item : value.items("a list of camera keys")) {
    item.expectKeys({"time", "position", "target", "fov_y"});
    const auto time = item.find("time");
    if (!time) item.fail("the camera key has no time", "add 'time: SECONDS'");
    const float seconds = time->numberFloat(kTimeRange);
    if (seconds <= key.seconds)
      time->fail(time->path() + " is not after the key before it", "give a later time");
    key.seconds = seconds;
    if (const auto position = item.find("position")) key.position = position->vector(kPositionRange);
    if (const auto target = item.find("target")) key.target = target->vector(kPositionRange);
    if (const auto fov = item.find("fov_y")) key.fov_y = radians(fov->numberFloat(kFovRange));
    checkCamera(key.position, key.target, item);
    camera.keys.push_back(key);
  }
  if (camera.keys.empty()) value.fail(value.path() + " is empty", "give a key, or remove it");
}

void readCamera(const YamlValue& value, SceneCamera& camera) {
  value.expectKeys({"position", "target", "fov_y", "near", "keys", "interpolation", "orbit"});
  const auto position = value.find("position");
  if (position) camera.position = position->vector(kPositionRange);
  const auto target = value.find("target");
  if (target) camera.target = target->vector(kPositionRange);
  if (const auto fov = value.find("fov_y")) camera.fov_y = radians(fov->numberFloat(kFovRange));
  if (const auto near_plane = value.find("near")) camera.near_plane = near_plane->numberFloat(kNearRange);
  checkCamera(camera.position, camera.target, target ? *target : position ? *position : value);
  const auto keys = value.find("keys"), orbit = value.find("orbit");
  if (keys) readCameraKeys(*keys, camera);
  if (const auto interpolation = value.find("interpolation")) {
    camera.smooth = interpolation->word({"smooth", "linear"}) == 0;
    if (!keys) interpolation->fail("camera.interpolation without keys", "add keys, or remove it");
  }
  if (orbit) {
    orbit->expectKeys({"seconds"});
    camera.orbit.emplace();
    if (keys) orbit->fail("the camera has keys and an orbit", "remove one of them");
    if (const auto seconds = orbit->find("seconds")) {
      camera.orbit->seconds = seconds->numberFloat(kTurnRange);
      if (camera.orbit->seconds == 0.0f)
        seconds->fail("camera.orbit.seconds is 0", "give the seconds of a turn");
    }
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

void readPoses(const YamlValue& value, ScenePoses& poses) {
  value.expectKeys({"snap_below", "cache"});
  if (const auto snap_below = value.find("snap_below"))
    poses.snap_below = snap_below->numberFloat(kPixelRange);
  if (const auto cache = value.find("cache"))
    poses.cache_mib = static_cast<std::uint32_t>(cache->wholeNumber(0, kMostCache));
}

void readScene(const YamlValue& root, Scene& scene) {
  if (root.kind() == YamlKind::kNull) root.fail("the scene is empty", "begin with 'version: 1'");
  root.expectKeys({"version", "wardrobe", "technique", "output", "raster", "culling", "occlusion", "debug",
                   "poses", "environment", "crowd", "people", "camera", "light", "ground"});
  readVersion(root);
  readWardrobes(root, scene);
  if (const auto technique = root.find("technique")) {
    scene.technique = kAllTechniques[technique->word({"naive", "prefitted", "tagged"})];
  }
  if (const auto output = root.find("output")) readOutput(*output, scene.output);
  if (const auto raster = root.find("raster")) {
    scene.raster = kAllRasterKinds[raster->word({"auto", "pipeline", "compute"})];
  }
  if (const auto culling = root.find("culling")) {
    constexpr CullingKind kKinds[] = {CullingKind::kAuto, CullingKind::kHost, CullingKind::kDevice};
    scene.culling = kKinds[culling->word({"auto", "host", "device"})];
  }
  if (const auto occlusion = root.find("occlusion")) scene.occlusion = occlusion->boolean();
  if (const auto debug = root.find("debug")) {
    constexpr DebugKind kKinds[] = {DebugKind::kNone, DebugKind::kRasteriser, DebugKind::kPose,
                                    DebugKind::kOverdraw};
    scene.debug = kKinds[debug->word({"none", "rasteriser", "pose", "overdraw"})];
  }
  if (const auto poses = root.find("poses")) readPoses(*poses, scene.poses);
  if (const auto environment = root.find("environment")) {
    scene.environment = {scene.file.parent_path() / environment->text("a glTF file"), environment->mark()};
    scene.ground = false;  // A set has a floor of its own; two at y = 0 would flicker.
  }
  if (const auto crowd = root.find("crowd")) readCrowd(*crowd, scene.file.parent_path(), scene.crowd);
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

const char* toString(RasterKind kind) {
  constexpr const char* kNames[] = {"auto", "pipeline", "compute"};
  return kNames[static_cast<int>(kind)];
}

std::optional<RasterKind> parseRasterKind(std::string_view name) {
  for (const RasterKind kind : kAllRasterKinds) {
    if (name == toString(kind)) return kind;
  }
  return std::nullopt;
}

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

std::string referenceScene() { return kReferenceScene; }

}  // namespace ensemble
