#include "cli/manual.h"

#include <algorithm>

namespace ensemble::cli {
namespace {

constexpr std::size_t kColumns = 80;

constexpr Manual kManuals[] = {
    {"tag",
     "Cuts the template into regions, matches the body in each outfit's file with the template, face by "
     "face, "
     "and classes every region of every outfit as full, partial or hidden. Clips that travel are put in "
     "place, and their speed over the ground is kept. A wardrobe that is there already is replaced.",
     "TEMPLATE and OUTFIT are glTF files (docs/wardrobe.md, What an artist delivers). The vertex attribute "
     "_HIDE of an outfit's body hides a face where all its corners have more than 0.5, keeps it where all "
     "have "
     "less than -0.5; the default, 0, leaves it to --occlusion. WARDROBE is a folder "
     "with "
     "wardrobe.json, template.glb and outfits/; after any error it holds what it held before."},
    {"add",
     "Tags outfits for a wardrobe's template and adds them, without touching the other files. An outfit that "
     "was tagged elsewhere for the same template is added as it is.",
     "OUTFIT is a glTF file, raw or from another wardrobe's outfits/. After any error the wardrobe is as it "
     "was."},
    {"remove", "Removes outfits from a wardrobe, without touching the other files.",
     "WARDROBE is a folder made by `ensemble tag`. After any error it is as it was."},
    {"report",
     "Counts faces and GPU bytes of a wardrobe stored by the three techniques: naive (template and "
     "garments), "
     "pre-fitted (a body cut to size for every outfit) and tagged (template, garments, and dedicated "
     "sub-meshes "
     "for regions that show in part). Single items are counted in all their combinations. Of a scene: what "
     "the "
     "combinations that its people wear store. Needs no Vulkan device.",
     "WARDROBE is a folder made by `ensemble tag`, or a scene (docs/scene.md). What is written is described "
     "in "
     "docs/measuring.md."},
    {"inspect",
     "Tells what is in a GLB, a wardrobe or a scene, and with --visible which faces of the body show.",
     "The file is only read."},
    {"scene", "Writes a scene with every key and what it means, to begin one's own with.",
     "The keys are described in docs/scene.md, too."},
    {"render", "Renders the frames of a scene, on Vulkan and without a window.",
     "SCENE is described in docs/scene.md; paths in it are relative to it. Each picture is written whole or "
     "not at all. The columns of a crowd table are described in docs/pictures.md. What items hide of one "
     "another "
     "is found when people first wear them so, and kept in the wardrobe's folder layers/ (docs/wardrobe.md); "
     "bench, and report of a scene, do likewise."},
    {"bench",
     "Draws a frame of a scene with each technique, by each rasteriser, in turn, round by round, and tells "
     "frame "
     "times, vertex invocations, triangles, draw calls and bytes, with ratios; of rasterisers also what "
     "share of "
     "the people each drew, poses that were kept, and how far their pictures are apart. Each round begins "
     "with "
     "another one; rounds of warm-up are not counted. With --frames each round draws the next frame, else "
     "all "
     "draw frame 0. It fails where tagged and pre-fitted give different pictures, or where a frame that is "
     "drawn "
     "again has another picture or other counts. The scene's `debug` is left out.",
     "SCENE is described in docs/scene.md; no picture is written. What is written is described in "
     "docs/measuring.md."},
    {"author",
     "Makes outfits for a template from recipes: shells offset from its skin, cut and coloured as the recipe "
     "says, moved by the template's joints. Any template with regions and joints will do. Each outfit holds "
     "the "
     "template's complete body, so `ensemble tag --occlusion auto` takes it.",
     "Reads recipes (docs/authoring.md) and a template. Writes FOLDER/NAME.glb for each recipe, whole or not "
     "at all."},
    {"people", "Makes template people with clips from parameters, and dresses them.",
     "CONFIG tells of each person sex, age (young, adult or old), height (1.4 to 2.1 metres), girth and "
     "build (-1 "
     "to 1), colours, and which of the program's own recipes to dress it in: docs/people.md. FOLDER/NAME "
     "gets "
     "template.glb and outfits/, whose files hold the complete body."},
};

/// Text broken at spaces into lines of at most kColumns, each after `indent`.
std::string wrapped(std::string_view text, std::size_t indent) {
  const std::string margin(indent, ' ');
  std::string lines, line = margin;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" \n"), text.size());
    const bool ends_line = end < text.size() && text[end] == '\n';
    const std::string_view word = text.substr(0, end);
    if (line.size() > indent && line.size() + 1 + word.size() > kColumns) {
      lines += line + "\n";
      line = margin;
    }
    if (!word.empty()) line += (line.size() > indent ? " " : "") + std::string(word);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!ends_line) continue;
    lines += line + "\n";
    line = margin;
  }
  return line.size() > indent ? lines + line + "\n" : lines;
}

/// "MM" of "MM:FLOAT in [0.001 - 10]" and "KIND" of "KIND:{a,b}".
std::string withoutChecks(const std::string& type) {
  for (std::size_t colon = type.find(':'); colon != std::string::npos; colon = type.find(':', colon + 1)) {
    const std::string rest = type.substr(colon + 1);
    if (rest.starts_with("{") || rest.find(" in [") != std::string::npos) return type.substr(0, colon);
  }
  return type;
}

}  // namespace

Manual manualOf(std::string_view name) {
  const auto found = std::find_if(std::begin(kManuals), std::end(kManuals),
                                  [&](const Manual& manual) { return manual.name == name; });
  return found == std::end(kManuals) ? Manual{name, "", ""} : *found;
}

std::string ManualFormatter::make_description(const CLI::App* app) const {
  std::string text = wrapped("ensemble " + app->get_name() + " - " + app->get_description(), 0);
  const std::string_view manual = manualOf(app->get_name()).text;
  if (!manual.empty()) text += "\n" + wrapped(manual, 0);
  return text + "\n";
}

std::string ManualFormatter::make_usage(const CLI::App* app, std::string name) const {
  std::string usage = CLI::Formatter::make_usage(app, std::move(name));
  while (!usage.empty() && usage.back() == '\n') usage.pop_back();
  for (const CLI::Option* option : app->get_options()) {
    if (!option->get_required() || option->get_positional()) continue;
    usage += " " + (option->get_snames().empty() ? "--" + option->get_lnames().front()
                                                 : "-" + option->get_snames().front());
    usage += " " + withoutChecks(option->get_type_name());
  }
  return wrapped(usage, 0);
}

std::string ManualFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  return "  " + make_option_name(option, is_positional) + make_option_opts(option) + "\n" +
         wrapped(make_option_desc(option), 6);
}

std::string ManualFormatter::make_option_opts(const CLI::Option* option) const {
  std::string type = withoutChecks(option->get_type_name());
  if (option->get_type_size() == 0 || type == make_option_name(option, true)) type.clear();
  return (type.empty() ? "" : " " + type) + (option->get_required() ? " (required)" : "");
}

std::string manualFooter(std::string_view name, const std::string& example) {
  std::string text;
  const std::string_view files = manualOf(name).files;
  if (!files.empty()) text += "Files:\n" + wrapped(files, 2) + "\n";
  return text +
         "Exit codes:\n"
         "  0  done\n"
         "  1  it could not be done: no Vulkan device, disk full, no right to write\n"
         "  2  wrong usage of the command line\n"
         "  3  invalid input\n"
         "  An error is one line that tells file, place, what is wrong, how to mend it.\n\n"
         "Example:\n  " +
         example;
}

}  // namespace ensemble::cli
