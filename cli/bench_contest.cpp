#include "cli/bench_contest.h"

#include <algorithm>
#include <tuple>

#include "cli/scene_run.h"
#include "core/input_error.h"

namespace ensemble::cli {
namespace {

/// What must be the same in every round.
auto exactCounts(const FrameStats& stats) {
  return std::tuple(stats.characters_drawn, stats.characters_posed, stats.drawCalls(), stats.triangles(),
                    stats.gpu_mesh_bytes);
}

[[noreturn]] void fail(const std::string& what) {
  throw SystemError({.file = {}, .where = "bench", .what = what, .mend = "report it as a bug"});
}

}  // namespace

Contest::Contest(Scene scene, std::span<const Wardrobe> wardrobes, const EnvironmentMesh* environment,
                 std::span<const Technique> techniques, bool validate)
    : view_(viewOf(scene)), pictures_(techniques.size()) {
  for (const Technique technique : techniques) {
    scene.technique = technique;
    renderers_.push_back(std::make_unique<Renderer>(RendererOptions{.validate = validate}));
    renderers_.back()->load(scene, wardrobes, environment);
    rows_.push_back({.technique = technique, .characters = renderers_.back()->crowd().characters.size()});
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    drawFrame(i);
    rows_[i].stats = pictures_[i].stats;
    rows_[i].least_invocations = rows_[i].most_invocations = rows_[i].stats.vertexInvocations().value_or(0);
  }
  checkPictures();
}

void Contest::runRound() {
  for (std::size_t turn = 0; turn < rows_.size(); ++turn) {
    const std::size_t i = (round_ + turn) % rows_.size();
    ContestRow& row = rows_[i];
    drawFrame(i);
    const FrameStats& stats = pictures_[i].stats;
    if (exactCounts(stats) != exactCounts(row.stats)) {
      fail(std::string("the counts of ") + toString(row.technique) + " differ between rounds");
    }
    row.frame_ms.push_back(stats.frame_ms);
    row.cpu_ms.push_back(stats.cpu_ms);
    row.parts_ms.push_back(stats.parts_ms);
    const std::uint64_t invocations = stats.vertexInvocations().value_or(0);
    row.least_invocations = std::min(row.least_invocations, invocations);
    row.most_invocations = std::max(row.most_invocations, invocations);
  }
  ++round_;
  checkPictures();
}

void Contest::refuseMessages() const {
  for (const auto& renderer : renderers_) refuseValidationMessages(*renderer);
}

void Contest::drawFrame(std::size_t technique) {
  renderers_[technique]->render(std::span(&view_, 1), 0.0, std::span(&pictures_[technique], 1));
}

/// A figure of a wrong picture is worth nothing.
void Contest::checkPictures() const {
  const auto pictureOf = [&](Technique technique) -> const Picture* {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (rows_[i].technique == technique) return &pictures_[i];
    }
    return nullptr;
  };
  const Picture* tagged = pictureOf(Technique::kTagged);
  const Picture* prefitted = pictureOf(Technique::kPrefitted);
  if (tagged && prefitted && tagged->color.rgba != prefitted->color.rgba)
    fail("tagged and prefitted give different pictures");
}

}  // namespace ensemble::cli
