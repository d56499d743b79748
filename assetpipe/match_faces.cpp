// Design 3. Lister, Laycock and Day (section 3.1.4) compare face counts of regions; matching faces
// themselves also works for bodies that were reordered, split, re-indexed or exported again, and
// tells a body of another template.
#include "assetpipe/match_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace ensemble {
namespace {

struct CellHit {
  std::uint64_t cell = 0;
  std::uint32_t index = 0;
};

/// Points in a grid of cells; finds those near a point.
class PointGrid {
 public:
  PointGrid(std::vector<Vec3> points, float cell_size) : points_(std::move(points)), cell_size_(cell_size) {
    for (std::uint32_t i = 0; i < points_.size(); ++i) hits_.push_back({cellOf(points_[i], {0, 0, 0}), i});
    std::sort(hits_.begin(), hits_.end(), [](const CellHit& a, const CellHit& b) {
      return std::tie(a.cell, a.index) < std::tie(b.cell, b.index);
    });
  }

  /// Calls `visit(index)` for every point in the 27 cells around `point`, once each.
  template <class Visit>
  void near(const Vec3& point, Visit visit) const {
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          const std::uint64_t cell = cellOf(point, {dx, dy, dz});
          auto hit = std::lower_bound(hits_.begin(), hits_.end(), cell,
                                      [](const CellHit& a, std::uint64_t b) { return a.cell < b; });
          for (; hit != hits_.end() && hit->cell == cell; ++hit) visit(hit->index);
        }
      }
    }
  }

 private:
  /// 21 bits an axis, wrapped: far cells that coincide only cost a comparison.
  std::uint64_t cellOf(const Vec3& point, const std::array<int, 3>& offset) const {
    std::uint64_t cell = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto step = static_cast<std::int64_t>(
          std::floor(static_cast<double>(point[axis]) / static_cast<double>(cell_size_)));
      cell = cell << 21 |
             (static_cast<std::uint64_t>(step + offset[static_cast<std::size_t>(axis)]) & 0x1fffffu);
    }
    return cell;
  }

  std::vector<Vec3> points_;
  float cell_size_;
  std::vector<CellHit> hits_;
};

struct Candidate {
  float distance = 0.0f;
  std::uint32_t embedded = 0, in_template = 0;
};

std::array<Vec3, 3> cornersOf(const TemplateBody& body, FaceId face) {
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = body.vertices[VertexId(body.faces[face][k])].position;
  return corners;
}

Vec3 centroid(const std::array<Vec3, 3>& corners) { return (corners[0] + corners[1] + corners[2]) / 3.0f; }

/// The largest corner distance under the best of the three rotations that keep the winding.
float cornerDistance(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
  float best = std::numeric_limits<float>::max();
  for (std::size_t turn = 0; turn < 3; ++turn) {
    float worst = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) worst = std::max(worst, glm::distance(a[k], b[(k + turn) % 3]));
    best = std::min(best, worst);
  }
  return best;
}

std::vector<Candidate> findCandidates(const TemplateBody& body, std::span<const EmbeddedFace> embedded,
                                      float tolerance) {
  std::vector<std::uint32_t> material(body.faces.size());
  for (const BodyPart& part : body.parts) {
    std::fill_n(material.begin() + part.first_face, part.face_count, part.material);
  }
  std::vector<std::array<Vec3, 3>> corners;
  std::vector<Vec3> centroids;
  for (std::size_t f = 0; f < body.faces.size(); ++f) {
    corners.push_back(cornersOf(body, FaceId(f)));
    centroids.push_back(centroid(corners.back()));
  }
  // Centroids are no farther apart than the corners; a little more room for rounding.
  const PointGrid grid(centroids, std::max(tolerance * 1.01f, 1e-6f));

  std::vector<Candidate> candidates;
  for (std::uint32_t e = 0; e < embedded.size(); ++e) {
    const EmbeddedFace& face = embedded[e];
    grid.near(centroid(face.corners), [&](std::uint32_t t) {
      if (face.material != EmbeddedFace::kAnyMaterial && face.material != material[t]) return;
      const float distance = cornerDistance(face.corners, corners[t]);
      if (distance <= tolerance) candidates.push_back({distance, e, t});
    });
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.distance, a.in_template, a.embedded) < std::tie(b.distance, b.in_template, b.embedded);
  });
  return candidates;
}

constexpr std::uint32_t kNone = 0xffffffffu;

