#include "cli/frame_files.h"

#include "core/atomic_file.h"
#include "core/image_file.h"
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

std::vector<EncodedFile> FrameFiles::encode(std::uint32_t frame, const Picture& picture) const {
  std::vector<EncodedFile> files;
  switch (names_.format()) {
    case PictureFormat::kPng:
      files.push_back({names_.picture(frame), encodePng(picture.color)});
      break;
    case PictureFormat::kExr:
      files.push_back({names_.picture(frame), encodeLinearPicture(width_, height_, picture.linear)});
      break;
    case PictureFormat::kVideo:
      break;
  }
  for (const Aov aov : options_.aovs) files.push_back({names_.aov(frame, aov), encodeAov(aov, picture)});
  return files;
}

void FrameFiles::write(std::uint32_t frame, const Picture& picture, const std::vector<EncodedFile>& files) {
  if (video_) video_->add(picture.color);
  for (const EncodedFile& file : files) writeFileAtomically(file.file, file.bytes);
  if (!options_.aovs.empty()) writeFileAtomically(names_.ids(frame), std::string_view(options_.ids));
}

std::vector<std::byte> FrameFiles::encodeAov(Aov aov, const Picture& picture) const {
  switch (aov) {
    case Aov::kCharacter:
      return encodeIdAov(aov, width_, height_, picture.character);
    case Aov::kRegion:
      return encodeIdAov(aov, width_, height_, picture.region);
    case Aov::kFace:
      return encodeIdAov(aov, width_, height_, picture.face);
    case Aov::kDepth:
      return encodeFloatAov(aov, width_, height_, picture.depth);
    case Aov::kNormal:
      return encodeFloatAov(aov, width_, height_, picture.normal);
  }
  return {};
}

void FrameFiles::finish() {
  if (video_) video_->finish();
}

}  // namespace ensemble::cli
