#include "assetpipe/hidden_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "assetpipe/ray_scene.h"
#include "core/clip.h"
#include "core/parallel.h"

namespace ensemble {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Generalised golden ratios (Roberts 2018): sequences that fill an interval and a square evenly.
constexpr double kGolden = 0.61803398874989485, kPlastic = 0.75487766624669276,
                 kPlastic2 = 0.56984029099805327;

double fraction(double x) { return x - std::floor(x); }

std::vector<Mat4> matricesAt(const TemplateBody& body, const ViewedPose& pose) {
  if (body.clips.empty()) return skinningMatrices(body.skeleton, restPose(body.skeleton));
  return skinningMatricesAt(body.skeleton, body.clips[pose.clip], pose.key);
}

std::vector<ViewedPose> choosePoses(const TemplateBody& body, std::uint32_t most) {
  std::vector<ViewedPose> poses;
  for (std::uint32_t c = 0; c < body.clips.size(); ++c) {
    const std::uint32_t steps = body.clips[c].key_count - 1;
    const std::uint32_t count = std::clamp(2 * steps, 1u, most);
    for (std::uint32_t i = 0; i < count; ++i) {
      poses.push_back({c, static_cast<float>(steps) * static_cast<float>(i) / static_cast<float>(count)});
    }
  }
  if (poses.empty()) poses.push_back({});
  return poses;
}

/// Per face: those that share an edge with it, by positions, so that seams of normals and materials are none.
std::vector<std::vector<std::uint32_t>> neighbours(const ViewedSurface& surface) {
  using Point = std::array<float, 3>;
  const auto pointOf = [&](std::uint32_t vertex) {
    const Vec3 position = surface.vertices[vertex].position;
    return Point{position.x, position.y, position.z};
  };
  std::map<std::pair<Point, Point>, std::vector<std::uint32_t>> edges;
  for (std::uint32_t f = 0; f < surface.faces.size(); ++f) {
    const Triangle& corners = surface.faces[f];
    for (std::size_t i = 0; i < 3; ++i) {
      edges[std::minmax(pointOf(corners[i]), pointOf(corners[(i + 1) % 3]))].push_back(f);
    }
  }
  std::vector<std::vector<std::uint32_t>> result(surface.faces.size());
  for (const auto& [edge, faces] : edges) {
    for (const std::uint32_t a : faces) {
      for (const std::uint32_t b : faces) {
        if (a != b) result[a].push_back(b);
      }
    }
  }
  return result;
}

/// Turns connected patches of at most `most` faces that are kept (or not), none of them plainly.
void joinPatches(const std::vector<std::vector<std::uint32_t>>& next_to, std::uint32_t most, bool kept,
                 PerFace<FaceHole>& faces) {
  std::vector<bool> visited(faces.size(), false);
  for (std::uint32_t start = 0; start < faces.size(); ++start) {
    if (visited[start] || faces[FaceId(start)].is_kept != kept) continue;
    std::vector<std::uint32_t> patch{start};
    visited[start] = true;
    bool is_plain = false;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      is_plain = is_plain || faces[FaceId(patch[i])].is_plain;
      for (const std::uint32_t other : next_to[patch[i]]) {
        if (visited[other] || faces[FaceId(other)].is_kept != kept) continue;
        visited[other] = true;
        patch.push_back(other);
      }
    }
    const bool is_whole_piece = std::all_of(patch.begin(), patch.end(), [&](std::uint32_t face) {
      return std::all_of(next_to[face].begin(), next_to[face].end(),
                         [&](std::uint32_t other) { return faces[FaceId(other)].is_kept == kept; });
    });
    if (patch.size() > most || is_plain || is_whole_piece) continue;  // such as a lash in front of the eye
    for (const std::uint32_t face : patch) faces[FaceId(face)].is_kept = !kept;
  }
}

/// Looks at faces in one pose.
class Lookout {
 public:
  /// @param number of the pose: shifts points and directions, so that each pose tries others
  Lookout(const RayDevice& device, const ViewedSurface& surface, const RayScene::Around& around,
          std::span<const Mat4> matrices, const HiddenFaceOptions& options, std::uint32_t number)
      : scene_(device, surface, around, matrices), options_(options), shift_(fraction(kPlastic * number)) {}

  struct Hole {
    float share = 0.0f, area = 0.0f;
  };
  Hole holeOf(const Triangle& corners, FaceKind kind, std::uint32_t face) const {
    const std::span<const Vec3> vertices = scene_.vertices();
    const Vec3 a = vertices[corners[0]], b = vertices[corners[1]], c = vertices[corners[2]];
    const Vec3 doubled = glm::cross(b - a, c - a);
    const float length = glm::length(doubled);
    if (!(length > 0.0f)) return {};
    double missed = 0.0;
    for (std::uint32_t s = 0; s < options_.samples; ++s) {
      if (s == options_.scouts && s > 0 && missed == 0.0) return {};
      double u = fraction(shift_ + kPlastic * (s + 1)), v = fraction(shift_ + kPlastic2 * (s + 1));
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      const Vec3 point = a + static_cast<float>(u) * (b - a) + static_cast<float>(v) * (c - a);
      missed += missedAt(point, doubled / length, face, s);
      if (kind.is_two_sided) missed += missedAt(point, -doubled / length, face, s);
    }
    // Cosines over a hemisphere are 1/2 on average; a picture from any side shows 1/4 of a surface on
    // average.
    const double share = 2.0 * missed / (options_.samples * options_.directions);
    return {static_cast<float>(share), static_cast<float>(share * 0.25 * 0.5 * double{length})};
  }

