// Half-edge collapse with quadric error metrics (quadric.h). Departures: a vertex only moves onto a neighbour
// (so that it stays on the surface), and long edges cost something (so that limbs get rings, not splinters).
#include "assetpipe/simplify_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "assetpipe/quadric.h"
#include "core/check.h"

namespace ensemble {
namespace {

using Vec3d = glm::dvec3;

/// Vertices that are more important than this stay where the collapses left them: on the features.
constexpr double kKeepPlace = 4.0;

/// What kind of line an edge lies on; vertices only slide along their own line.
enum class Line : std::uint8_t { kNone, kLabels, kBorder, kMirrorPlane };

struct Collapse {
  double cost = 0.0;
  std::uint32_t from = 0, to = 0;
  bool operator>(const Collapse& other) const {
    return std::tie(cost, from, to) > std::tie(other.cost, other.from, other.to);
  }
};

class Simplifier {
 public:
  Simplifier(const FieldMesh& mesh, const SimplifySurfaceOptions& options)
      : mesh_(mesh), options_(options), face_count_(mesh.faces.size()) {
    const std::size_t vertex_count = mesh.positions.size();
    faces_of_.resize(vertex_count);
    quadrics_.resize(vertex_count);
    on_line_.assign(vertex_count, 0);
    is_queued_.assign(vertex_count, 0);
    importance_.assign(vertex_count, 1.0);
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
      for (const std::uint32_t v : mesh.faces[f]) faces_of_[v].push_back(f);
    }
    if (options.importance) {
      for (std::size_t v = 0; v < vertex_count; ++v) importance_[v] = options.importance(mesh.positions[v]);
    }
    sumQuadrics();
  }

  FieldMesh run(const Field& field) {
    thinOut();
    for (std::uint32_t v = 0; v < faces_of_.size(); ++v) enqueue(v);
    // Costs in the queue may be out of date: a vertex is asked again when its turn comes.
    while (face_count_ > options_.target_faces && !queue_.empty()) {
      const Collapse stale = queue_.top();
      queue_.pop();
      is_queued_[stale.from] = 0;
      if (faces_of_[stale.from].empty()) continue;
      const Collapse best = findBest(stale.from);
      if (best.to == best.from) continue;
      if (!queue_.empty() && best > queue_.top()) {
        is_queued_[best.from] = 1;
        queue_.push(best);
        continue;
      }
      apply(best);
      enqueue(best.to);
      neighbours(best.to, touched_);
      for (const std::uint32_t v : touched_) enqueue(v);
    }
    settle(field);
    for (int round = 0; round < options_.relax_rounds; ++round) relax(field);
    std::vector<std::uint8_t> keep(mesh_.faces.size());
    for (std::size_t f = 0; f < keep.size(); ++f) keep[f] = isAlive(mesh_.faces[f]) ? 1 : 0;
    return keepFaces(mesh_, keep);
  }

 private:
  void enqueue(std::uint32_t v) {
    if (is_queued_[v] != 0) return;
    const Collapse best = findBest(v);
    if (best.to == v) return;  // asked again when a neighbour has changed
    is_queued_[v] = 1;
    queue_.push(best);
  }

  /// Most vertices of the grid cost next to nothing: they go in a few sweeps, without a queue.
  void thinOut() {
    const double edge = 0.2 * fine_edge_;  // about the grid's cell
    double limit = options_.compactness * options_.compactness * 6.0 * edge * edge * edge * edge;
    for (int sweep = 0; sweep < 4 && face_count_ > 12 * options_.target_faces; ++sweep, limit *= 4.0) {
      for (std::uint32_t v = 0; v < faces_of_.size(); ++v) {
        if (faces_of_[v].empty()) continue;
        const Collapse best = findBest(v);
        if (best.to != v && best.cost < limit) apply(best);
      }
    }
  }

  static bool isAlive(const Triangle& face) { return face[0] != face[1]; }
  static bool has(const Triangle& face, std::uint32_t v) {
    return face[0] == v || face[1] == v || face[2] == v;
  }
  Vec3d position(std::uint32_t v) const { return Vec3d(mesh_.positions[v]); }

  Vec3d areaNormal(const Triangle& face) const {
    const Vec3d a = position(face[0]);
    return 0.5 * glm::cross(position(face[1]) - a, position(face[2]) - a);
  }

  void sumQuadrics() {
    double area_sum = 0.0;
    for (const Triangle& face : mesh_.faces) area_sum += glm::length(areaNormal(face));
    fine_edge_ =
        5.0 * std::sqrt(area_sum / static_cast<double>(std::max<std::size_t>(mesh_.faces.size(), 1)));
    normals_.assign(mesh_.positions.size(), Vec3(0.0f));
    for (const Triangle& face : mesh_.faces) {
      for (const std::uint32_t v : face) normals_[v] += Vec3(areaNormal(face));
    }
    for (Vec3& normal : normals_) normal /= std::max(glm::length(normal), 1e-12f);
    for (const Triangle& face : mesh_.faces) {
      const Vec3d normal = areaNormal(face);
      const double area = glm::length(normal);
      for (int corner = 0; corner < 3; ++corner) {
        if (area > 1e-14) quadrics_[face[corner]].addPlane(normal / area, position(face[corner]), area);
        addLinePlane(face, corner, normal / std::max(area, 1e-14));
      }
    }
  }

