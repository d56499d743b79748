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

/// Nothing where there is no such file.
inline std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs `ensemble ARGUMENTS` through the shell, in `folder`. Quoting is the caller's.
inline ProgramResult runProgram(const std::string& arguments, const std::filesystem::path& folder) {
  const TemporaryFolder capture;
  const std::string command = "cd '" + folder.string() + "' && '" ENSEMBLE_PROGRAM "' " + arguments + " > '" +
                              (capture / "out").string() + "' 2> '" + (capture / "err").string() +
                              "' < /dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytesOf(capture / "out"), bytesOf(capture / "err")};
}

/// Whether the program finds a Vulkan device.
inline bool hasVulkanDevice() {
  return runProgram("--version", ".").out.find("Vulkan device: none") == std::string::npos;
}

/// Twelve people of the kept wardrobe of version 1, side by side in a picture of 96 x 64. @param frames 10 a
/// second
inline void writeTwelvePeople(const std::filesystem::path& scene, int frames) {
  std::ofstream(scene) << "version: 1\nwardrobe: "
                       << std::filesystem::absolute("tests/formats/wardrobe-1").string()
                       << "\noutput: {width: 96, height: 64, samples: 4, frames: " << frames
                       << ", fps: 10}\n"
                          "crowd: {count: 12, seed: 3, placement: {spacing: 0.7}}\n"
                          "camera: {position: [0, 1.6, 4], target: [0, 0.9, 0]}\n";
}

}  // namespace ensemble::testing
