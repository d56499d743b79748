// What every subcommand shares. One cmd_NAME.cpp each; main.cpp is the table of them.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ensemble::cli {

/// The options that every subcommand has.
struct CommonOptions {
  std::string json_file;  ///< --json FILE; "-" is standard output; empty: none
  bool quiet = false;
  bool verbose = false;
};

/// Adds --json, -q, -v and a help footer with one example, and calls `run` when the subcommand is
/// chosen, with log level and progress bar set. `options` must outlive the command.
void finishCommand(CLI::App& command, CommonOptions& options, const std::string& example,
                   std::function<void()> run);

/// Writes the figures where --json says; nothing where it was not given.
void writeFigures(const CommonOptions& options, const nlohmann::ordered_json& figures);

/// The figures as the JSON file has them: names from files that are no UTF-8 made readable.
nlohmann::ordered_json figuresAsWritten(const nlohmann::ordered_json& figures);

/// Prints a result for people on standard output; nothing with --quiet or where JSON goes there.
void printResult(const CommonOptions& options, const std::string& text);

void addTagCommand(CLI::App& app);
void addAddCommand(CLI::App& app);
void addRemoveCommand(CLI::App& app);
void addReportCommand(CLI::App& app);
void addInspectCommand(CLI::App& app);
void addRenderCommand(CLI::App& app);
void addBenchCommand(CLI::App& app);
void addAuthorCommand(CLI::App& app);
void addPeopleCommand(CLI::App& app);
void addSceneCommand(CLI::App& app);

}  // namespace ensemble::cli
