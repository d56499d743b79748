#include "cli/annotation_file.h"

#include <cerrno>
#include <charconv>

#include "core/check.h"
#include "core/input_error.h"

namespace ensemble::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFrame = "{\"frame\":";

std::string dumpLine(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// The number of a frame's line, if it is a whole one.
std::optional<std::uint32_t> frameOf(std::string_view line) {
  if (!line.starts_with(kFrame) || !Json::accept(line)) return std::nullopt;
  std::uint32_t frame = 0;
  const std::string_view number = line.substr(kFrame.size());
  if (std::from_chars(number.data(), number.data() + number.size(), frame).ec != std::errc())
    return std::nullopt;
  return frame;
}

}  // namespace

AnnotationFile::AnnotationFile(std::filesystem::path file, const Json& header, bool resume)
    : file_(std::move(file)), part_(file_.string() + ".part"), aside_(file_) {
  first_line_ = dumpLine(header);
  first_line_.pop_back();
  first_line_ += ",\"frames\":[\n";
  if (resume) {
    index(0);
    written_ = index(1);
  }
  if (written_ != 0) {
    // A line that a kill cut off goes.
    std::error_code error;
    std::filesystem::resize_file(part_, written_, error);
    if (error) failWriting(part_, error.value());
    stream_.open(part_, std::ios::binary | std::ios::app);
  } else {
    stream_.open(part_, std::ios::binary | std::ios::trunc);
  }
  if (!stream_) failWriting(part_, errno);
  if (written_ == 0) write(first_line_);
}

std::uint64_t AnnotationFile::index(std::size_t number) {
  std::ifstream stream(number == 0 ? file_ : part_, std::ios::binary);
  std::string line;
  if (!std::getline(stream, line) || stream.eof() || line + "\n" != first_line_) return 0;
  std::uint64_t begin = first_line_.size();
  while (std::getline(stream, line) && !stream.eof()) {
    const std::uint64_t end = begin + line.size() + 1;
    if (line.ends_with(',')) line.pop_back();
    const std::optional<std::uint32_t> frame = frameOf(line);
    if (!frame) break;
    lines_[*frame] = {.file = number, .begin = begin, .length = line.size()};
    begin = end;
  }
  return begin;
}

void AnnotationFile::write(const std::string& text) {
  stream_ << text << std::flush;
  if (!stream_) failWriting(part_, errno);
  written_ += text.size();
}

void AnnotationFile::add(std::uint32_t frame, const Json& annotation) {
  const std::string line = dumpLine(annotation);
  lines_[frame] = {.file = 1, .begin = written_, .length = line.size()};
  write(line + ",\n");
}

void AnnotationFile::finish(std::span<const std::uint32_t> frames) {
  stream_.close();
  std::ifstream sources[2] = {std::ifstream(file_, std::ios::binary), std::ifstream(part_, std::ios::binary)};
  stream_.open(aside_.aside(), std::ios::binary | std::ios::trunc);
  if (!stream_) failWriting(file_, errno);
  stream_ << first_line_;
  std::string text;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Line& line = lines_.at(frames[i]);
    std::ifstream& source = sources[line.file];
    text.resize(line.length);
    source.seekg(static_cast<std::streamoff>(line.begin));
    if (!source.read(text.data(), static_cast<std::streamsize>(text.size()))) {
      throw SystemError({part_.string(), "", "can't be read again", "render again without --resume"});
    }
    stream_ << text << (i + 1 < frames.size() ? ",\n" : "\n");
  }
  stream_ << "]}\n";
  stream_.close();
  if (!stream_) failWriting(file_, errno);
  aside_.commit();
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

}  // namespace ensemble::cli
