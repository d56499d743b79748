// The exit codes of the program, fixed for the scripts that call it.
#pragma once

namespace ensemble {

enum class ExitCode : int {
  kDone = 0,          ///< everything asked for was done
  kFailed = 1,        ///< it could not be done: no Vulkan device, disk full, I/O
  kWrongUsage = 2,    ///< the command line is wrong
  kInvalidInput = 3,  ///< a file that was read is invalid
};

}  // namespace ensemble
