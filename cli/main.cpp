// `ensemble`: the table of subcommands, and the one place where errors become exit codes.
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include "cli/command.h"
#include "cli/version.h"
#include "core/exit_code.h"
#include "core/input_error.h"

namespace {

using ensemble::ExitCode;

int fail(ExitCode code, const std::string& line) {
  std::fflush(stdout);
  std::fprintf(stderr, "ensemble: %s\n", line.c_str());
  return static_cast<int>(code);
}

int run(int argc, char** argv) {
  using namespace ensemble::cli;
  CLI::App app("Dresses one template person in many outfits and renders crowds of them.", "ensemble");
  app.require_subcommand(1);
  app.set_version_flag(
      "--version", [] { return versionText(); }, "Print version, build type and Vulkan device");
  for (const auto add : {addTagCommand, addAddCommand, addRemoveCommand, addReportCommand, addInspectCommand,
                         addSceneCommand, addRenderCommand, addBenchCommand, addPeopleCommand}) {
    add(app);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& request) {
    return app.exit(request);
  } catch (const CLI::CallForVersion& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    return fail(ExitCode::kWrongUsage, std::string(error.what()) + "; see `ensemble --help`");
  }
  if (std::fflush(stdout) != 0) {
    return fail(ExitCode::kFailed, std::string("standard output can't be written: ") + std::strerror(errno));
  }
  return static_cast<int>(ExitCode::kDone);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const ensemble::UserError& error) {
    return fail(error.exitCode(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::kFailed, "out of memory; use smaller input or a machine with more");
  } catch (const std::exception& error) {
    return fail(ExitCode::kFailed, std::string("a bug in ensemble: ") + error.what() + "; please report it");
  }
}
