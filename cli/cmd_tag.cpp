// `ensemble tag`, `add` and `remove`: make and change wardrobes.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "assetpipe/pipeline.h"
#include "cli/command.h"
#include "core/input_error.h"

namespace ensemble::cli {
namespace {

struct TagArguments {
  CommonOptions common;
  std::string template_file, folder;
  std::vector<std::string> outfits, clips;
  std::string occlusion = "authored", regions = "material";
  bool auto_occlusion = false;
  std::string explain;
  float hole_mm2 = HiddenFaceOptions().hole_area * 1.0e6f;
  std::string body_node;
  float tolerance_mm = kDefaultTolerance * 1000.0f;
  std::uint32_t garment_faces = 0;
  bool draco = false;
  unsigned jobs = 0;
};

/// Options that `tag` and `add` share.
void addTaggingOptions(CLI::App& command, TagArguments& arguments) {
  command
      .add_option("--occlusion", arguments.occlusion,
                  "Which faces are hidden: authored (those that the outfit's author removed), auto (found by "
                  "rays, over all clips; what the author removed does not matter) or both (default authored)")
      ->check(CLI::IsMember({"authored", "auto", "both"}))
      ->type_name("KIND");
  command.add_flag("--auto-occlusion", arguments.auto_occlusion, "The same as --occlusion auto");
  command
      .add_option(
          "--hole", arguments.hole_mm2,
          "With auto and both: how large a hole may be where a face is left out of which a little could be "
          "seen, in square millimetres on average over all sides and poses; 0 keeps whatever can be seen at "
          "all, 0 to 1000 (default 12)")
      ->check(CLI::Range(0.0, 1000.0))
      ->type_name("MM2");
  command
      .add_option(
          "--explain", arguments.explain,
          "With auto and both: a folder for a picture of the body and a list of its faces, with the clip and "
          "the time that show each that is kept (default: none)")
      ->type_name("FOLDER");
  command
      .add_option("--body", arguments.body_node,
                  "Name of the node that is the body (default: whatever has a region's material)")
      ->type_name("NODE");
  command
      .add_option(
          "--tolerance", arguments.tolerance_mm,
          "How far a body corner may be from the template's, in millimetres, 0.001 to 10 (default 0.2)")
      ->check(CLI::Range(0.001, 10.0))
      ->type_name("MM");
  command
      .add_option(
          "--garment-faces", arguments.garment_faces,
          "Bring garments with more faces down to N for good; raw outfits only (default: as they are)")
      ->check(CLI::Range(100u, 10000000u))
      ->type_name("N");
  command.add_flag("--draco", arguments.draco, "Compress the files with Draco (off by default)");
  command.add_option("-j,--jobs", arguments.jobs, "Outfits tagged at a time (default: one for each core)")
      ->check(CLI::Range(1, 256))
      ->type_name("N");
}

PipelineOptions pipelineOptions(const TagArguments& arguments) {
  PipelineOptions options;
  if (arguments.occlusion == "both") {
    options.tag.occlusion = Occlusion::kBoth;
  } else if (arguments.auto_occlusion || arguments.occlusion == "auto") {
    options.tag.occlusion = Occlusion::kAuto;
  }
  if (arguments.regions == "joints") {
    options.segment.by = SegmentBy::kJoints;
  } else if (arguments.regions != "material") {
    options.segment.by = SegmentBy::kRules;
    options.segment.rules = readRegionRules(arguments.regions);
  }
  options.segment.body_node = "";
  options.tag.body_node = arguments.body_node;
  options.tag.hidden.hole_area = arguments.hole_mm2 * 1.0e-6f;
  if (arguments.hole_mm2 <= 0.0f) options.tag.hidden.hole_share = 0.0f;
  options.tag.explain = arguments.explain;
  options.tag.garment_faces = arguments.garment_faces;
  options.tag.tolerance = arguments.tolerance_mm / 1000.0f;
  options.clips.assign(arguments.clips.begin(), arguments.clips.end());
  options.draco = arguments.draco;
  options.jobs = arguments.jobs;
  return options;
}

std::vector<std::filesystem::path> paths(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

/// The manifest is the figures of these commands.
void tellResult(const CommonOptions& common, const std::string& folder, const Manifest& manifest) {
  writeFigures(common, nlohmann::ordered_json::parse(writeManifest(manifest)));
  std::string text;
  for (const ManifestOutfit& outfit : manifest.outfits) {
    text += outfit.name + ":";
    for (const ManifestTag& tag : outfit.regions) {
      text += " " + tag.name + " " + toString(tag.visibility);
      if (tag.visibility == Visibility::kPartial)
        text += fmt::format(" ({}/{})", tag.visible_faces, tag.template_faces);
      text += &tag == &outfit.regions.back() ? "\n" : ",";
    }
  }
  printResult(common,
              text + fmt::format("{}: {} faces, {} regions, {} outfits\n", folder, manifest.body.faces,
                                 manifest.body.regions.size(), manifest.outfits.size()));
}

}  // namespace

void addTagCommand(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("tag", "Tag what outfits hide of a template, and write a wardrobe");
  const auto arguments = std::make_shared<TagArguments>();
  command.add_option("TEMPLATE", arguments->template_file, "The template person, .glb or .gltf")
      ->required()
      ->type_name("FILE");
  command.add_option("OUTFIT", arguments->outfits, "Outfits with the body that they dress, raw or tagged")
      ->type_name("FILE...");
  command.add_option("-o,--output", arguments->folder, "The wardrobe's folder")
      ->required()
      ->type_name("WARDROBE");
  command
      .add_option(
          "--regions", arguments->regions,
          "How the template is cut: material, joints (by dominant skin weight) or a file (default material)")
      ->type_name("material|joints|FILE");
  command
      .add_option(
          "--clips", arguments->clips,
          "Files with more clips of the same skeleton; a clip that a tool named takes its file's name "
          "(default: none)")
      ->type_name("FILE...");
  addTaggingOptions(command, *arguments);
  finishCommand(
      command, arguments->common, "ensemble tag woman.glb outfits/*.glb -o wardrobes/women", [arguments] {
        const PipelineOptions options = pipelineOptions(*arguments);
        tellResult(
            arguments->common, arguments->folder,
            tagWardrobe(arguments->template_file, paths(arguments->outfits), arguments->folder, options));
      });
}

void addAddCommand(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("add", "Add outfits, raw or tagged, to a wardrobe");
  const auto arguments = std::make_shared<TagArguments>();
  command.add_option("WARDROBE", arguments->folder, "The wardrobe's folder")->required()->type_name("FOLDER");
  command.add_option("OUTFIT", arguments->outfits, "Outfits, raw or tagged for the same template")
      ->required()
      ->type_name("FILE...");
  addTaggingOptions(command, *arguments);
  finishCommand(command, arguments->common, "ensemble add wardrobes/women new/raincoat.glb", [arguments] {
    const PipelineOptions options = pipelineOptions(*arguments);
    tellResult(arguments->common, arguments->folder,
               addOutfits(arguments->folder, paths(arguments->outfits), options));
  });
}

void addRemoveCommand(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("remove", "Remove outfits from a wardrobe");
  const auto arguments = std::make_shared<TagArguments>();
  command.add_option("WARDROBE", arguments->folder, "The wardrobe's folder")->required()->type_name("FOLDER");
  command.add_option("NAME", arguments->outfits, "Names of outfits")->required()->type_name("NAME...");
  finishCommand(command, arguments->common, "ensemble remove wardrobes/women raincoat", [arguments] {
    tellResult(arguments->common, arguments->folder, removeOutfits(arguments->folder, arguments->outfits));
  });
}

}  // namespace ensemble::cli
