#include "cli/bench_contest.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string_view>
#include <tuple>

#include "cli/scene_run.h"
#include "core/check.h"
#include "core/input_error.h"

namespace ensemble::cli {
namespace {

/// What must be the same whenever a frame is drawn.
auto exactCounts(const FrameStats& stats) {
  return std::tuple(stats.characters_drawn, stats.characters_posed, stats.characters_computed,
                    stats.triangles_computed, stats.drawCalls(), stats.triangles(), stats.gpu_mesh_bytes);
}

std::size_t hashOf(const Image8& picture) {
  return std::hash<std::string_view>()(
      {reinterpret_cast<const char*>(picture.rgba.data()), picture.rgba.size()});
}

std::string nameOf(const ContestRow& row) {
  return fmt::format("{} by {}", toString(row.technique), toString(row.raster));
}

[[noreturn]] void fail(const std::string& what) {
  throw SystemError({.file = {}, .where = "bench", .what = what, .mend = "report it as a bug"});
}

}  // namespace

Contest::Contest(Scene scene, std::span<const Wardrobe> wardrobes, const EnvironmentMesh* environment,
                 ContestOptions options)
    : options_(std::move(options)), camera_(scene.camera), fps_(scene.output.fps), view_(viewOf(scene)) {
  view_.debug = DebugKind::kNone;  // what costs time of its own tells nothing of theirs
  ENSEMBLE_CHECK(!options_.techniques.empty() && !options_.rasters.empty() && !options_.frames.empty());
  for (const Technique technique : options_.techniques) {
    for (const RasterKind raster : options_.rasters) {
      scene.technique = technique;
      scene.raster = raster;
      renderers_.push_back(std::make_unique<Renderer>(RendererOptions{.validate = options_.validate}));
      renderers_.back()->load(scene, wardrobes, environment);
      rows_.push_back({.technique = technique,
                       .raster = raster,
                       .characters = renderers_.back()->crowd().characters.size()});
    }
    for (std::size_t a = 0; a < options_.rasters.size(); ++a) {
      for (std::size_t b = a + 1; b < options_.rasters.size(); ++b) {
        errors_.push_back({.technique = technique,
                           .raster = options_.rasters[a],
                           .versus = options_.rasters[b],
                           .characters = rows_.back().characters});
      }
    }
  }
  pictures_.resize(rows_.size());
  seen_.assign(rows_.size(), std::vector<std::optional<Seen>>(options_.frames.size()));
}

void Contest::runWarmUpRound() {
  const std::size_t round = warm_up_round_++;
  const bool is_first = round < options_.frames.size();
  // One sample a pixel of who shows where, to tell which pixels people cover; not part of a frame's time.
  if (is_first && !errors_.empty()) view_.aovs.add(Aov::kCharacter);
  drawRound(round, false);
  if (is_first) measureErrors(options_.frames[round]);
  view_.aovs = {};
}

void Contest::runRound() { drawRound(round_++, true); }

void Contest::refuseMessages() const {
  for (const auto& renderer : renderers_) refuseValidationMessages(*renderer);
}

void Contest::drawRound(std::size_t round, bool is_counted) {
  const std::size_t place = round % options_.frames.size();
  const double seconds = options_.frames[place] / double{fps_};
  view_.camera = camera_.at(seconds);
  for (std::size_t turn = 0; turn < rows_.size(); ++turn) {
    const std::size_t row = (round + turn) % rows_.size();
    view_.raster = rows_[row].raster;
    renderers_[row]->render(std::span(&view_, 1), seconds, std::span(&pictures_[row], 1));
    checkFrame(row, place);
    if (is_counted) rows_[row].rounds.push_back(pictures_[row].stats);
  }
  checkTechniques();
}

/// A figure of a wrong picture is worth nothing.
void Contest::checkFrame(std::size_t row, std::size_t place) {
  const FrameStats& stats = pictures_[row].stats;
  const std::size_t hash = hashOf(pictures_[row].color);
  const std::uint64_t invocations = stats.vertexInvocations().value_or(0);
  std::optional<Seen>& seen = seen_[row][place];
  if (!seen) seen = {stats, hash, invocations, invocations};
  const auto failed = [&](const char* what) {
    fail(fmt::format("{}: the {} of frame {} differ between rounds", nameOf(rows_[row]), what,
                     options_.frames[place]));
  };
  if (exactCounts(stats) != exactCounts(seen->stats)) failed("counts");
  if (hash != seen->picture_hash) failed("pictures");
  seen->least_invocations = std::min(seen->least_invocations, invocations);
  seen->most_invocations = std::max(seen->most_invocations, invocations);
  rows_[row].invocations_differ_by =
      std::max(rows_[row].invocations_differ_by, seen->most_invocations - seen->least_invocations);
}

void Contest::checkTechniques() const {
  for (const RasterKind raster : options_.rasters) {
    const Picture* tagged = pictureOf(Technique::kTagged, raster);
    const Picture* prefitted = pictureOf(Technique::kPrefitted, raster);
    if (tagged && prefitted && tagged->color.rgba != prefitted->color.rgba)
      fail(fmt::format("tagged and prefitted give different pictures by {}", toString(raster)));
  }
}

void Contest::measureErrors(std::uint32_t frame) {
  for (ContestError& error : errors_) {
    const PictureError found =
        comparePictures(*pictureOf(error.technique, error.raster), *pictureOf(error.technique, error.versus));
    if (error.frames == 0 || found.share() > error.worst_share) {
      error.worst_share = found.share();
      error.worst_frame = frame;
    }
    ++error.frames;
    error.sum_of_shares += found.share();
    error.most = std::max(error.most, found.most);
  }
}

const Picture* Contest::pictureOf(Technique technique, RasterKind raster) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i].technique == technique && rows_[i].raster == raster) return &pictures_[i];
  }
  return nullptr;
}

}  // namespace ensemble::cli
