// Runs the built program as a user would.
#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/temporary_folder.h"

namespace ensemble::testing {

struct ProgramResult {
  int exit_code = -1;
  std::string out, err;
};

/// Runs `ensemble ARGUMENTS` through the shell, in `folder`. Quoting is the caller's.
inline ProgramResult runProgram(const std::string& arguments, const std::filesystem::path& folder) {
  const TemporaryFolder capture;
  const std::string command = "cd '" + folder.string() + "' && '" ENSEMBLE_PROGRAM "' " + arguments + " > '" +
                              (capture / "out").string() + "' 2> '" + (capture / "err").string() +
                              "' < /dev/null";
  const int status = std::system(command.c_str());
  const auto text = [](const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text(capture / "out"), text(capture / "err")};
}

}  // namespace ensemble::testing
