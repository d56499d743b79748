// `--frames A-B,C`: which frames, in the order given.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ensemble::cli {

/// Numbers and inclusive ranges, parted by commas; each frame once, where it came first.
/// Empty text: 0 .. frame_count - 1. A frame beyond frame_count is at its time all the same.
/// @throws UsageError "--frames: ..." for anything else, or more than 1,000,000 frames
std::vector<std::uint32_t> parseFrames(const std::string& text, std::uint32_t frame_count);

}  // namespace ensemble::cli
