// What the files of a frame are called: `-o` and what is derived from it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ensemble {

/// A further picture of a frame (interfaces.md, --aov).
enum class Aov : std::uint8_t { kCharacter, kRegion, kFace, kDepth, kNormal };
inline constexpr Aov kAllAovs[] = {Aov::kCharacter, Aov::kRegion, Aov::kFace, Aov::kDepth, Aov::kNormal};
const char* toString(Aov aov);  ///< "character", "region", "face", "depth", "normal"

/// "character,depth" -> kinds, each once, in the order of kAllAovs. Empty for an empty text.
/// @throws UsageError "--aov ...: ..." for an unknown kind, naming the nearest.
std::vector<Aov> parseAovs(const std::string& list);

/// What the colour of a frame becomes.
enum class PictureFormat : std::uint8_t {
  kPng,    ///< 8-bit sRGB
  kExr,    ///< linear light
  kVideo,  ///< a frame of the one MP4
};

/// Where the frames of `render -o PATH` go.
///
/// `dir/` (or an existing folder): dir/frame_0000.png and on; `name_%04d.png` or `.exr`: the frame's
/// number in place of the one `%d` or `%04d` in the file's name, `%%` being a percent sign; `name.png` or
/// `.exr`: one frame; `name.mp4`: all of them, and what each has besides is named name_0000.
class FrameNames {
 public:
  /// @param frame_count frames that will be written
  /// @throws UsageError "-o PATH: ..." for a pattern, an extension or a number of frames it can't be.
  FrameNames(const std::string& output, std::uint32_t frame_count);

  PictureFormat format() const { return format_; }
  std::filesystem::path picture(std::uint32_t frame) const;        ///< the video, where it is one
  std::filesystem::path aov(std::uint32_t frame, Aov aov) const;   ///< NAME.character.exr
  std::filesystem::path ids(std::uint32_t frame) const;            ///< NAME.ids.json
  const std::filesystem::path& folder() const { return folder_; }  ///< empty: the current one
  /// Makes the folder and those above it, if they are missing. @throws SystemError
  void createFolder() const;

 private:
  std::string stem(std::uint32_t frame) const;
  void parsePattern(const std::string& output, std::string_view stem);

  std::filesystem::path folder_;
  std::string before_, after_;  ///< of the number, without the extension
  PictureFormat format_ = PictureFormat::kPng;
  bool is_numbered_ = false;
  int digits_ = 0;  ///< least digits, filled with zeros
};

}  // namespace ensemble
