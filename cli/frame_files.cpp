#include "cli/frame_files.h"

#include "core/atomic_file.h"
#include "core/input_error.h"
#include "renderer/finished_picture.h"
#include "renderer/picture_writer.h"

namespace ensemble::cli {
namespace {

bool holds(const std::filesystem::path& file, const std::string& text) {
  try {
    const std::vector<std::byte> bytes = readFile(file, text.size());
    return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()) == text;
  } catch (const UserError&) {
    return false;
  }
}

}  // namespace

FrameFiles::FrameFiles(FrameNames names, const SceneOutput& output, FrameFilesOptions options)
    : names_(std::move(names)), options_(std::move(options)), width_(output.width), height_(output.height) {
  names_.createFolder();
  if (names_.format() == PictureFormat::kVideo) {
    video_ = std::make_unique<VideoWriter>(names_.picture(0), width_, height_, frameRateOf(output.fps));
  }
}

bool FrameFiles::areFinished(std::uint32_t frame) const {
  const std::filesystem::path picture = names_.picture(frame);
  switch (names_.format()) {
    case PictureFormat::kPng:
      if (!isFinishedPng(picture, width_, height_)) return false;
      break;
    case PictureFormat::kExr:
      if (!isFinishedExr(picture, width_, height_, exrChannelsOfLight())) return false;
      break;
    case PictureFormat::kVideo:
      return false;
  }
  for (const Aov aov : options_.aovs) {
    if (!isFinishedExr(names_.aov(frame, aov), width_, height_, exrChannelsOf(aov))) return false;
  }
  return options_.aovs.empty() || holds(names_.ids(frame), options_.ids);
}

void FrameFiles::write(std::uint32_t frame, const Picture& picture) {
  switch (names_.format()) {
    case PictureFormat::kPng:
      writePicture(names_.picture(frame), picture.color);
      break;
    case PictureFormat::kExr:
      writeLinearPicture(names_.picture(frame), width_, height_, picture.linear);
      break;
    case PictureFormat::kVideo:
      video_->add(picture.color);
      break;
  }
  for (const Aov aov : options_.aovs) writeAov(frame, aov, picture);
  if (!options_.aovs.empty()) writeFileAtomically(names_.ids(frame), std::string_view(options_.ids));
}

void FrameFiles::writeAov(std::uint32_t frame, Aov aov, const Picture& picture) const {
  const std::filesystem::path file = names_.aov(frame, aov);
  switch (aov) {
    case Aov::kCharacter:
      return writeIdAov(file, aov, width_, height_, picture.character);
    case Aov::kRegion:
      return writeIdAov(file, aov, width_, height_, picture.region);
    case Aov::kFace:
      return writeIdAov(file, aov, width_, height_, picture.face);
    case Aov::kDepth:
      return writeFloatAov(file, aov, width_, height_, picture.depth);
    case Aov::kNormal:
      return writeFloatAov(file, aov, width_, height_, picture.normal);
  }
}

void FrameFiles::finish() {
  if (video_) video_->finish();
}

}  // namespace ensemble::cli
