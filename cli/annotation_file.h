// The file of `render --annotations`: one JSON document, a line for each frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "core/atomic_file.h"

namespace ensemble::cli {

/// Frames go to FILE.part as they are drawn, so that memory stays small and an interrupted run can be gone
/// on with; at the end FILE is made of it, written aside and renamed, and FILE.part is removed.
class AnnotationFile {
 public:
  /// @param header members of the document beside "frames"
  /// @param resume keep the frames that FILE.part and FILE hold, whole, under the same header
  /// @throws SystemError if FILE or FILE.part can't be written
  AnnotationFile(std::filesystem::path file, const nlohmann::ordered_json& header, bool resume);

  bool has(std::uint32_t frame) const { return lines_.contains(frame); }
  /// @param annotation an object that begins with "frame": its number @throws SystemError
  void add(std::uint32_t frame, const nlohmann::ordered_json& annotation);
  /// @param frames what the document lists, in this order; each was added or is one that it has
  /// @throws SystemError
  void finish(std::span<const std::uint32_t> frames);

 private:
  /// Where a frame's line lies, without a comma.
  struct Line {
    std::size_t file = 0;  ///< 0: FILE, 1: FILE.part
    std::uint64_t begin = 0, length = 0;
  };
  /// Takes down the whole lines of a file that begins with the header; returns where they end, 0 if it
  /// does not.
  std::uint64_t index(std::size_t number);
  void write(const std::string& text);

  std::filesystem::path file_, part_;
  FileAside aside_;
  std::string first_line_;
  std::map<std::uint32_t, Line> lines_;
  std::ofstream stream_;
  std::uint64_t written_ = 0;  ///< bytes of FILE.part
};

}  // namespace ensemble::cli
