// `render --dump-crowd`: who stands where in what, as a table.
#pragma once

#include <span>
#include <string>

#include "core/scene.h"
#include "core/wardrobe.h"
#include "renderer/crowd.h"

namespace ensemble::cli {

/// @throws UsageError for a name that doesn't end in .csv, as which alone a table is read back; and where
/// `json_file` is the standard output, too
void checkCrowdDump(const std::string& file, const std::string& json_file);

/// Writes the crowd at time 0 to `file`, or with "-" to standard output; logs what is not in it.
/// @throws SystemError if it can't be written, InputError as tableOfCrowd
void dumpCrowd(const std::string& file, const Scene& scene, std::span<const Wardrobe> wardrobes,
               const Crowd& crowd);

}  // namespace ensemble::cli
