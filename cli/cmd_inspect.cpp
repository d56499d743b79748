// `ensemble inspect`: what is in a GLB, a wardrobe or a scene.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "core/clip.h"
#include "core/gltf_file.h"
#include "core/input_error.h"
#include "core/nearest_name.h"
#include "core/scene.h"
#include "core/wardrobe.h"

namespace ensemble::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InspectArguments {
  CommonOptions common;
  std::string file, visible;
};

/// A figure and the text that tells it.
struct Findings {
  Json json;
  std::string text;
};

Findings inspectAsset(const std::string& file) {
  const RawAsset asset = readGltf(file);
  Findings found;
  found.json = {
      {"file", file}, {"meshes", Json::array()}, {"materials", Json::array()}, {"clips", Json::array()}};
  for (const RawMeshNode& node : asset.meshes) {
    std::size_t faces = 0, vertices = 0;
    Json parts = Json::array();
    std::string names;
    for (const RawPrimitive& primitive : node.primitives) {
      faces += primitive.faces.size();
      vertices += primitive.vertices.size();
      const std::string& material = asset.materials[primitive.material].name;
      parts.push_back({{"material", material},
                       {"faces", primitive.faces.size()},
                       {"vertices", primitive.vertices.size()}});
      names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", material, primitive.faces.size());
    }
    found.json["meshes"].push_back({{"name", node.name},
                                    {"skinned", node.skinned},
                                    {"faces", faces},
                                    {"vertices", vertices},
                                    {"primitives", parts}});
    found.text += fmt::format("mesh {}: {} faces, {} vertices{}: {}\n", node.name, faces, vertices,
                              node.skinned ? "" : ", not skinned", names);
  }
  for (const RawMaterial& material : asset.materials) found.json["materials"].push_back(material.name);
  found.json["joints"] = asset.skeleton.joints.size();
  found.text += fmt::format("skeleton: {} joints\n", asset.skeleton.joints.size());
  for (const RawClip& raw : asset.clips) {
    const Clip clip = sampleClip(asset.skeleton, raw);
    found.json["clips"].push_back({{"name", raw.name}, {"seconds", clip.seconds}, {"keys", clip.key_count}});
    found.text += fmt::format("clip {}: {:.3f} s, {} keys\n", raw.name, clip.seconds, clip.key_count);
  }
  for (const std::string& what : asset.dropped) found.text += "dropped: " + what + "\n";
  for (const std::string& warning : asset.warnings) found.text += "warning: " + warning + "\n";
  found.json["dropped"] = asset.dropped;
  found.json["warnings"] = asset.warnings;
  return found;
}

Findings inspectWardrobe(const std::string& folder) {
  const Wardrobe wardrobe = loadWardrobe(folder);
  const TemplateBody& body = wardrobe.body;
  Findings found;
  found.json = {{"wardrobe", folder},
                {"template",
                 {{"file", wardrobe.template_file},
                  {"faces", body.faces.size()},
                  {"vertices", body.vertices.size()},
                  {"joints", body.skeleton.joints.size()}}},
                {"regions", Json::array()},
                {"clips", Json::array()},
                {"outfits", Json::array()}};
  found.text = fmt::format("template {}: {} faces, {} vertices, {} joints\n", wardrobe.template_file,
                           body.faces.size(), body.vertices.size(), body.skeleton.joints.size());
  for (const Region& region : body.regions) {
    found.json["regions"].push_back({{"name", region.name}, {"faces", region.face_count}});
    found.text += fmt::format("region {}: {} faces\n", region.name, region.face_count);
  }
  for (const Clip& clip : body.clips) {
    found.json["clips"].push_back({{"name", clip.name},
                                   {"seconds", clip.seconds},
                                   {"keys", clip.key_count},
                                   {"ground_speed", clip.ground_speed}});
    found.text += fmt::format("clip {}: {:.3f} s, {} keys, {:.3f} m/s\n", clip.name, clip.seconds,
                              clip.key_count, clip.ground_speed);
  }
  for (std::size_t i = 0; i < wardrobe.items.size(); ++i) {
    const Item& item = wardrobe.items[ItemId(i)];
    Json garments = Json::array();
    std::string names;
    for (const Garment& garment : item.garments) {
      std::size_t faces = 0;
      for (const ItemPart& part : garment.parts) faces += part.faces.size();
      garments.push_back({{"name", garment.name}, {"faces", faces}});
      names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", garment.name, faces);
    }
    found.json["outfits"].push_back({{"name", item.name},
                                     {"slot", toString(item.slot)},
                                     {"layer", item.layer},
                                     {"file", wardrobe.item_files[ItemId(i)]},
                                     {"garments", garments},
                                     {"visible_body_faces", item.visibleBodyFaceCount()}});
    found.text += fmt::format("outfit {} (slot {}, layer {}): {}; {} body faces show\n", item.name,
                              toString(item.slot), item.layer, names, item.visibleBodyFaceCount());
  }
  return found;
}

