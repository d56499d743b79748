// What `ensemble tag`, `add` and `remove` do, as a list of steps.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "assetpipe/segment.h"
#include "assetpipe/tag_regions.h"
#include "core/wardrobe_files.h"

namespace ensemble {

struct PipelineOptions {
  SegmentOptions segment;  ///< how the template is cut into regions
  TagOptions tag;
  std::vector<std::filesystem::path> clips;  ///< files with more clips of the template's skeleton
  bool draco = false;                        ///< compress the GLBs that are written
  unsigned jobs = 0;                         ///< outfits at a time; 0: one for each core
};

/// Segments the template, tags the outfits (raw, or tagged already for this template) in parallel
/// and writes them as a wardrobe in `folder`, replacing what is there. Returns the manifest.
/// @throws InputError, SystemError; the folder then holds what it held before
Manifest tagWardrobe(const std::filesystem::path& template_file,
                     const std::vector<std::filesystem::path>& outfits, const std::filesystem::path& folder,
                     const PipelineOptions& options);

/// Adds outfits to a wardrobe without touching the other files.
Manifest addOutfits(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& outfits,
                    const PipelineOptions& options);

/// Removes outfits by name.
Manifest removeOutfits(const std::filesystem::path& folder, const std::vector<std::string>& names);

}  // namespace ensemble