  /// A border or a line between labels keeps its place by a plane upright on the face beside it.
  void addLinePlane(const Triangle& face, int corner, const Vec3d& normal) {
    const std::uint32_t a = face[corner], b = face[(corner + 1) % 3];
    const Line line = lineOf(a, b);
    if (line == Line::kNone) return;
    on_line_[a] = on_line_[b] = 1;
    const Vec3d edge = position(b) - position(a);
    const double length = glm::length(edge);
    const Vec3d upright = glm::cross(edge, normal);
    if (line == Line::kMirrorPlane || glm::length(upright) < 1e-9) return;
    for (const std::uint32_t v : {a, b}) {
      quadrics_[v].addPlane(glm::normalize(upright), position(a), length * length);
    }
  }

  Line lineOf(std::uint32_t a, std::uint32_t b) const {
    int found = 0;
    std::uint8_t label = 0;
    bool differs = false;
    for (const std::uint32_t f : faces_of_[a]) {
      if (!has(mesh_.faces[f], b)) continue;
      differs = differs || (found > 0 && mesh_.labels[f] != label);
      label = mesh_.labels[f];
      ++found;
    }
    if (found == 1) {
      const bool on_plane = mesh_.positions[a].x == 0.0f && mesh_.positions[b].x == 0.0f;
      return on_plane ? Line::kMirrorPlane : Line::kBorder;
    }
    return differs ? Line::kLabels : Line::kNone;
  }

  /// The vertices that share a face with v, ascending.
  void neighbours(std::uint32_t v, std::vector<std::uint32_t>& result) const {
    result.clear();
    for (const std::uint32_t f : faces_of_[v]) {
      for (const std::uint32_t other : mesh_.faces[f]) {
        if (other != v && std::find(result.begin(), result.end(), other) == result.end())
          result.push_back(other);
      }
    }
    std::sort(result.begin(), result.end());
  }

  /// The kind of line that v may slide along, or nothing where lines meet or end: there it stays.
  std::optional<Line> ownLine(std::uint32_t v, const std::vector<std::uint32_t>& around,
                              std::vector<Line>& lines) const {
    lines.assign(around.size(), Line::kNone);
    if (on_line_[v] == 0) return Line::kNone;
    std::array<std::size_t, 4> counts{};
    for (std::size_t i = 0; i < around.size(); ++i) {
      lines[i] = lineOf(v, around[i]);
      ++counts[static_cast<std::size_t>(lines[i])];
    }
    if (counts[0] == around.size()) return Line::kNone;
    for (const Line line : {Line::kLabels, Line::kBorder, Line::kMirrorPlane}) {
      if (counts[static_cast<std::size_t>(line)] == 2 && counts[0] + 2 == around.size()) return line;
    }
    return std::nullopt;
  }

  /// The cheapest allowed collapse of v onto a neighbour; onto itself if there is none.
  Collapse findBest(std::uint32_t v) {
    neighbours(v, around_);
    const std::optional<Line> own = ownLine(v, around_, lines_);
    if (!own) return {0.0, v, v};
    candidates_.clear();
    double area = 0.0;
    for (const std::uint32_t f : faces_of_[v]) area += glm::length(areaNormal(mesh_.faces[f]));
    for (std::size_t i = 0; i < around_.size(); ++i) {
      if (lines_[i] == *own) candidates_.push_back({cost(v, around_[i], area), v, around_[i]});
    }
    std::sort(candidates_.begin(), candidates_.end(),
              [](const Collapse& a, const Collapse& b) { return b > a; });
    for (const Collapse& candidate : candidates_) {
      if (isAllowed(candidate, *own)) return candidate;
    }
    return {0.0, v, v};
  }

  double cost(std::uint32_t from, std::uint32_t to, double area) const {
    const Vec3d edge = position(to) - position(from);
    const double stretch = options_.compactness * options_.compactness * glm::dot(edge, edge) * area;
    return (quadrics_[from].at(position(to)) + stretch) * std::max(importance_[from], importance_[to]);
  }

  /// Twice the area over the longest edge squared: 0 for a splinter, 0.87 for a regular triangle.
  double shape(const Triangle& face, double area) const {
    double longest = 1e-18;
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3d edge = position(face[(corner + 1) % 3]) - position(face[corner]);
      longest = std::max(longest, glm::dot(edge, edge));
    }
    return 2.0 * area / longest;
  }