/// The body faces that show under an outfit, by region, in template.glb's own order within each.
Findings inspectVisible(const std::string& folder, const std::string& outfit) {
  const Wardrobe wardrobe = loadWardrobe(folder);
  std::vector<std::string> names;
  for (const Item& item : wardrobe.items) names.push_back(item.name);
  const auto found_name = std::find(names.begin(), names.end(), outfit);
  if (found_name == names.end()) {
    const std::vector<std::string> nearest = nearestNames(outfit, names);
    throw InputError(
        {folder, "", "the wardrobe has no outfit " + quotedName(outfit),
         nearest.empty() ? "add one with `ensemble add`" : "did you mean " + quotedList(nearest) + "?"});
  }
  const Item& item = wardrobe.items[ItemId(static_cast<std::size_t>(found_name - names.begin()))];
  Findings found;
  found.json = {{"regions", Json::array()}};
  for (std::size_t r = 0; r < wardrobe.body.regions.size(); ++r) {
    const Region& region = wardrobe.body.regions[RegionId(r)];
    Json faces = Json::array();
    for (std::uint32_t f = 0; f < region.face_count; ++f) {
      if (item.visible[FaceId(region.first_face + f)] != 0) faces.push_back(f);
    }
    const char* visibility = toString(item.tags[RegionId(r)].visibility);
    found.text +=
        fmt::format("{}: {} ({} of {} faces)\n", region.name, visibility, faces.size(), region.face_count);
    found.json["regions"].push_back(
        {{"name", region.name}, {"visibility", visibility}, {"faces", std::move(faces)}});
  }
  return found;
}

Findings inspectScene(const std::string& file) {
  const Scene scene = loadScene(file);
  Findings found;
  found.json = {{"scene", file},
                {"technique", toString(scene.technique)},
                {"wardrobes", Json::array()},
                {"environment",
                 scene.environment.value.empty() ? Json(nullptr) : Json(scene.environment.value.string())},
                {"crowd", scene.crowd.count ? Json(*scene.crowd.count) : Json(nullptr)},
                {"people", scene.people.size()},
                {"width", scene.output.width},
                {"height", scene.output.height},
                {"frames", scene.output.frames}};
  found.text = fmt::format("{} x {}, {} frames, technique {}\n", scene.output.width, scene.output.height,
                           scene.output.frames, toString(scene.technique));
  for (const SceneWardrobe& wardrobe : scene.wardrobes) {
    found.json["wardrobes"].push_back({{"key", wardrobe.key}, {"folder", wardrobe.folder.string()}});
    found.text += fmt::format("wardrobe {}: {}\n", wardrobe.key.empty() ? "(only one)" : wardrobe.key,
                              wardrobe.folder.string());
  }
  if (!scene.environment.value.empty())
    found.text += fmt::format("environment {}\n", scene.environment.value.string());
  const std::string count = scene.crowd.count ? std::to_string(*scene.crowd.count)
                                              : "all of " + scene.crowd.placement.file.value.string();
  found.text += fmt::format("crowd of {}, {} named people\n", count, scene.people.size());
  return found;
}

void run(const InspectArguments& arguments) {
  const std::filesystem::path path(arguments.file);
  const std::string ending = path.extension().string();
  const bool is_wardrobe = std::filesystem::is_directory(path) || path.filename() == "wardrobe.json";
  const std::string folder =
      path.filename() == "wardrobe.json" ? path.parent_path().string() : arguments.file;
  if (!arguments.visible.empty() && !is_wardrobe) {
    throw UsageError(
        {"", "--visible", "'" + arguments.file + "' is no wardrobe", "give a wardrobe's folder"});
  }
  Findings found;
  if (is_wardrobe) {
    found = arguments.visible.empty() ? inspectWardrobe(folder) : inspectVisible(folder, arguments.visible);
  } else if (ending == ".yaml" || ending == ".yml") {
    found = inspectScene(arguments.file);
  } else {
    found = inspectAsset(arguments.file);
  }
  writeFigures(arguments.common, found.json);
  printResult(arguments.common, found.text);
}

}  // namespace

void addInspectCommand(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("inspect", "Tell what is in a GLB, a wardrobe or a scene");
  const auto arguments = std::make_shared<InspectArguments>();
  command.add_option("FILE", arguments->file, "A .glb, .gltf, wardrobe folder or scene .yaml")
      ->required()
      ->type_name("FILE");
  command.add_option("--visible", arguments->visible, "List the template's faces that show under an outfit")
      ->type_name("OUTFIT");
  finishCommand(command, arguments->common, "ensemble inspect wardrobes/women --visible casual01 --json -",
                [arguments] { run(*arguments); });
}

}  // namespace ensemble::cli
