// `ensemble`: the table of subcommands, and the one place where errors become exit codes.
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>

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

constexpr char kOutOfMemory[] = "ensemble: out of memory; use smaller input or a machine with more\n";

/// Ends the program where no memory is left. Not every library that we call outlasts a failed
/// allocation (valijson aborts or crashes, nlohmann's destructors allocate), and there is nothing to
/// save: files are written aside and renamed. Allocates nothing itself.
[[noreturn]] void endWithoutMemory() {
  static std::atomic_flag is_told;
  while (is_told.test_and_set()) pause();  // another thread tells, and ends the process
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kOutOfMemory, sizeof kOutOfMemory - 1);
  std::_Exit(static_cast<int>(ExitCode::kFailed));
}

int run(int argc, char** argv) {
  using namespace ensemble::cli;
  CLI::App app("Dresses one template person in many outfits and renders crowds of them.", "ensemble");
  app.require_subcommand(1);
  app.set_version_flag(
      "--version", [] { return versionText(); }, "Print version, build type and Vulkan device");
  for (const auto add :
       {addTagCommand, addAddCommand, addRemoveCommand, addReportCommand, addInspectCommand, addSceneCommand,
        addRenderCommand, addBenchCommand, addAuthorCommand, addPeopleCommand}) {
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
  std::set_new_handler(endWithoutMemory);
  try {
    return run(argc, argv);
  } catch (const ensemble::UserError& error) {
    return fail(error.exitCode(), error.what());
  } catch (const std::filesystem::filesystem_error& error) {  // a path that can't even be looked at
    return fail(ExitCode::kFailed,
                error.path1().string() + ": can't be used: " + error.code().message() + "; check the path");
  } catch (const std::bad_alloc&) {  // a size that no machine has
    endWithoutMemory();
  } catch (const std::system_error& error) {  // no more threads
    return fail(ExitCode::kFailed, std::string("the system refused: ") + error.what() +
                                       "; close other programs and run it again");
  } catch (const std::exception& error) {
    return fail(ExitCode::kFailed, std::string("a bug in ensemble: ") + error.what() + "; please report it");
  }
}
