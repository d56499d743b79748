// Whether a picture's file is there, complete and of the right size: what `--resume` need not draw again.
// Files are written aside and renamed, so that what is missing is mostly the whole file; these checks
// are cheap and find what was cut off, not every damaged byte.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace ensemble {

/// A PNG of this size from its signature to its last chunk.
bool isFinishedPng(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height);

/// An OpenEXR file of this size with exactly these channels (sorted by name), whose last scan line
/// can be read.
bool isFinishedExr(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height,
                   std::span<const char* const> channels);

}  // namespace ensemble
