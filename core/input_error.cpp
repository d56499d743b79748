#include "core/input_error.h"

#include <utility>

namespace ensemble {
namespace {

void appendPart(std::string& line, const std::string& part, const char* separator) {
  if (part.empty()) return;
  if (!line.empty()) line += separator;
  for (const char c : part) {
    const auto byte = static_cast<unsigned char>(c);
    line += byte < 0x20 || byte == 0x7f ? '?' : c;
  }
}

}  // namespace

UserError::UserError(ExitCode exit_code, ErrorText text) : exit_code_(exit_code), text_(std::move(text)) {
  appendPart(line_, text_.file, ": ");
  appendPart(line_, text_.where, ": ");
  appendPart(line_, text_.what, ": ");
  appendPart(line_, text_.mend, "; ");
}

}  // namespace ensemble
