// `ensemble render`: frames of a scene as pictures.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/annotation_file.h"
#include "cli/annotations.h"
#include "cli/aov_ids.h"
#include "cli/command.h"
#include "cli/crowd_dump.h"
#include "cli/frame_files.h"
#include "cli/frame_list.h"
#include "cli/scene_run.h"
#include "core/input_error.h"
#include "core/progress.h"
#include "renderer/frame_names.h"
#include "renderer/renderer.h"

namespace ensemble::cli {
namespace {

using Json = nlohmann::ordered_json;

struct RenderArguments {
  CommonOptions common;
  SceneArguments scene;
  std::string output, aovs, annotations, crowd_file, frames;
  bool resume = false;
};

Json orNull(const std::optional<std::uint64_t>& count) { return count ? Json(*count) : Json(nullptr); }

Json toJson(const PassStats& pass) {
  return {{"draw_calls", pass.draw_calls},
          {"vertex_invocations", orNull(pass.vertex_invocations)},
          {"triangles", pass.triangles}};
}

Json toJson(const PoseStats& poses) {
  return {{"kept", poses.kept},
          {"skinned", poses.skinned},
          {"own", poses.own},
          {"skinned_vertices", poses.skinned_vertices},
          {"kept_bytes", poses.kept_bytes}};
}

Json toJson(const PartTimes& times) {
  Json parts = Json::object();
  for (std::size_t part = 0; part < kFramePartCount; ++part) parts[kFramePartNames[part]] = times[part];
  return parts;
}

Json toJson(std::uint32_t index, const std::string& file, const FrameStats& stats) {
  return {{"index", index},
          {"file", file},
          {"frame_ms", stats.frame_ms},
          {"cpu_ms", stats.cpu_ms},
          {"parts_ms", toJson(stats.parts_ms)},
          {"characters_drawn", stats.characters_drawn},
          {"characters_posed", stats.characters_posed},
          {"characters_computed", stats.characters_computed},
          {"triangles_computed", stats.triangles_computed},
          {"poses", toJson(stats.poses)},
          {"draw_calls", stats.drawCalls()},
          {"vertex_invocations", orNull(stats.vertexInvocations())},
          {"triangles", stats.triangles()},
          {"gpu_mesh_bytes", stats.gpu_mesh_bytes},
          {"environment_bytes", stats.environment_bytes},
          {"passes", {{"main", toJson(stats.main)}, {"shadow", toJson(stats.shadow)}}},
          {"environment", toJson(stats.environment)}};
}

void checkAnnotations(const std::string& file) {
  if (file != "-") return;
  throw UsageError({"", "--annotations -", "annotations go to a file, which --resume goes on with",
                    "write --annotations people.json"});
}

void checkOutput(const RenderArguments& arguments, const Scene& scene, const FrameNames& names) {
  if (names.format() != PictureFormat::kVideo) return;
  checkVideo(arguments.output, scene.output);
  if (!arguments.resume) return;
  throw UsageError({"", "--resume", "a video is written as a whole and can't be gone on with",
                    "leave --resume out, or write name_%04d.png and make the video of them"});
}

void run(const RenderArguments& arguments) {
  const std::vector<Aov> aovs = parseAovs(arguments.aovs);
  checkCrowdDump(arguments.crowd_file, arguments.common.json_file);
  checkAnnotations(arguments.annotations);
  const Scene scene = loadSceneOf(arguments.scene);
  const std::vector<std::uint32_t> frames = parseFrames(arguments.frames, scene.output.frames);
  const FrameNames names(arguments.output, static_cast<std::uint32_t>(frames.size()));
  checkOutput(arguments, scene, names);
  std::vector<Wardrobe> wardrobes = loadWardrobes(scene);
  findLayersOf(scene, wardrobes);
  const std::optional<EnvironmentMesh> environment = loadEnvironment(scene);
  Renderer renderer({.validate = arguments.scene.validate});
  renderer.load(scene, wardrobes, environment ? &*environment : nullptr);
  View view = viewOf(scene);
  for (const Aov aov : aovs) view.aovs.add(aov);
  view.linear = names.format() == PictureFormat::kExr;
  std::string ids;
  if (!aovs.empty()) ids = aovIds(scene, wardrobes, renderer.crowd(), renderer.aovNumbers()).dump(2) + "\n";
  FrameFiles files(names, scene.output, {.aovs = aovs, .ids = std::move(ids)});
  if (!arguments.crowd_file.empty()) dumpCrowd(arguments.crowd_file, scene, wardrobes, renderer.crowd());
  std::optional<AnnotationFile> annotations;
  if (!arguments.annotations.empty()) {
    annotations.emplace(arguments.annotations, annotationHeader(scene, wardrobes, renderer.crowd()),
                        arguments.resume);
    view.aovs.add(Aov::kCharacter);
    view.coverage = true;
  }

  Json rows = Json::array(), skipped = Json::array();
  Picture picture;
  Progress progress("rendering", frames.size());
  for (const std::uint32_t frame : frames) {
    const bool is_annotated = !annotations || annotations->has(frame);
    if (arguments.resume && is_annotated && files.areFinished(frame)) {
      skipped.push_back(frame);
    } else {
      const double seconds = frame / double{scene.output.fps};
      view.camera = scene.camera.at(seconds);
      renderer.render(std::span(&view, 1), seconds, std::span(&picture, 1));
      files.write(frame, picture);
      const std::string file = names.picture(frame).string();
      if (annotations) {
        annotations->add(frame,
                         annotateFrame(scene, wardrobes, renderer.crowd(), view, picture, frame, file));
      }
      rows.push_back(toJson(frame, file, picture.stats));
    }
    progress.advance();
  }
  files.finish();
  if (annotations) annotations->finish(frames);
  writeFigures(arguments.common, {{"schema", "ensemble.render/1"},
                                  {"device", renderer.deviceName()},
                                  {"frames", std::move(rows)},
                                  {"skipped", std::move(skipped)}});
  refuseValidationMessages(renderer);
}

}  // namespace

void addRenderCommand(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("render", "Render the frames of a scene");
  const auto arguments = std::make_shared<RenderArguments>();
  addSceneOptions(command, arguments->scene);
  command
      .add_option(
          "-o,--output", arguments->output,
          "Where the pictures go: dir/ or name_%04d.png (8-bit sRGB), name_%04d.exr (linear light, half "
          "precision), name.png or name.exr for one frame, name.mp4 for a video (H.264)")
      ->required()
      ->type_name("PATH");
  command
      .add_option(
          "--aov", arguments->aovs,
          "Also write, as OpenEXR, any of character,region,face,depth,normal; NAME.ids.json explains them")
      ->type_name("LIST");
  command
      .add_option("--annotations", arguments->annotations,
                  "Also write, as one JSON file, each frame's camera matrices and of each person who shows: "
                  "boxes, visible share, joints (docs/pictures.md)")
      ->type_name("FILE.json");
  command
      .add_option(
          "--dump-crowd", arguments->crowd_file,
          "Also write who stands where in what at time 0, as a table that a scene's placement of kind "
          "file reads back; the name ends in .csv, or is - for standard output (default: none)")
      ->type_name("FILE");
  command
      .add_option("--frames", arguments->frames,
                  "Which frames, e.g. 0-9,20; frame i is at i/fps seconds; default: all of output.frames")
      ->type_name("A-B,C");
  command.add_flag("--resume", arguments->resume,
                   "Skip frames whose files are all there, complete and of the right size; not with a video; "
                   "by default every frame is drawn");
  finishCommand(command, arguments->common, "ensemble render scene.yaml -o frames/ --set output.samples=1",
                [arguments] { run(*arguments); });
}

}  // namespace ensemble::cli
