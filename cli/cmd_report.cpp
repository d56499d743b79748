// `ensemble report`: what tagging saves.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "assetpipe/report.h"
#include "cli/command.h"
#include "core/atomic_file.h"

namespace ensemble::cli {
namespace {

struct ReportArguments {
  CommonOptions common;
  std::string wardrobe, csv_file;
  std::uint64_t extrapolate = 0;
};

void run(const ReportArguments& arguments) {
  const Wardrobe wardrobe = loadWardrobe(arguments.wardrobe);
  const Report report = makeReport(wardrobe);
  nlohmann::ordered_json figures = toJson(report);
  std::string text = toTable(report);
  if (arguments.extrapolate > 0) {
    const StoredFaces faces =
        extrapolateStoredFaces(report.template_faces, report.outfits, arguments.extrapolate);
    figures["extrapolated"] = {{"outfits", arguments.extrapolate}};
    text += fmt::format("\n{} outfits of average size:", arguments.extrapolate);
    for (const Technique technique : kAllTechniques) {
      figures["extrapolated"][toString(technique)] = faces[technique];
      text += fmt::format(" {} {}", toString(technique), faces[technique]);
    }
    const double share = static_cast<double>(faces[Technique::kTagged]) /
                         static_cast<double>(std::max<std::uint64_t>(faces[Technique::kPrefitted], 1));
    figures["extrapolated"]["tagged_vs_prefitted"] = share;
    text += fmt::format(" faces; tagged needs {:.1f} % of prefitted\n", share * 100.0);
  }
  writeFigures(arguments.common, figures);
  if (!arguments.csv_file.empty()) writeFileAtomically(arguments.csv_file, std::string_view(toCsv(report)));
  printResult(arguments.common, text);
}

}  // namespace

void addReportCommand(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("report", "Compare the storage of naive, pre-fitted and tagged outfits");
  const auto arguments = std::make_shared<ReportArguments>();
  command.add_option("WARDROBE", arguments->wardrobe, "The wardrobe's folder")
      ->required()
      ->type_name("FOLDER");
  command.add_option("--csv", arguments->csv_file, "Write the table as CSV")->type_name("FILE");
  command
      .add_option("--extrapolate", arguments->extrapolate,
                  "Also count N outfits of average size, 1 to 1000000")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  finishCommand(command, arguments->common, "ensemble report wardrobes/women --json report.json",
                [arguments] { run(*arguments); });
}

}  // namespace ensemble::cli
