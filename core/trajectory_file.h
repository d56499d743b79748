// Walkers' trajectories: the text format of JuPedSim and of the pedestrian dynamics data archive.
//
//   # framerate: 25.00
//   # id frame x/m y/m z/m
//   1 0 -2.50 0.75 0
//   1 1 -2.46 0.75 0
//
// One sample a line: person, frame, place; fields are parted by blanks or tabs, z may be left out (0).
// The person's frames ascend; the order of people is free. Lines that begin with `#` are comments, and
// those before the first sample may tell the frame rate (`framerate: 25`, `fps: 25`), the unit (`x/cm`,
// `in cm`, `unit: cm`; metres otherwise) and the columns. Columns after these are not read.
//
// The format's ground plane is x, y, and z is up; ours is +Y up: a sample stands at (x, z, -y).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"

namespace ensemble {

/// One person's way: a position for every frame from `first_frame` on, at least one.
struct Trajectory {
  std::uint32_t id = 0;  ///< as in the file
  std::uint32_t first_frame = 0;
  std::vector<Vec3> positions;  ///< metres, +Y up, ground at y = 0 where the file's z is 0
};

struct Trajectories {
  float fps = 0.0f;                   ///< 0 where the file names none
  std::vector<Trajectory> people;     ///< by ascending id, at least one
  std::vector<std::string> warnings;  ///< for the log: columns not read, frames interpolated
};

/// What a file may cost and claim.
struct TrajectoryLimits {
  std::uint64_t max_bytes = 1ull << 30;
  std::size_t max_line_bytes = 4096;
  std::size_t max_people = 100'000;
  std::size_t max_samples = 20'000'000;  ///< interpolated ones included
  /// Frames that may be missing in a row inside a person's way; they are interpolated linearly.
  std::uint32_t max_gap_frames = 50;
  double max_metres = 100'000.0;  ///< from the origin, in each coordinate: floats are 8 mm apart there
};

/// @throws InputError FILE: LINE:COLUMN: ... for whatever is no such file or beyond `limits`,
/// SystemError if it can't be read.
Trajectories loadTrajectories(const std::filesystem::path& file, const TrajectoryLimits& limits = {});

/// The same for text; `file` stands for it in messages.
Trajectories parseTrajectories(std::string_view text, const std::string& file,
                               const TrajectoryLimits& limits = {});

}  // namespace ensemble
