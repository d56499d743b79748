// A scene file: who stands where in what, seen from where. Strict YAML (interfaces.md, "A scene").
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/math.h"
#include "core/slots.h"
#include "core/source_mark.h"
#include "core/sub_mesh_lists.h"

namespace ensemble {

enum class BackgroundKind : std::uint8_t { kSky, kTransparent, kColor };

struct SceneOutput {
  std::uint32_t width = 1280, height = 720;  ///< 1 .. 16384
  std::uint32_t samples = 4;                 ///< 1 or 4
  std::uint32_t frames = 1;
  float fps = 30.0f;
  BackgroundKind background = BackgroundKind::kSky;
  Vec3 background_color{0.0f};  ///< sRGB, 0 .. 1
};

/// kFile: trajectories. kTable: a crowd table (core/crowd_table.h), which a scene calls `file`, too.
enum class PlacementKind : std::uint8_t { kGrid, kDisc, kFormation, kPaths, kFile, kTable };

/// A stand on a path.
struct ScenePathStop {
  float at = 0.0f;       ///< metres along the path's middle
  float seconds = 1.0f;  ///< everybody stands this long
};

/// A line that people walk along, for ever.
struct ScenePath {
  std::vector<Vec3> points;  ///< two at least, three where closed
  bool closed = false;       ///< false: who comes to the end begins again at the start
  float width = 0.0f;        ///< metres: lanes beside each other, a spacing apart
  float corner_radius = 1.0f;
  float weight = 1.0f;               ///< share of the people, times its number of lanes
  std::vector<ScenePathStop> stops;  ///< ascending
  SourceMark mark;
};

/// How people of `paths` and `file` walk.
struct SceneWalking {
  std::optional<std::array<float, 2>> speed;  ///< metres a second, a lane's is uniform between; paths only
  float acceleration = 1.0f;                  ///< metres a second squared; paths only
  float idle_below = 0.4f;                    ///< metres a second: slower, the walk blends into the idle clip
  Marked<std::string> idle;                   ///< clip for standing; empty: the first without ground speed
  float smoothing = 0.5f;                     ///< seconds over which a trajectory is averaged; file only
  std::optional<float> fps;                   ///< of a trajectory; left out: what its file says; file only
};

/// Where the crowd stands. Distances in metres; `heading` as for a person, in degrees in the file.
struct ScenePlacement {
  PlacementKind kind = PlacementKind::kGrid;
  float spacing = 1.2f;  ///< grid, formation: between neighbours; disc: least distance
  Vec3 center{0.0f};
  std::optional<float> heading;  ///< radians; left out: formation 0, else at random
  SourceMark heading_mark;       ///< where there is a heading
  float heading_spread = 0.0f;   ///< radians: uniform within +- this about heading
  float jitter = 0.0f;           ///< grid, formation: share of the spacing, 0 .. 0.45
  std::uint32_t columns = 0;     ///< formation, grid: people in a rank; 0: as square as possible
  std::vector<ScenePath> paths;
  Marked<std::filesystem::path> file;  ///< trajectories or table, resolved against the scene's folder
  SceneWalking walking;
};

struct WeightedName {
  std::string name;
  float weight = 1.0f;
  SourceMark mark;
};

/// How often the items of a slot are worn.
struct SceneWear {
  Slot slot = Slot::kFull;
  std::vector<WeightedName> items;  ///< bare or KEY/NAME, or `none`
  SourceMark mark;
};

struct SceneCrowd {
  /// kFile, kTable: none means all of the file.
  std::optional<std::uint32_t> count = 0;
  std::uint64_t seed = 1;
  std::vector<WeightedName> wardrobes;  ///< by key; empty: all alike
  ScenePlacement placement;
  /// Bare or KEY/NAME, items joined by '+'. Empty: combined from `wear`.
  std::vector<WeightedName> outfits;
  std::vector<SceneWear> wear;             ///< each slot once; one that is left out: its items alike
  std::vector<WeightedName> clips;         ///< empty: the first clip of each wardrobe
  std::array<float, 2> scale{1.0f, 1.0f};  ///< uniform between the two
  SourceMark scale_mark;                   ///< without a key path where the scene has no such key
};

struct ScenePerson {
  Marked<std::string> wardrobe;            ///< key; empty where there is one
  Marked<std::string> outfit;              ///< an item, or several joined by '+'; empty: the bare body
  std::vector<Marked<std::string>> wears;  ///< items, in place of `outfit`
  Marked<std::string> clip;                ///< empty: the first clip
  float phase = 0.0f;                      ///< part of the clip that has run at time 0
  float speed = 1.0f;                      ///< factor on the clip's speed
  Vec3 position{0.0f};
  float heading = 0.0f;  ///< radians about +Y: 0 looks along +Z, 90 degrees along +X
  float scale = 1.0f;
  std::optional<std::uint32_t> tint;  ///< tint seed; left out: from the crowd's seed and its number
  SourceMark mark;
};

/// Where the camera is at a time.
struct SceneCameraKey {
  float seconds = 0.0f;
  Vec3 position{0.0f}, target{0.0f};
  float fov_y = 0.0f;  ///< radians
};

/// A camera that goes round its target once in `seconds`, from where `position` is.
struct SceneOrbit {
  float seconds = 10.0f;  ///< a whole turn; negative: clockwise, seen from above
};

struct SceneCamera {
  Vec3 position{0.0f, 1.7f, 12.0f};
  Vec3 target{0.0f, 1.0f, 0.0f};
  float fov_y = radians(45.0f);
  float near_plane = 0.1f;                ///< metres; there is no far plane
  std::vector<SceneCameraKey> keys = {};  ///< ascending; empty: it stands still, or goes round
  bool smooth = true;                     ///< between keys: without corners, else straight
  std::optional<SceneOrbit> orbit = {};

