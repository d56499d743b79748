// Frames as an H.264 video in an MP4 file, through FFmpeg's libraries.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "core/image_file.h"
#include "core/scene.h"

namespace ensemble {

/// A number of frames a second as a fraction in lowest terms.
struct FrameRate {
  int numerator = 30, denominator = 1;
  bool operator==(const FrameRate&) const = default;
};

/// The decimal fraction that a scene's `fps` was written as: 29.97 is 2997/100, not 30000/1001.
/// @pre fps is finite and above 0
FrameRate frameRateOf(float fps);

/// What of a scene's output an H.264 video of 4:2:0 colour can't hold: odd sides, and transparency.
/// @param output the path as the user gave it @throws UsageError "-o PATH: ..."
void checkVideo(const std::string& output, const SceneOutput& scene);

/// A video of constant frame rate: BT.709, limited range, 4:2:0, x264 at constant quality (crf 18) on one
/// thread. The same frames give the same bytes. Nothing is at `file` before finish() has returned, and
/// what was written aside is gone if it never did.
class VideoWriter {
 public:
  /// @pre checkVideo() let the size pass
  /// @throws SystemError if the file can't be written or FFmpeg lacks an H.264 encoder
  VideoWriter(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height, FrameRate rate);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// The next frame; its alpha is left out. @pre it has the video's size @throws SystemError
  void add(const Image8& frame);
  /// Writes what is still to be written, and puts the file in its place. @throws SystemError
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ensemble
