// What a frame cost. Counts are exact and repeatable; times are of this machine.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace ensemble {

/// One pass over the crowd and the environment.
struct PassStats {
  /// Of people: one per sub-mesh with a queue, and the dispatches that rasterise in compute; of the
  /// environment: per piece.
  std::uint64_t draw_calls = 0;
  std::uint64_t triangles = 0;  ///< drawn, of all instances
  /// Of the pipeline's vertex shaders, measured; and the corners of the triangles that the compute rasteriser
  /// draws. None where the device can't count.
  std::optional<std::uint64_t> vertex_invocations;
};

/// Poses of the compute rasteriser.
struct PoseStats {
  std::uint64_t kept = 0;              ///< meshes at key frames that were drawn: kept from an earlier frame
  std::uint64_t skinned = 0;           ///< the others
  std::uint64_t own = 0;               ///< people between key frames, posed for this frame alone
  std::uint64_t skinned_vertices = 0;  ///< of both
  std::uint64_t kept_bytes = 0;        ///< of all that are kept after the frame
};

/// What the device does for a frame, in this order; AOVs left out.
enum class FramePart : std::uint8_t {
  kCulling,   ///< people, queues and draws, where the device finds them
  kPoses,     ///< palettes, and vertices for the compute rasteriser
  kShadows,   ///< the shadow map, by both rasterisers
  kPipeline,  ///< the picture as the graphics pipeline draws it: people, environment, ground, sky
  kRaster,    ///< people in the compute rasteriser
  kShading,   ///< its pixels listed, sorted, shaded
  kPost,      ///< to sRGB, and to memory
};
inline constexpr std::size_t kFramePartCount = 7;
inline constexpr std::array<const char*, kFramePartCount> kFramePartNames = {
    "culling", "poses", "shadows", "pipeline", "raster", "shading", "post"};
/// Milliseconds; all 0 where the device has no timestamps.
using PartTimes = std::array<double, kFramePartCount>;

struct FrameStats {
  std::uint32_t characters_drawn = 0;  ///< people whose bounds touch the picture
  std::uint32_t characters_posed = 0;  ///< whose palettes this view needed first: not of those whom compute
                                       ///< draws from kept poses
  std::uint32_t characters_computed = 0;  ///< of those drawn: by the compute rasteriser
  std::uint64_t people_triangles = 0;     ///< of the picture's triangles: those of people
  std::uint64_t triangles_computed = 0;   ///< of these: by the compute rasteriser
  std::uint64_t triangles_hidden = 0;     ///< left out of the picture: nearer people hide them
  bool culled_on_device = false;          ///< people, queues and draws; else by the host
  PoseStats poses;
  PassStats shadow;                     ///< the shadow map
  PassStats main;                       ///< the picture
  PassStats environment;                ///< what of these two is the environment
  std::uint64_t gpu_mesh_bytes = 0;     ///< vertices and indices of all meshes of people
  std::uint64_t environment_bytes = 0;  ///< vertices and indices of the environment
  double frame_ms = 0.0;                ///< from call to finished picture, AOVs left out
  double cpu_ms = 0.0;                  ///< of that, before the device was given its work
  PartTimes parts_ms{};                 ///< of that, on the device

  std::uint64_t drawCalls() const { return shadow.draw_calls + main.draw_calls; }
  std::uint64_t triangles() const { return shadow.triangles + main.triangles; }
  std::optional<std::uint64_t> vertexInvocations() const {
    if (!shadow.vertex_invocations || !main.vertex_invocations) return std::nullopt;
    return *shadow.vertex_invocations + *main.vertex_invocations;
  }
};

}  // namespace ensemble
