#include "cli/command.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/manual.h"
#include "core/atomic_file.h"
#include "core/log.h"
#include "core/progress.h"

namespace ensemble::cli {

namespace {

std::string figuresText(const nlohmann::ordered_json& figures) {
  return figures.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

void finishCommand(CLI::App& command, CommonOptions& options, const std::string& example,
                   std::function<void()> run) {
  command
      .add_option("--json", options.json_file,
                  "Write the figures as JSON to FILE; - is standard output, and then nothing else is printed "
                  "there (default: none)")
      ->type_name("FILE");
  auto* quiet = command.add_flag("-q,--quiet", options.quiet, "Print errors only; not together with -v");
  command.add_flag("-v,--verbose", options.verbose, "Print details of every step; not together with -q")
      ->excludes(quiet);
  command.formatter(std::make_shared<ManualFormatter>());
  command.footer(manualFooter(command.get_name(), example));
  command.callback([&options, run = std::move(run)] {
    setLogLevel(options.quiet ? LogLevel::kQuiet : options.verbose ? LogLevel::kVerbose : LogLevel::kNormal);
    Progress::setEnabled(!options.quiet);
    run();
  });
}

nlohmann::ordered_json figuresAsWritten(const nlohmann::ordered_json& figures) {
  return nlohmann::ordered_json::parse(figuresText(figures));
}

void writeFigures(const CommonOptions& options, const nlohmann::ordered_json& figures) {
  if (options.json_file.empty()) return;
  const std::string text = figuresText(figures);
  if (options.json_file == "-") {
    std::fputs(text.c_str(), stdout);
  } else {
    writeFileAtomically(options.json_file, std::string_view(text));
  }
}

void printResult(const CommonOptions& options, const std::string& text) {
  if (!options.quiet && options.json_file != "-") std::fputs(text.c_str(), stdout);
}

}  // namespace ensemble::cli
