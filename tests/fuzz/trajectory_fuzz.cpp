// Fuzzes parseTrajectories: hostile text is refused with a UserError or read; what was read is sound.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/input_error.h"
#include "core/trajectory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ensemble::TrajectoryLimits limits;
  limits.max_people = 1u << 8;
  limits.max_samples = 1u << 12;
  ensemble::Trajectories read;
  try {
    read = ensemble::parseTrajectories({reinterpret_cast<const char*>(data), size}, "fuzz.txt", limits);
  } catch (const ensemble::UserError&) {
    return -1;
  }
  if (read.people.empty() || read.people.size() > limits.max_people) std::abort();
  if (!(read.fps >= 0.0f && read.fps <= 1000.0f)) std::abort();
  std::size_t samples = 0;
  for (std::size_t i = 0; i < read.people.size(); ++i) {
    const ensemble::Trajectory& person = read.people[i];
    if (i > 0 && person.id <= read.people[i - 1].id) std::abort();
    if (person.positions.empty()) std::abort();
    samples += person.positions.size();
    for (const ensemble::Vec3& position : person.positions) {
      for (int k = 0; k < 3; ++k) {
        if (!(std::abs(position[k]) <= static_cast<float>(limits.max_metres))) std::abort();
      }
    }
  }
  return samples <= limits.max_samples ? 0 : (std::abort(), 0);
}
