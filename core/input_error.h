// Errors that a user can mend. A caller's bug is no such error: see check.h.
//
// Libraries throw them and never exit; they are caught in two places only, cli/main.cpp and the
// server's request handler, which print `ensemble: FILE: WHERE: WHAT; HOW TO MEND`.
#pragma once

#include <exception>
#include <string>

#include "core/exit_code.h"

namespace ensemble {

/// What every error message is made of. `file` and `where` may be empty and are then left out.
struct ErrorText {
  std::string file;   ///< path as the user gave it
  std::string where;  ///< line:column in YAML, a JSON pointer in glTF and JSON
  std::string what;   ///< what is wrong, without a full stop
  std::string mend;   ///< how to mend it, an imperative without a full stop; may be empty
};

/// Base of the three kinds; `what()` is the one line `FILE: WHERE: WHAT; HOW TO MEND`. Line breaks
/// and other control characters in the parts (names from hostile files) are printed as `?`.
class UserError : public std::exception {
 public:
  UserError(ExitCode exit_code, ErrorText text);
  const char* what() const noexcept override { return line_.c_str(); }
  ExitCode exitCode() const noexcept { return exit_code_; }
  const ErrorText& text() const noexcept { return text_; }

 private:
  ExitCode exit_code_;
  ErrorText text_;
  std::string line_;
};

/// A file that was read is invalid: exit code 3.
class InputError : public UserError {
 public:
  explicit InputError(ErrorText text) : UserError(ExitCode::kInvalidInput, std::move(text)) {}
};

/// The machine can't do it (I/O, no device, out of memory): exit code 1.
class SystemError : public UserError {
 public:
  explicit SystemError(ErrorText text) : UserError(ExitCode::kFailed, std::move(text)) {}
};

/// The command line is wrong: exit code 2.
class UsageError : public UserError {
 public:
  explicit UsageError(ErrorText text) : UserError(ExitCode::kWrongUsage, std::move(text)) {}
};

}  // namespace ensemble
