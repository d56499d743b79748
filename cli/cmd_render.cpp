// `ensemble render`: frames of a scene as pictures.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/aov_ids.h"
#include "cli/command.h"
#include "cli/frame_list.h"
#include "cli/scene_run.h"
#include "core/atomic_file.h"
#include "core/progress.h"
#include "renderer/frame_names.h"
#include "renderer/picture_writer.h"
#include "renderer/renderer.h"

namespace ensemble::cli {
namespace {

using Json = nlohmann::ordered_json;

struct RenderArguments {
  CommonOptions common;
  SceneArguments scene;
  std::string output, aovs, frames;
};

Json orNull(const std::optional<std::uint64_t>& count) { return count ? Json(*count) : Json(nullptr); }

Json toJson(const PassStats& pass) {
  return {{"draw_calls", pass.draw_calls},
          {"vertex_invocations", orNull(pass.vertex_invocations)},
          {"triangles", pass.triangles}};
}

Json toJson(std::uint32_t index, const std::string& file, const FrameStats& stats) {
  return {{"index", index},
          {"file", file},
          {"frame_ms", stats.frame_ms},
          {"cpu_ms", stats.cpu_ms},
          {"characters_drawn", stats.characters_drawn},
          {"characters_posed", stats.characters_posed},
          {"draw_calls", stats.drawCalls()},
          {"vertex_invocations", orNull(stats.vertexInvocations())},
          {"triangles", stats.triangles()},
          {"gpu_mesh_bytes", stats.gpu_mesh_bytes},
          {"passes", {{"main", toJson(stats.main)}, {"shadow", toJson(stats.shadow)}}}};
}

void writeAov(const FrameNames& names, std::uint32_t frame, Aov aov, const Picture& picture) {
  const std::filesystem::path file = names.aov(frame, aov);
  const std::uint32_t width = picture.color.width, height = picture.color.height;
  switch (aov) {
    case Aov::kCharacter:
      return writeIdAov(file, aov, width, height, picture.character);
    case Aov::kRegion:
      return writeIdAov(file, aov, width, height, picture.region);
    case Aov::kFace:
      return writeIdAov(file, aov, width, height, picture.face);
    case Aov::kDepth:
      return writeFloatAov(file, aov, width, height, picture.depth);
    case Aov::kNormal:
      return writeFloatAov(file, aov, width, height, picture.normal);
  }
}

void run(const RenderArguments& arguments) {
  const std::vector<Aov> aovs = parseAovs(arguments.aovs);
  const Scene scene = loadSceneOf(arguments.scene);
  const std::vector<std::uint32_t> frames = parseFrames(arguments.frames, scene.output.frames);
  const FrameNames names(arguments.output, static_cast<std::uint32_t>(frames.size()));
  const std::vector<Wardrobe> wardrobes = loadWardrobes(scene);
  Renderer renderer({.validate = arguments.scene.validate});
  renderer.load(scene, wardrobes);
  View view = viewOf(scene);
  for (const Aov aov : aovs) view.aovs.add(aov);
  const std::string ids =
      aovs.empty() ? "" : aovIds(scene, wardrobes, renderer.crowd(), renderer.aovNumbers()).dump(2) + "\n";
  if (!names.folder().empty()) std::filesystem::create_directories(names.folder());

  Json rows = Json::array();
  Picture picture;
  Progress progress("rendering", frames.size());
  for (const std::uint32_t frame : frames) {
    const double seconds = frame / double{scene.output.fps};
    view.camera = scene.camera.at(seconds);
    renderer.render(std::span(&view, 1), seconds, std::span(&picture, 1));
    const std::filesystem::path file = names.picture(frame);
    writePicture(file, picture.color);
    for (const Aov aov : aovs) writeAov(names, frame, aov, picture);
    if (!aovs.empty()) writeFileAtomically(names.ids(frame), std::string_view(ids));
    rows.push_back(toJson(frame, file.string(), picture.stats));
    progress.advance();
  }
  writeFigures(
      arguments.common,
      {{"schema", "ensemble.render/1"}, {"device", renderer.deviceName()}, {"frames", std::move(rows)}});
  refuseValidationMessages(renderer);
}

}  // namespace

void addRenderCommand(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("render", "Render the frames of a scene");
  const auto arguments = std::make_shared<RenderArguments>();
  addSceneOptions(command, arguments->scene);
  command
      .add_option("-o,--output", arguments->output,
                  "Where the pictures go: dir/, name_%04d.png, or name.png for one frame")
      ->required()
      ->type_name("PATH");
  command
      .add_option(
          "--aov", arguments->aovs,
          "Also write, as OpenEXR, any of character,region,face,depth,normal; NAME.ids.json explains them")
      ->type_name("LIST");
  command
      .add_option("--frames", arguments->frames,
                  "Which frames, e.g. 0-9,20; frame i is at i/fps seconds; default: all of output.frames")
      ->type_name("A-B,C");
  finishCommand(command, arguments->common, "ensemble render scene.yaml -o frames/ --set output.samples=1",
                [arguments] { run(*arguments); });
}

}  // namespace ensemble::cli
