#include "assetpipe/explain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "assetpipe/ray_scene.h"
#include "core/atomic_file.h"
#include "core/box.h"
#include "core/clip.h"
#include "core/image_file.h"

namespace ensemble {
namespace {

using Json = nlohmann::ordered_json;
using Color = std::array<float, 3>;

enum class Verdict : std::uint8_t {
  kKept,      ///< seen
  kRestored,  ///< seen, though its author had removed it
  kHidden,    ///< never seen
  kHole,      ///< left out, though a little of it can be seen
  kAuthored,  ///< left out by the author, though rays see it (--occlusion both), or as the item's overrides
              ///< say
  kPaintedHidden,  ///< left out or kept, because it is painted so
  kPaintedKept,
};

/// sRGB; a face of a hole is between hidden and kHole by the size of its hole.
constexpr std::array<Color, 7> kExplainColors = {{{0.80f, 0.78f, 0.75f},
                                                  {0.85f, 0.35f, 0.75f},
                                                  {0.20f, 0.42f, 0.70f},
                                                  {0.95f, 0.60f, 0.15f},
                                                  {0.85f, 0.20f, 0.15f},
                                                  {0.10f, 0.42f, 0.18f},
                                                  {0.45f, 0.80f, 0.35f}}};
constexpr std::uint32_t kWidth = 320, kHeight = 720;  // of one view

Verdict verdictOf(const FaceHole& hole, bool is_visible, const AuthoredFaces& authored, FaceId face) {
  if (authored.painted[face] == Paint::kHide) return Verdict::kPaintedHidden;
  if (authored.painted[face] == Paint::kKeep) return Verdict::kPaintedKept;
  const bool was_authored_away = authored.visible[face] == 0;
  if (is_visible) return was_authored_away ? Verdict::kRestored : Verdict::kKept;
  if (hole.is_kept) return Verdict::kAuthored;
  return hole.pose == FaceHole::kNoPose ? Verdict::kHidden : Verdict::kHole;
}

Color colorOf(Verdict verdict, const FaceHole& hole, const HiddenFaceOptions& options) {
  const Color& color = kExplainColors[static_cast<std::size_t>(verdict)];
  if (verdict != Verdict::kHole) return color;
  const Color& hidden = kExplainColors[static_cast<std::size_t>(Verdict::kHidden)];
  const float size =
      std::clamp(std::max(hole.share / options.hole_share, hole.area / options.hole_area), 0.2f, 1.0f);
  Color mixed;
  for (std::size_t i = 0; i < 3; ++i) mixed[i] = hidden[i] + size * (color[i] - hidden[i]);
  return mixed;
}

Box boxOf(std::span<const Vec3> points) {
  Box box;
  for (const Vec3& point : points) box.add(point);
  return box;
}

/// Four views beside each other of the body at rest.
Image8 drawVerdicts(const TemplateBody& body, std::span<const Color> colors) {
  const RayDevice device;
  const RayScene scene(device, surfaceOf(body), {}, skinningMatrices(body.skeleton, restPose(body.skeleton)));
  const Box box = boxOf(scene.vertices());
  const Vec3 center = box.center(), extent = box.extent();
  const float width = std::max(extent.x, extent.z);
  const float pixel = 1.05f * std::max(extent.y / kHeight, width / kWidth);
  Image8 image{4 * kWidth, kHeight, {}};
  image.rgba.assign(std::size_t{image.width} * image.height * 4, 255);
  for (std::uint32_t x = 0; x < image.width; ++x) {
    const auto turn = static_cast<float>(x / kWidth) * 1.57079632679f;
    const Vec3 toward(std::sin(turn), 0.0f, std::cos(turn)), right(std::cos(turn), 0.0f, -std::sin(turn));
    for (std::uint32_t y = 0; y < image.height; ++y) {
      const float across = (static_cast<float>(x % kWidth) + 0.5f - 0.5f * kWidth) * pixel;
      const float up = (0.5f * kHeight - static_cast<float>(y) - 0.5f) * pixel;
      const Vec3 from = center + 2.0f * glm::length(extent) * toward + across * right + Vec3(0.0f, up, 0.0f);
      const std::optional<BodyHit> hit = scene.bodyAt(from, -toward);
      if (!hit) continue;
      const float light = 0.35f + 0.65f * std::max(0.0f, glm::dot(hit->normal, toward));
      std::uint8_t* out = &image.rgba[(std::size_t{y} * image.width + x) * 4];
      for (std::size_t i = 0; i < 3; ++i)
        out[i] = static_cast<std::uint8_t>(std::lround(255.0f * light * colors[hit->face][i]));
    }
  }
  return image;
}

double rounded(double value) { return std::round(value * 1000.0) / 1000.0; }

Json describeFace(const TemplateBody& body, const FaceHoles& holes, std::uint32_t number, FaceId face,
                  Paint paint) {
  const FaceHole& hole = holes.faces[face];
  Json json = {{"face", number}};
  if (paint != Paint::kNone) {
    json.update({{"verdict", "painted"}, {"paint", paint == Paint::kKeep ? "keep" : "hide"}});
  } else if (hole.is_in_bare_region) {
    json["verdict"] = "bare region";
  } else if (hole.pose == FaceHole::kNoPose) {
    json["verdict"] = "pinhole";
  } else {
    json["verdict"] = hole.is_kept ? "kept" : "hole";
  }
  if (hole.is_in_bare_region || hole.pose == FaceHole::kNoPose) return json;
  const ViewedPose& pose = holes.poses[hole.pose];
  if (body.clips.empty()) {
    json.update({{"clip", nullptr}, {"seconds", 0.0}});
  } else {
    const Clip& clip = body.clips[pose.clip];
    const double steps = std::max(clip.key_count, 2u) - 1.0;
    json.update({{"clip", clip.name}, {"seconds", rounded(double{pose.key} / steps * double{clip.seconds})}});
  }
  json.update({{"share", rounded(double{hole.share})}, {"mm2", rounded(1.0e6 * double{hole.area})}});
  return json;
}

Json describeRegion(const TemplateBody& body, const Item& item, const FaceHoles& holes,
                    const PerFace<Paint>& painted, const Region& region) {
  Json faces = Json::array();
  std::uint32_t kept = 0;
  for (std::uint32_t f = 0; f < region.face_count; ++f) {
    const FaceId face(region.first_face + f);
    kept += item.visible[face];
    const FaceHole& hole = holes.faces[face];
    if (!hole.is_kept && hole.pose == FaceHole::kNoPose && painted[face] == Paint::kNone) continue;
    faces.push_back(describeFace(body, holes, f, face, painted[face]));
  }
  return {{"name", region.name},
          {"kept", kept},
          {"hidden", region.face_count - kept},
          {"faces", std::move(faces)}};
}

}  // namespace

void explainHiddenFaces(const std::filesystem::path& folder, const TemplateBody& body, const Item& item,
                        const AuthoredFaces& authored, const FaceHoles& holes,
                        const HiddenFaceOptions& options) {
  std::vector<Color> colors;
  for (std::size_t f = 0; f < body.faces.size(); ++f) {
    const FaceHole& hole = holes.faces[FaceId(f)];
    const Verdict verdict = verdictOf(hole, item.visible[FaceId(f)] != 0, authored, FaceId(f));
    colors.push_back(colorOf(verdict, hole, options));
  }
  Json json = {{"schema", "ensemble.explain/1"},
               {"outfit", item.name},
               {"tolerance_mm", rounded(1000.0 * double{options.tolerance})},
               {"hole_share", rounded(double{options.hole_share})},
               {"hole_mm2", rounded(1.0e6 * double{options.hole_area})},
               {"regions", Json::array()}};
  for (const Region& region : body.regions)
    json["regions"].push_back(describeRegion(body, item, holes, authored.painted, region));
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) failWriting(folder, error.value());
  writeFileAtomically(folder / (item.name + ".png"), encodePng(drawVerdicts(body, colors)));
  const std::string text = json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
  writeFileAtomically(folder / (item.name + ".json"), text);
}

}  // namespace ensemble
