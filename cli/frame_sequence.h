// A sequence: frames drawn and encoded on several threads, whose files, annotations and figures leave one
// after the other, as if each had been drawn alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>

#include "cli/annotation_file.h"
#include "cli/frame_files.h"
#include "core/progress.h"
#include "core/scene.h"
#include "core/wardrobe.h"
#include "renderer/renderer_pool.h"

namespace ensemble::cli {

struct FrameSequence {
  const Scene& scene;
  std::span<const Wardrobe> wardrobes;
  RendererPool& renderers;
  View view;  ///< that of every frame, but for the camera
  const FrameNames& names;
  FrameFiles& files;
  AnnotationFile* annotations;  ///< null: none are asked for
};

/// How a sequence is spread.
struct SequenceThreads {
  unsigned threads = 0;   ///< that draw and encode; 0: the caller's does, frame by frame
  std::size_t slots = 1;  ///< frames in memory at most
};
/// A thread more than renderers, so that one encodes while the others draw, and at least one a core up to 8;
/// fewer where the frames under way would take more than 1 GiB.
/// @param frame_bytes of one frame in memory
SequenceThreads spreadSequence(unsigned renderers, unsigned cores, std::size_t frames,
                               std::uint64_t frame_bytes);

/// Draws frames in this order and writes what belongs to each.
/// @returns the figures of each
/// @throws what the first frame that fails throws; those before it are written, those after it are not
nlohmann::ordered_json drawFrames(const FrameSequence& sequence, std::span<const std::uint32_t> frames,
                                  unsigned renderers, Progress& progress);

}  // namespace ensemble::cli