 private:
  /// The sum of the cosines of the rays along which one would see that the point is missing.
  double missedAt(Vec3 point, Vec3 normal, std::uint32_t face, std::uint32_t sample) const {
    if (scene_.hasClothUnder(point, normal, options_.tolerance)) return 0.0;
    const Vec3 helper = std::abs(normal.x) < 0.8f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 x = glm::normalize(glm::cross(helper, normal)), y = glm::cross(normal, x);
    const double turn = shift_ + kGolden * sample;
    double missed = 0.0;
    for (std::uint32_t d = 0; d < options_.directions; ++d) {  // even over the hemisphere
      const double up = 1.0 - (d + fraction(turn + 0.5)) / options_.directions;
      const double angle = 2.0 * kPi * fraction(turn + kGolden * d), out = std::sqrt(1.0 - up * up);
      const Vec3 direction = static_cast<float>(out * std::cos(angle)) * x +
                             static_cast<float>(out * std::sin(angle)) * y + static_cast<float>(up) * normal;
      if (!scene_.isSeen(point, direction, face)) continue;
      if (!scene_.hasClothUnder(point, direction, options_.tolerance)) missed += up;
    }
    return missed;
  }

  RayScene scene_;
  const HiddenFaceOptions& options_;
  double shift_;
};

/// Looks at all faces in all poses, some poses at a time so that their scenes fit into memory.
class Search {
 public:
  /// @param body whose clips are looked at
  Search(const TemplateBody& body, ViewedSurface surface, const RayScene::Around& around,
         const HiddenFaceOptions& options)
      : body_(body), surface_(std::move(surface)), around_(around), options_(options) {
    found_.poses = choosePoses(body, options.poses);
    found_.faces = PerFace<FaceHole>(surface_.faces.size());
  }

  /// Faces that are hidden without the items are so with them.
  void skipHidden(const FaceHoles& without) {
    skipped_.resize(found_.faces.size());
    for (std::size_t f = 0; f < skipped_.size(); ++f) skipped_[f] = !without.faces[FaceId(f)].is_kept;
  }

  FaceHoles find() {
    const unsigned threads = threadCount(options_.jobs);
    for (std::size_t first = 0; first < found_.poses.size(); first += kBatch) {
      const std::size_t count = std::min(kBatch, found_.poses.size() - first);
      std::vector<std::optional<Lookout>> lookouts(count);
      forEachOnThreads(threads, count, [&](std::size_t i, unsigned) {
        const std::vector<Mat4> matrices = matricesAt(body_, found_.poses[first + i]);
        lookouts[i].emplace(device_, surface_, around_, matrices, options_,
                            static_cast<std::uint32_t>(first + i));
      });
      forEachOnThreads(threads, found_.faces.size(), [&](std::size_t face, unsigned) {
        for (std::size_t i = 0; i < count; ++i)
          look(*lookouts[i], first + i, static_cast<std::uint32_t>(face));
      });
    }
    const std::vector<std::vector<std::uint32_t>> next_to = neighbours(surface_);
    for (const bool kept : {true, false}) joinPatches(next_to, options_.patch, kept, found_.faces);
    return std::move(found_);
  }

 private:
  static constexpr std::size_t kBatch = 24;
  static constexpr float kPlainShare = 2.0f, kPlainArea = 4.0f;  // times the limits

  void look(const Lookout& lookout, std::size_t pose, std::uint32_t number) {
    FaceHole& face = found_.faces[FaceId(number)];
    if (face.is_plain || (!skipped_.empty() && skipped_[number])) return;
    const Lookout::Hole hole = lookout.holeOf(surface_.faces[number], surface_.kinds[number], number);
    if (hole.share > face.share) {
      face.share = hole.share;
      face.pose = static_cast<std::uint32_t>(pose);
    }
    face.area += hole.area / static_cast<float>(found_.poses.size());
    face.is_kept = face.share > options_.hole_share || face.area > options_.hole_area;
    face.is_plain =
        face.share > kPlainShare * options_.hole_share || face.area > kPlainArea * options_.hole_area;
  }

  const TemplateBody& body_;
  const ViewedSurface surface_;
  const RayScene::Around around_;
  const HiddenFaceOptions options_;
  RayDevice device_;
  FaceHoles found_;
  std::vector<bool> skipped_;  ///< per face; empty: none
};

}  // namespace

FaceHoles findHoles(const TemplateBody& body, std::span<const Item* const> items,
                    const HiddenFaceOptions& options) {
  return Search(body, surfaceOf(body), {.body = nullptr, .items = items}, options).find();
}

namespace {

/// Pairs of items are many, and most of their faces show nothing at all in most poses.
HiddenFaceOptions withScouts(HiddenFaceOptions options) {
  options.scouts = 1;
  return options;
}

}  // namespace

FaceHoles findHolesOf(const Item& inner, const TemplateBody& body, const HiddenFaceOptions& options) {
  return Search(body, surfaceOf(inner), {.body = &body, .items = {}}, withScouts(options)).find();
}

FaceHoles findHolesUnder(const Item& inner, const Item& outer, const TemplateBody& body,
                         const FaceHoles& alone, const HiddenFaceOptions& options) {
  const Item* around = &outer;
  Search search(body, surfaceOf(inner), {.body = &body, .items = std::span(&around, 1)}, withScouts(options));
  search.skipHidden(alone);
  return search.find();
}

const FaceHoles& BareBody::holes() {
  std::call_once(looked_, [&] { holes_ = findHoles(body_, {}, options_); });
  return holes_;
}

}  // namespace ensemble