  /// Whether the surface stays a manifold, no face turns over, and none becomes a splinter. Expects
  /// `around_` to hold the neighbours of collapse.from.
  bool isAllowed(const Collapse& collapse, Line line) {
    neighbours(collapse.to, other_);
    std::size_t common = 0;
    for (const std::uint32_t v : other_)
      common += std::binary_search(around_.begin(), around_.end(), v) ? 1 : 0;
    const bool on_border = line == Line::kBorder || line == Line::kMirrorPlane;
    if (common != (on_border ? 1u : 2u)) return false;  // the link condition
    if (around_.size() <= 3 && other_.size() <= 3) return false;
    for (const std::uint32_t f : faces_of_[collapse.from]) {
      Triangle face = mesh_.faces[f];
      if (has(face, collapse.to)) continue;
      // Splinters of the grid go away by themselves; only those that would last are refused.
      const double before_shape = shape(face, glm::length(areaNormal(face)));
      std::replace(face.begin(), face.end(), collapse.from, collapse.to);
      const Vec3d after = areaNormal(face);
      const double after_area = glm::length(after);
      // Faces of the grid are too small to have a direction of their own, so the vertices tell it.
      for (const std::uint32_t v : face) {
        if (glm::dot(Vec3d(normals_[v]), after) < 0.25 * after_area) return false;
      }
      const double after_shape = shape(face, after_area);
      if (after_area < 1e-10) return false;
      const bool is_fine = 2.0 * after_area < after_shape * fine_edge_ * fine_edge_;
      if (!is_fine && after_shape < 0.15 && after_shape < before_shape) return false;
    }
    return true;
  }

  void apply(const Collapse& collapse) {
    const std::uint32_t from = collapse.from, to = collapse.to;
    quadrics_[to].add(quadrics_[from]);
    importance_[to] = std::max(importance_[to], importance_[from]);
    for (const std::uint32_t f : faces_of_[from]) {
      Triangle& face = mesh_.faces[f];
      if (has(face, to)) {
        for (const std::uint32_t v : face) {
          if (v != from) std::erase(faces_of_[v], f);
        }
        face = {0, 0, 0};
        --face_count_;
      } else {
        std::replace(face.begin(), face.end(), from, to);
        faces_of_[to].push_back(f);
      }
    }
    faces_of_[from].clear();
  }

  /// Moves every vertex onto the surface.
  void settle(const Field& field) {
    for (std::uint32_t v = 0; v < faces_of_.size(); ++v) {
      if (!faces_of_[v].empty()) moveTo(v, projectToSurface(field, mesh_.positions[v], 0.004f));
    }
  }

  /// Moves each vertex that lies on no line towards the middle of its neighbours, along the surface.
  void relax(const Field& field) {
    for (std::uint32_t v = 0; v < faces_of_.size(); ++v) {
      if (faces_of_[v].empty() || on_line_[v] != 0 || importance_[v] > kKeepPlace) continue;
      neighbours(v, around_);
      Vec3 middle(0.0f);
      for (const std::uint32_t n : around_) middle += mesh_.positions[n];
      const Vec3 normal = fieldNormal(field, mesh_.positions[v]);
      const Vec3 step = middle / static_cast<float>(around_.size()) - mesh_.positions[v];
      const Vec3 tangent = step - normal * glm::dot(step, normal);
      moveTo(v, projectToSurface(field, mesh_.positions[v] + 0.35f * tangent, 0.01f));
    }
  }

  /// Moves a vertex, unless that tilts one of its faces by much.
  void moveTo(std::uint32_t v, Vec3 target) {
    const Vec3 before = mesh_.positions[v];
    if (before.x == 0.0f) target.x = 0.0f;
    for (const std::uint32_t f : faces_of_[v]) {
      mesh_.positions[v] = before;
      const Vec3d old_normal = areaNormal(mesh_.faces[f]);
      mesh_.positions[v] = target;
      const Vec3d new_normal = areaNormal(mesh_.faces[f]);
      const double product = glm::length(old_normal) * glm::length(new_normal);
      if (glm::dot(old_normal, new_normal) < 0.8 * product || product == 0.0) {
        mesh_.positions[v] = before;
        return;
      }
    }
  }

  FieldMesh mesh_;
  const SimplifySurfaceOptions& options_;
  std::size_t face_count_;
  std::vector<std::vector<std::uint32_t>> faces_of_;
  double fine_edge_ = 0.0;     // metres; longer edges are those of the result
  std::vector<Vec3> normals_;  // of the vertices, averaged over the fine mesh
  std::vector<Quadric> quadrics_;
  std::vector<double> importance_;
  std::vector<std::uint8_t> on_line_, is_queued_;
  std::priority_queue<Collapse, std::vector<Collapse>, std::greater<>> queue_;
  std::vector<std::uint32_t> around_, other_, touched_;  // scratch
  std::vector<Line> lines_;
  std::vector<Collapse> candidates_;
};

}  // namespace

FieldMesh simplifySurface(const FieldMesh& mesh, const Field& field, const SimplifySurfaceOptions& options) {
  ENSEMBLE_CHECK(mesh.labels.size() == mesh.faces.size());
  return Simplifier(mesh, options).run(field);
}

}  // namespace ensemble