/// One-to-one assignment: nearest first, then augmenting paths for those left over (Kuhn 1955).
class Assignment {
 public:
  Assignment(std::span<const Candidate> candidates, std::size_t embedded_count, std::size_t template_count)
      : of_embedded_(embedded_count, kNone),
        of_template_(template_count, kNone),
        choices_(embedded_count),
        visited_(template_count, kNone) {
    for (const Candidate& candidate : candidates) {
      choices_[candidate.embedded].push_back(candidate.in_template);
      if (of_embedded_[candidate.embedded] != kNone || of_template_[candidate.in_template] != kNone) continue;
      pair(candidate.embedded, candidate.in_template);
    }
    for (std::uint32_t e = 0; e < embedded_count; ++e) {
      if (of_embedded_[e] == kNone && !choices_[e].empty()) augment(e);
    }
  }

  const std::vector<std::uint32_t>& ofEmbedded() const { return of_embedded_; }

 private:
  void pair(std::uint32_t embedded, std::uint32_t in_template) {
    of_embedded_[embedded] = in_template;
    of_template_[in_template] = embedded;
  }

  /// Breadth-first, so that no input can overflow the stack.
  void augment(std::uint32_t start) {
    std::vector<std::uint32_t> queue{start};
    std::vector<std::uint32_t> came_from(1, kNone);  // per queue entry: the entry that led here
    std::vector<std::uint32_t> through(1, kNone);    // ... and the template face it would give up
    for (std::size_t head = 0; head < queue.size(); ++head) {
      for (const std::uint32_t t : choices_[queue[head]]) {
        if (visited_[t] == start) continue;
        visited_[t] = start;
        if (of_template_[t] != kNone) {
          queue.push_back(of_template_[t]);
          came_from.push_back(static_cast<std::uint32_t>(head));
          through.push_back(t);
          continue;
        }
        // Free: hand the faces along the path on.
        std::uint32_t free_face = t;
        for (std::uint32_t entry = static_cast<std::uint32_t>(head); entry != kNone;
             entry = came_from[entry]) {
          pair(queue[entry], free_face);
          free_face = through[entry];
        }
        return;
      }
    }
  }

  std::vector<std::uint32_t> of_embedded_, of_template_;
  std::vector<std::vector<std::uint32_t>> choices_;  ///< per embedded face, nearest first
  std::vector<std::uint32_t> visited_;               ///< per template face: the last search that saw it
};

/// A tree over points that finds the nearest (median splits, in place).
class NearestPoint {
 public:
  explicit NearestPoint(std::vector<Vec3> points) : points_(std::move(points)) {
    split(0, points_.size(), 0);
  }

  float distanceTo(const Vec3& query) const {
    float best = std::numeric_limits<float>::max();
    search(query, 0, points_.size(), 0, best);
    return std::sqrt(best);
  }

 private:
  void split(std::size_t first, std::size_t last, int axis) {
    if (last - first < 2) return;
    const std::size_t middle = (first + last) / 2;
    const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(last),
                     [&](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
    split(first, middle, (axis + 1) % 3);
    split(middle + 1, last, (axis + 1) % 3);
  }

  void search(const Vec3& query, std::size_t first, std::size_t last, int axis, float& best) const {
    if (first >= last) return;
    const std::size_t middle = (first + last) / 2;
    const Vec3 to_point = points_[middle] - query;
    best = std::min(best, glm::dot(to_point, to_point));
    const float to_plane = query[axis] - points_[middle][axis];
    const int next = (axis + 1) % 3;
    if (to_plane < 0.0f) {
      search(query, first, middle, next, best);
      if (to_plane * to_plane < best) search(query, middle + 1, last, next, best);
    } else {
      search(query, middle + 1, last, next, best);
      if (to_plane * to_plane < best) search(query, first, middle, next, best);
    }
  }

  std::vector<Vec3> points_;
};

void measureDistances(const TemplateBody& body, std::span<const EmbeddedFace> embedded,
                      FaceMatches& matches) {
  std::vector<Vec3> positions;
  for (const RawVertex& vertex : body.vertices) positions.push_back(vertex.position);
  const NearestPoint nearest(std::move(positions));
  std::vector<float> distances;
  for (const EmbeddedFace& face : embedded) {
    for (const Vec3& corner : face.corners) distances.push_back(nearest.distanceTo(corner));
  }
  if (distances.empty()) return;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  matches.median_distance = *middle;
  matches.max_distance = *std::max_element(distances.begin(), distances.end());
}

}  // namespace

FaceMatches matchFaces(const TemplateBody& body, std::span<const EmbeddedFace> embedded, float tolerance) {
  const std::vector<Candidate> candidates = findCandidates(body, embedded, tolerance);
  const Assignment assignment(candidates, embedded.size(), body.faces.size());
  FaceMatches matches;
  for (const std::uint32_t face : assignment.ofEmbedded()) {
    matches.template_face.push_back(face == kNone ? FaceId::none() : FaceId(face));
    matches.unmatched += face == kNone ? 1u : 0u;
  }
  measureDistances(body, embedded, matches);
  return matches;
}

}  // namespace ensemble
