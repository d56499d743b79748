#include "renderer/frame_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/input_error.h"
#include "core/nearest_name.h"

namespace ensemble {
namespace {

constexpr int kMaxDigits = 9;

[[noreturn]] void fail(const std::string& output, const std::string& what, const std::string& mend) {
  throw UsageError({"", "-o " + output, what, mend});
}

std::string lowerCase(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

PictureFormat formatOf(const std::string& output, const std::string& extension) {
  const std::string lower = lowerCase(extension);
  if (lower == ".png") return PictureFormat::kPng;
  if (lower == ".exr") return PictureFormat::kExr;
  if (lower == ".mp4") return PictureFormat::kVideo;
  if (lower.empty()) {
    fail(output, "the name has no extension",
         fmt::format("write {}/ for a folder, or {}.png", output, output));
  }
  fail(output, fmt::format("pictures can't be written as {}", quotedName(extension)),
       "write .png, .exr or .mp4: name.png, name_%04d.exr, name.mp4, or a folder dir/");
}

const char* extensionOf(PictureFormat format) {
  switch (format) {
    case PictureFormat::kPng:
      return ".png";
    case PictureFormat::kExr:
      return ".exr";
    case PictureFormat::kVideo:
      return ".mp4";
  }
  return "";
}

/// What follows a '%': "%" itself, or a number's width.
struct Conversion {
  bool is_percent = false;
  int digits = 0;
  std::size_t length = 0;  ///< with the '%'
};

std::optional<Conversion> parseConversion(std::string_view text) {
  Conversion conversion;
  std::size_t at = 1;
  if (at < text.size() && text[at] == '%') return Conversion{true, 0, 2};
  if (at < text.size() && text[at] == '0') {
    ++at;
    if (at == text.size() || text[at] < '1' || text[at] > '0' + kMaxDigits) return std::nullopt;
    conversion.digits = text[at++] - '0';
  }
  if (at == text.size() || text[at] != 'd') return std::nullopt;
  conversion.length = at + 1;
  return conversion;
}

}  // namespace

const char* toString(Aov aov) {
  switch (aov) {
    case Aov::kCharacter:
      return "character";
    case Aov::kRegion:
      return "region";
    case Aov::kFace:
      return "face";
    case Aov::kDepth:
      return "depth";
    case Aov::kNormal:
      return "normal";
  }
  return "";
}

std::vector<Aov> parseAovs(const std::string& list) {
  std::vector<std::string> known;
  for (const Aov aov : kAllAovs) known.emplace_back(toString(aov));
  std::vector<bool> wanted(known.size(), false);
  for (std::size_t at = 0; at < list.size();) {
    const std::size_t comma = std::min(list.find(',', at), list.size());
    const std::string name = list.substr(at, comma - at);
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end() || comma + 1 == list.size()) {
      const std::string shown = found == known.end() ? name : "";
      throw UsageError({"", "--aov " + list, fmt::format("there is no kind {}", quotedName(shown)),
                        fmt::format("write {} (known: {})", quotedName(nearestNames(shown, known).front()),
                                    fmt::join(known, ", "))});
    }
    wanted[static_cast<std::size_t>(found - known.begin())] = true;
    at = comma + 1;
  }
  std::vector<Aov> aovs;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i]) aovs.push_back(kAllAovs[i]);
  }
  return aovs;
}

FrameNames::FrameNames(const std::string& output, std::uint32_t frame_count) {
  if (output.empty()) fail(output, "the path is empty", "write a folder dir/, name_%04d.png or name.png");
  const std::filesystem::path path(output);
  std::error_code ignored;
  if (!path.has_filename() || path.filename() == "." || path.filename() == ".." ||
      std::filesystem::is_directory(path, ignored)) {
    folder_ = path;
    before_ = "frame_";
    is_numbered_ = true;
    digits_ = 4;
    return;
  }
  folder_ = path.parent_path();
  const std::string name = path.filename().string();
  const std::string extension = path.extension().string();
  format_ = formatOf(output, extension);
  parsePattern(output, std::string_view(name).substr(0, name.size() - extension.size()));
  if (format_ == PictureFormat::kVideo) {
    if (is_numbered_) fail(output, "a video holds all frames", "write name.mp4 without a frame's number");
    digits_ = 4;
    return;
  }
  if (is_numbered_ || frame_count <= 1) return;
  fail(output, fmt::format("{} frames don't fit one file", frame_count),
       fmt::format("write {}_%04d{}", output.substr(0, output.size() - extension.size()),
                   extensionOf(format_)));
}

void FrameNames::parsePattern(const std::string& output, std::string_view stem) {
  while (!stem.empty()) {
    std::string& part = is_numbered_ ? after_ : before_;
    if (stem[0] != '%') {
      part += stem[0];
      stem.remove_prefix(1);
      continue;
    }
    const std::optional<Conversion> conversion = parseConversion(stem);
    if (!conversion) {
      fail(output, "a '%' that is followed by neither d nor 0Nd (N from 1 to 9)",
           "write %04d for the frame's number, %% for a percent sign");
    }
    stem.remove_prefix(conversion->length);
    if (conversion->is_percent) {
      part += '%';
    } else if (is_numbered_) {
      fail(output, "the frame's number is there twice", "write %04d once");
    } else {
      is_numbered_ = true;
      digits_ = conversion->digits;
    }
  }
}

void FrameNames::createFolder() const {
  if (folder_.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) {
    throw SystemError({folder_.string(), "", "can't make the folder: " + error.message(),
                       "give a folder that can be written to"});
  }
}

std::string FrameNames::stem(std::uint32_t frame) const {
  if (format_ == PictureFormat::kVideo) return fmt::format("{}_{:0{}}", before_, frame, digits_);
  return is_numbered_ ? fmt::format("{}{:0{}}{}", before_, frame, digits_, after_) : before_;
}

std::filesystem::path FrameNames::picture(std::uint32_t frame) const {
  const std::string name = format_ == PictureFormat::kVideo ? before_ : stem(frame);
  return folder_ / (name + extensionOf(format_));
}

std::filesystem::path FrameNames::aov(std::uint32_t frame, Aov aov) const {
  return folder_ / fmt::format("{}.{}.exr", stem(frame), toString(aov));
}

std::filesystem::path FrameNames::ids(std::uint32_t frame) const {
  return folder_ / (stem(frame) + ".ids.json");
}

}  // namespace ensemble
