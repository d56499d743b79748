#include "cli/command.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/log.h"
#include "core/progress.h"

namespace ensemble::cli {

void finishCommand(CLI::App& command, CommonOptions& options, const std::string& example,
                   std::function<void()> run) {
  command.add_option("--json", options.json_file, "Write the figures as JSON to FILE; - is standard output")
      ->type_name("FILE");
  auto* quiet = command.add_flag("-q,--quiet", options.quiet, "Print errors only");
  command.add_flag("-v,--verbose", options.verbose, "Print details of every step")->excludes(quiet);
  command.footer("Example:\n  " + example);
  command.callback([&options, run = std::move(run)] {
    setLogLevel(options.quiet ? LogLevel::kQuiet : options.verbose ? LogLevel::kVerbose : LogLevel::kNormal);
    Progress::setEnabled(!options.quiet);
    run();
  });
}

void writeFigures(const CommonOptions& options, const nlohmann::ordered_json& figures) {
  if (options.json_file.empty()) return;
  const std::string text =
      figures.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
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