  /// The camera at a time: without keys and orbit.
  SceneCamera at(double time_seconds) const;
};

struct SceneLight {
  Vec3 direction{-0.4f, -1.0f, -0.3f};  ///< the way the light travels; any length but 0
  bool shadows = true;
};

/// Which rasteriser draws people. kAuto: the faster one for each, by counts and sizes.
enum class RasterKind : std::uint8_t { kAuto, kPipeline, kCompute };
inline constexpr RasterKind kAllRasterKinds[] = {RasterKind::kAuto, RasterKind::kPipeline,
                                                 RasterKind::kCompute};
const char* toString(RasterKind kind);  ///< "auto", "pipeline", "compute"
std::optional<RasterKind> parseRasterKind(std::string_view name);

/// Where it is found out who is in sight, and who shows which sub-mesh, for the graphics pipeline's draws.
/// kAuto: on the device where that is a GPU. Whom the compute rasteriser may draw the host plans, and then
/// all others.
enum class CullingKind : std::uint8_t { kAuto, kHost, kDevice };

/// What is laid over a picture, to tell how it was drawn.
enum class DebugKind : std::uint8_t { kNone, kRasteriser, kPose, kOverdraw };

/// How people are posed.
struct ScenePoses {
  float snap_below = 48.0f;       ///< pixels: who is smaller on the screen is shown at the nearest key frame
  std::uint32_t cache_mib = 256;  ///< of key frames' skinned vertices that are kept from frame to frame
};

struct SceneWardrobe {
  std::string key;               ///< empty where the scene names only one
  std::filesystem::path folder;  ///< resolved against the scene's folder
  SourceMark mark;
};

struct Scene {
  std::filesystem::path file;
  std::vector<SceneWardrobe> wardrobes;  ///< at least one
  Technique technique = Technique::kTagged;
  SceneOutput output;
  RasterKind raster = RasterKind::kAuto;
  CullingKind culling = CullingKind::kAuto;
  bool occlusion = false;  ///< people whom nearer ones hide are left out by the compute rasteriser
  DebugKind debug = DebugKind::kNone;
  ScenePoses poses;
  SceneCrowd crowd;
  std::vector<ScenePerson> people;
  SceneCamera camera;
  SceneLight light;
  Marked<std::filesystem::path> environment;  ///< a static set, glTF; empty: none
  bool ground = true;  ///< a ground plane at y = 0; where there is an environment, only if the scene says so
};

/// `--set key.path=value`: the value is YAML; list entries by number (`people.0.phase=0.5`).
using SceneOverride = std::pair<std::string, std::string>;

/// Splits "key.path=value" at its first '='. @throws UsageError without one or without a key.
SceneOverride parseSceneOverride(const std::string& text);

/// Reads a scene and applies overrides. Every key is described in docs/scene.md. Numbers are strict
/// (`010` and `1e999` are errors); unknown keys name the nearest known one; duplicate keys, aliases
/// and anchors are errors. Names of wardrobes, outfits and clips are checked by populateCrowd.
/// @throws InputError FILE: LINE:COLUMN: ...; UsageError "--set KEY=VALUE: ..." for whatever an
/// override got wrong.
Scene loadScene(const std::filesystem::path& file, std::span<const SceneOverride> overrides = {});

/// The same from text; relative wardrobe paths are resolved against `file`'s folder.
Scene parseScene(const std::string& text, const std::filesystem::path& file,
                 std::span<const SceneOverride> overrides = {});

/// A scene file with every key and what it means, for people to read and to begin with.
std::string referenceScene();

}  // namespace ensemble
