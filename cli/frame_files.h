// The files of a frame: picture, AOVs and what explains them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "renderer/frame_names.h"
#include "renderer/video_writer.h"
#include "renderer/view.h"

namespace ensemble::cli {

/// What `render` writes of each frame.
struct FrameFilesOptions {
  std::vector<Aov> aovs = {};
  std::string ids = {};  ///< the content of NAME.ids.json; written where there are AOVs
};

/// A file that is still to be written.
struct EncodedFile {
  std::filesystem::path file;
  std::vector<std::byte> bytes;
};

class FrameFiles {
 public:
  /// Makes the folder, and begins the video if there is to be one.
  /// @throws SystemError if nothing can be written there
  FrameFiles(FrameNames names, const SceneOutput& output, FrameFilesOptions options);

  /// Whether all files of a frame are there, complete, of the right size, and explained by the same IDs.
  /// A video's never are.
  bool areFinished(std::uint32_t frame) const;
  /// A frame's files, in the order in which they are to be written; without a video's picture. May be called
  /// from several threads. @throws SystemError if a picture can't be encoded
  std::vector<EncodedFile> encode(std::uint32_t frame, const Picture& picture) const;
  /// Writes what `encode` made of a frame; a video takes the picture now.
  /// @throws SystemError if a file can't be written
  void write(std::uint32_t frame, const Picture& picture, const std::vector<EncodedFile>& files);
  /// Ends the video, if there is one. @throws SystemError
  void finish();

 private:
  std::vector<std::byte> encodeAov(Aov aov, const Picture& picture) const;

  FrameNames names_;
  FrameFilesOptions options_;
  std::uint32_t width_, height_;
  std::unique_ptr<VideoWriter> video_;
};

}  // namespace ensemble::cli
