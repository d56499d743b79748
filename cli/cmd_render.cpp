// `ensemble render`: frames of a scene as pictures.
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/annotation_file.h"
#include "cli/annotations.h"
#include "cli/aov_ids.h"
#include "cli/command.h"
#include "cli/crowd_dump.h"
#include "cli/frame_files.h"
#include "cli/frame_list.h"
#include "cli/frame_sequence.h"
#include "cli/scene_run.h"
#include "core/input_error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "renderer/frame_names.h"
#include "renderer/renderer_pool.h"

namespace ensemble::cli {
namespace {

using Json = nlohmann::ordered_json;

struct RenderArguments {
  CommonOptions common;
  SceneArguments scene;
  std::string output, aovs, annotations, crowd_file, frames;
  unsigned renderers = 0;  ///< 0: as many as pay off
  bool resume = false;
};

void checkAnnotations(const std::string& file) {
  if (file != "-") return;
  throw UsageError({"", "--annotations -", "annotations go to a file, which --resume goes on with",
                    "write --annotations people.json"});
}

void checkOutput(const RenderArguments& arguments, const Scene& scene, const FrameNames& names) {
  if (names.format() == PictureFormat::kExr && scene.debug != DebugKind::kNone) {
    throw UsageError({"", "-o " + arguments.output,
                      "what `debug` lays over a picture is no light, and not in an EXR",
                      "write .png, or --set debug=none"});
  }
  if (names.format() != PictureFormat::kVideo) return;
  checkVideo(arguments.output, scene.output);
  if (!arguments.resume) return;
  throw UsageError({"", "--resume", "a video is written as a whole and can't be gone on with",
                    "leave --resume out, or write name_%04d.png and make the video of them"});
}

/// Frames that are finished already, and those that are not.
struct FramesToDo {
  std::vector<std::uint32_t> skipped, drawn;
};

FramesToDo framesToDo(std::span<const std::uint32_t> frames, const FrameFiles& files,
                      const AnnotationFile* annotations, bool resume) {
  FramesToDo to_do;
  for (const std::uint32_t frame : frames) {
    const bool is_annotated = !annotations || annotations->has(frame);
    const bool is_skipped = resume && is_annotated && files.areFinished(frame);
    (is_skipped ? to_do.skipped : to_do.drawn).push_back(frame);
  }
  return to_do;
}

/// Lets as many renderers draw as were asked for, or as pay off. @returns the most that there will be
unsigned allowRenderers(unsigned asked, std::size_t frames, RendererPool& renderers) {
  if (asked == 0) return renderers.allowAutomatic(frames, threadCount(0));
  const auto count = static_cast<unsigned>(std::clamp<std::size_t>(frames, 1, asked));
  renderers.allow(count);
  return count;
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
  RendererPool renderers(
      {.validate = arguments.scene.validate},
      {.scene = &scene, .wardrobes = wardrobes, .environment = environment ? &*environment : nullptr});
  View view = viewOf(scene);
  for (const Aov aov : aovs) view.aovs.add(aov);
  view.linear = names.format() == PictureFormat::kExr;
  std::string ids;
  if (!aovs.empty()) ids = aovIds(scene, wardrobes, renderers.crowd(), renderers.aovNumbers()).dump(2) + "\n";
  FrameFiles files(names, scene.output, {.aovs = aovs, .ids = std::move(ids)});
  if (!arguments.crowd_file.empty()) dumpCrowd(arguments.crowd_file, scene, wardrobes, renderers.crowd());
  std::optional<AnnotationFile> annotations;
  if (!arguments.annotations.empty()) {
    annotations.emplace(arguments.annotations, annotationHeader(scene, wardrobes, renderers.crowd()),
                        arguments.resume);
    view.aovs.add(Aov::kCharacter);
    view.coverage = true;
  }
  AnnotationFile* const annotated = annotations ? &*annotations : nullptr;

  const FramesToDo to_do = framesToDo(frames, files, annotated, arguments.resume);
  const unsigned most = allowRenderers(arguments.renderers, to_do.drawn.size(), renderers);
  Progress progress("rendering", frames.size());
  progress.advance(to_do.skipped.size());
  const FrameSequence sequence{scene, wardrobes, renderers, view, names, files, annotated};
  Json rows = drawFrames(sequence, to_do.drawn, most, progress);
  files.finish();
  if (annotations) annotations->finish(frames);
  writeFigures(arguments.common, {{"schema", "ensemble.render/1"},
                                  {"device", renderers.deviceName()},
                                  {"renderers", renderers.madeCount()},
                                  {"frames", std::move(rows)},
                                  {"skipped", to_do.skipped}});
  refuseValidationMessages(renderers.validationMessages());
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
  command
      .add_option(
          "--renderers", arguments->renderers,
          "Draw a sequence with N renderers at once, 1 to 64; each holds the scene, within one limit "
          "of memory, and all make the same bytes. Default: 1 on a GPU; on a CPU one for each core, or "
          "one for each 4 where most people are drawn in compute shaders, at most 8 and at most one "
          "for every 4 frames (docs/performance.md)")
      ->type_name("N")
      ->check(CLI::Range(1, 64));
  command.add_flag("--resume", arguments->resume,
                   "Skip frames whose files are all there, complete and of the right size; not with a video; "
                   "by default every frame is drawn");
  finishCommand(command, arguments->common, "ensemble render scene.yaml -o frames/ --set output.samples=1",
                [arguments] { run(*arguments); });
}

}  // namespace ensemble::cli
