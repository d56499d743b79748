// Techniques and rasterisers drawing one crowd in turn, so that their times can be compared.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/picture_error.h"
#include "core/scene.h"
#include "core/sub_mesh_lists.h"
#include "core/wardrobe.h"
#include "renderer/renderer.h"

namespace ensemble::cli {

struct ContestOptions {
  std::vector<Technique> techniques;  ///< each once, at least one
  std::vector<RasterKind> rasters;    ///< likewise; every technique is drawn by each
  std::vector<std::uint32_t> frames;  ///< of the scene, drawn one a round, over and over; at least one
  bool validate = false;
};

/// One technique and rasteriser with one number of people.
struct ContestRow {
  Technique technique = Technique::kTagged;
  RasterKind raster = RasterKind::kAuto;
  std::size_t characters = 0;
  std::vector<FrameStats> rounds = {};  ///< those that count
  /// By how much vertex invocations of the same frame differ, where a device shares vertices as it likes.
  std::uint64_t invocations_differ_by = 0;
};

/// How far the pictures of one technique by two rasterisers are apart, over the frames of the warm-up rounds.
struct ContestError {
  Technique technique = Technique::kTagged;
  RasterKind raster = RasterKind::kPipeline, versus = RasterKind::kCompute;
  std::size_t characters = 0;
  std::uint32_t frames = 0;    ///< that were compared
  double sum_of_shares = 0.0;  ///< PictureError::share
  double worst_share = 0.0;
  std::uint32_t worst_frame = 0;  ///< which has it
  int most = 0;                   ///< greatest difference of a channel in any frame, 0 .. 255
};

/// All draw the same frame, round by round, so that a slow moment of the machine hits them alike; each round
/// begins with another one, so that none is always first. Warm-up rounds compile shaders and fill pose
/// caches, and are not counted. Each row has a renderer of its own: none finds poses that another one has
/// skinned.
class Contest {
 public:
  /// @param environment null where the scene has none
  /// @throws what Renderer throws
  Contest(Scene scene, std::span<const Wardrobe> wardrobes, const EnvironmentMesh* environment,
          ContestOptions options);

  /// @throws SystemError where tagged and pre-fitted differ, or a frame is not what it was when it was drawn
  /// before: its picture, or a count
  void runWarmUpRound();
  void runRound();

  const std::vector<ContestRow>& rows() const { return rows_; }
  const std::vector<ContestError>& errors() const { return errors_; }
  std::string deviceName() const { return renderers_.front()->deviceName(); }
  void refuseMessages() const;  ///< of the validation layer, as refuseValidationMessages

 private:
  /// What a row drew of a frame when it drew it for the first time.
  struct Seen {
    FrameStats stats;
    std::size_t picture_hash = 0;
    std::uint64_t least_invocations = 0, most_invocations = 0;
  };

  void drawRound(std::size_t round, bool is_counted);
  void checkFrame(std::size_t row, std::size_t place);
  void checkTechniques() const;
  void measureErrors(std::uint32_t frame);
  const Picture* pictureOf(Technique technique, RasterKind raster) const;

  ContestOptions options_;
  SceneCamera camera_;
  float fps_ = 30.0f;
  View view_;
  std::vector<std::unique_ptr<Renderer>> renderers_;  // per row, as the next two
  std::vector<Picture> pictures_;
  std::vector<std::vector<std::optional<Seen>>> seen_;  // per place in options_.frames
  std::vector<ContestRow> rows_;
  std::vector<ContestError> errors_;
  std::size_t round_ = 0, warm_up_round_ = 0;
};

}  // namespace ensemble::cli
