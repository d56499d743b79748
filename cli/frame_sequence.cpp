#include "cli/frame_sequence.h"

#include <algorithm>

#include "cli/annotations.h"
#include "core/parallel.h"

namespace ensemble::cli {
namespace {

using Json = nlohmann::ordered_json;

Json orNull(const std::optional<std::uint64_t>& count) { return count ? Json(*count) : Json(nullptr); }

Json toJson(const PassStats& pass) {
  return {{"draw_calls", pass.draw_calls},
          {"vertex_invocations", orNull(pass.vertex_invocations)},
          {"triangles", pass.triangles}};
}

Json toJson(const PoseStats& poses) {
  return {{"kept", poses.kept},
          {"skinned", poses.skinned},
          {"own", poses.own},
          {"skinned_vertices", poses.skinned_vertices},
          {"kept_bytes", poses.kept_bytes}};
}

Json toJson(const PartTimes& times) {
  Json parts = Json::object();
  for (std::size_t part = 0; part < kFramePartCount; ++part) parts[kFramePartNames[part]] = times[part];
  return parts;
}

Json toJson(std::uint32_t index, const std::string& file, const FrameStats& stats) {
  return {{"index", index},
          {"file", file},
          {"frame_ms", stats.frame_ms},
          {"cpu_ms", stats.cpu_ms},
          {"parts_ms", toJson(stats.parts_ms)},
          {"characters_drawn", stats.characters_drawn},
          {"characters_posed", stats.characters_posed},
          {"characters_computed", stats.characters_computed},
          {"triangles_computed", stats.triangles_computed},
          {"culling", stats.culled_on_device ? "device" : "host"},
          {"triangles_hidden", stats.triangles_hidden},
          {"poses", toJson(stats.poses)},
          {"draw_calls", stats.drawCalls()},
          {"vertex_invocations", orNull(stats.vertexInvocations())},
          {"triangles", stats.triangles()},
          {"gpu_mesh_bytes", stats.gpu_mesh_bytes},
          {"environment_bytes", stats.environment_bytes},
          {"passes", {{"main", toJson(stats.main)}, {"shadow", toJson(stats.shadow)}}},
          {"environment", toJson(stats.environment)}};
}

/// What a frame takes in memory: its pixels, and files hardly larger than they are.
std::uint64_t bytesOfFrame(const View& view) {
  std::uint64_t bytes_of_pixel = 4 + (view.linear ? 8u : 0u);
  for (const Aov aov : kAllAovs) {
    if (view.aovs.has(aov)) bytes_of_pixel += aov == Aov::kNormal ? 12 : 4;
  }
  return 2 * bytes_of_pixel * view.width * view.height;
}

/// A frame under way.
struct Slot {
  Picture picture;
  std::vector<EncodedFile> files;
  Json annotation;
};

/// Draws a frame and makes all that is written of it. On any thread.
void makeFrame(const FrameSequence& sequence, std::uint32_t frame, Slot& slot) {
  const double seconds = frame / double{sequence.scene.output.fps};
  View view = sequence.view;
  view.camera = sequence.scene.camera.at(seconds);
  sequence.renderers.draw(view, seconds, slot.picture);
  slot.files = sequence.files.encode(frame, slot.picture);
  if (sequence.annotations) {
    slot.annotation = annotateFrame(sequence.scene, sequence.wardrobes, sequence.renderers.crowd(), view,
                                    slot.picture, frame, sequence.names.picture(frame).string());
  }
}

}  // namespace

SequenceThreads spreadSequence(unsigned renderers, unsigned cores, std::size_t frames,
                               std::uint64_t frame_bytes) {
  constexpr std::uint64_t kMostBytes = 1ull << 30;
  constexpr unsigned kMostEncoders = 8;
  const std::uint64_t slots =
      std::min<std::uint64_t>(std::max(renderers + 1, std::min(cores, kMostEncoders)) + 1,
                              kMostBytes / std::max<std::uint64_t>(frame_bytes, 1));
  if (frames < 2 || slots < 2) return {};
  return {.threads = static_cast<unsigned>(slots - 1), .slots = slots};
}

Json drawFrames(const FrameSequence& sequence, std::span<const std::uint32_t> frames, unsigned renderers,
                Progress& progress) {
  const SequenceThreads spread =
      spreadSequence(renderers, threadCount(0), frames.size(), bytesOfFrame(sequence.view));
  std::vector<Slot> slots(spread.slots);
  Json rows = Json::array();
  forEachInOrder(
      spread.threads,
      {.count = frames.size(),
       .slots = spread.slots,
       .make = [&](std::size_t i, std::size_t slot) { makeFrame(sequence, frames[i], slots[slot]); },
       .leave =
           [&](std::size_t i, std::size_t slot) {
             const Slot& made = slots[slot];
             sequence.files.write(frames[i], made.picture, made.files);
             if (sequence.annotations) sequence.annotations->add(frames[i], made.annotation);
             rows.push_back(
                 toJson(frames[i], sequence.names.picture(frames[i]).string(), made.picture.stats));
             progress.advance();
           }});
  return rows;
}

}  // namespace ensemble::cli
