// `ensemble report`: what tagging saves.
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "assetpipe/report.h"
#include "cli/command.h"
#include "cli/report_page.h"
#include "core/atomic_file.h"

namespace ensemble::cli {
namespace {

struct ReportArguments {
  CommonOptions common;
  std::string wardrobe, csv_file, html_file;
  std::uint64_t extrapolate = 0;
};

/// The last part of a path, also where that ends with a slash or is `.`.
std::string folderName(const std::filesystem::path& folder) {
  return std::filesystem::weakly_canonical(folder).filename().string();
}

void run(const ReportArguments& arguments) {
  const Wardrobe wardrobe = loadWardrobe(arguments.wardrobe);
  const Report report = makeReport(wardrobe, arguments.extrapolate);
  nlohmann::ordered_json figures = toJson(report);
  figures["wardrobe"] = folderName(arguments.wardrobe);
  writeFigures(arguments.common, figures);
  if (!arguments.csv_file.empty()) writeFileAtomically(arguments.csv_file, std::string_view(toCsv(report)));
  if (!arguments.html_file.empty()) {
    const std::string page = reportPage(figuresAsWritten(figures));
    writeFileAtomically(arguments.html_file, std::string_view(page));
  }
  printResult(arguments.common, toTable(report));
}

}  // namespace

void addReportCommand(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("report", "Compare the storage of naive, pre-fitted and tagged outfits");
  const auto arguments = std::make_shared<ReportArguments>();
  command.add_option("WARDROBE", arguments->wardrobe, "The wardrobe's folder")
      ->required()
      ->type_name("FOLDER");
  command.add_option("--csv", arguments->csv_file, "Write the figures as one CSV table (default: none)")
      ->type_name("FILE");
  command
      .add_option("--html", arguments->html_file,
                  "Write a page with plots and tables of the figures: one file, no scripts (default: none)")
      ->type_name("FILE");
  command
      .add_option("--extrapolate", arguments->extrapolate,
                  "Also count the faces of 1 to N outfits, extrapolated from the mean outfit as in figure 6 "
                  "of Lister, "
                  "Laycock and Day; 1 to 1000000 (default: none)")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  finishCommand(command, arguments->common,
                "ensemble report wardrobes/women --extrapolate 20 --html report.html",
                [arguments] { run(*arguments); });
}

}  // namespace ensemble::cli
