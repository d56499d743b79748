// The techniques drawing one crowd in turn, so that their times can be compared.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/scene.h"
#include "core/sub_mesh_lists.h"
#include "core/wardrobe.h"
#include "renderer/renderer.h"

namespace ensemble::cli {

/// One technique with one number of people.
struct ContestRow {
  Technique technique = Technique::kTagged;
  std::size_t characters = 0;
  std::vector<double> frame_ms = {}, cpu_ms = {};  ///< per round
  std::vector<PartTimes> parts_ms = {};            ///< likewise
  FrameStats stats = {};                           ///< counts, those of every round
  /// Vertex invocations may differ between rounds, where a device shares vertices as it likes.
  std::uint64_t least_invocations = 0, most_invocations = 0;
};

/// All techniques draw the same frame, round by round, so that a slow moment of the machine hits
/// them alike; each round begins with another one, so that none is always first. A warm-up round,
/// which compiles shaders, is not counted; it shows whether tagged and pre-fitted give the same picture.
class Contest {
 public:
  /// @param environment null where the scene has none
  /// @throws SystemError where the pictures differ; what Renderer throws
  Contest(Scene scene, std::span<const Wardrobe> wardrobes, const EnvironmentMesh* environment,
          std::span<const Technique> techniques, bool validate);

  /// @throws SystemError if a picture or a count is not that of the warm-up round
  void runRound();

  const std::vector<ContestRow>& rows() const { return rows_; }
  std::string deviceName() const { return renderers_.front()->deviceName(); }
  void refuseMessages() const;  ///< of the validation layer, as refuseValidationMessages

 private:
  void drawFrame(std::size_t technique);
  void checkPictures() const;

  View view_;
  std::vector<std::unique_ptr<Renderer>> renderers_;
  std::vector<Picture> pictures_;
  std::vector<ContestRow> rows_;
  std::size_t round_ = 0;
};

}  // namespace ensemble::cli
