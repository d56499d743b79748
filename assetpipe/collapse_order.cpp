#include "assetpipe/collapse_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

#include "assetpipe/quadric.h"
#include "core/check.h"
#include "core/clip.h"
#include "core/collapse.h"

namespace ensemble {
namespace {

using Vec3d = glm::dvec3;

/// A face may tilt by less than 75 degrees in any pose.
constexpr double kLeastCosine = 0.25;
/// Outlines and seams count as much as faces beside them that stand upright would.
constexpr double kLineWeight = 1.0;

struct Candidate {
  double cost = 0.0;
  std::uint32_t from = 0, to = 0;  ///< positions; the same: there is none
  bool operator>(const Candidate& other) const {
    return std::tie(cost, from, to) > std::tie(other.cost, other.from, other.to);
  }
};

/// What an edge between two positions is.
enum class Edge : std::uint8_t {
  kSmooth,  ///< two faces with the same wedges
  kLine,    ///< a border, or a seam between wedges
  kTangle   ///< of more than two faces
};

/// What two skin bindings have in common, 0 to 1.
double likeness(const SkinBinding& a, const SkinBinding& b) {
  double common = 0.0;
  for (std::size_t i = 0; i < a.joints.size(); ++i) {
    for (std::size_t j = 0; j < b.joints.size(); ++j) {
      if (a.joints[i] == b.joints[j]) common += std::min(a.weights[i], b.weights[j]);
    }
  }
  return common;
}

class Orderer {
 public:
  Orderer(const CollapseMesh& mesh, const CollapseOptions& options)
      : mesh_(mesh),
        options_(options),
        position_count_(mesh.poses.front().size()),
        faces_(mesh.faces),
        faces_of_(position_count_),
        wedges_of_(position_count_),
        quadrics_(mesh.poses.size() * position_count_),
        is_locked_(position_count_, 0),
        is_queued_(position_count_, 0) {
    for (std::uint32_t wedge = 0; wedge < mesh.position_of_vertex.size(); ++wedge) {
      collapses_.push_back({wedge, 0});
      wedges_of_[at(wedge)].push_back(wedge);
    }
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      if (!isAlive(f)) continue;
      for (const std::uint32_t vertex : faces_[f]) faces_of_[at(vertex)].push_back(f);
    }
    // A position without a face is never shown and does not count.
    for (const auto& faces : faces_of_) shown_ += faces.empty() ? 0 : 1;
    sumQuadrics();
  }

  std::vector<VertexCollapse> run() {
    const std::uint32_t steps = std::max(options_.levels, 1u) - 1;
    const double share = std::clamp(double{options_.coarsest_share}, 1e-6, 1.0);
    const double all = static_cast<double>(shown_);
    std::uint32_t made = 0;
    for (std::uint32_t step = 1; step <= steps; ++step) {
      const double left = all * std::pow(share, static_cast<double>(step) / steps);
      if (makeLevel(made + 1, static_cast<std::size_t>(std::ceil(left)))) ++made;
    }
    goWithLastFaces(made);
    return std::move(collapses_);
  }

 private:
  /// Wedges that no face shows any more are not kept for their position's sake.
  void goWithLastFaces(std::uint32_t coarsest) {
    std::vector<std::uint32_t> first_unused(collapses_.size(), 1);
    for (std::uint32_t level = 1; level <= coarsest; ++level) {
      const auto position_of = [&](std::uint32_t vertex) { return at(vertex); };
      for (const Triangle& face :
           facesAtLevel(mesh_.faces, verticesAtLevel(collapses_, level), position_of)) {
        for (const std::uint32_t vertex : face) first_unused[vertex] = level + 1;
      }
    }
    for (std::uint32_t vertex = 0; vertex < collapses_.size(); ++vertex) {
      if (first_unused[vertex] <= coarsest && isShownAt(collapses_[vertex], first_unused[vertex]))
        collapses_[vertex] = {vertex, static_cast<std::uint8_t>(first_unused[vertex])};
    }
    for (std::uint32_t vertex = 0; vertex < collapses_.size(); ++vertex) {
      VertexCollapse& collapse = collapses_[vertex];
      if (!isShownAt(collapses_[collapse.target], collapse.level)) collapse.target = vertex;
    }
  }

  std::uint32_t at(std::uint32_t vertex) const { return mesh_.position_of_vertex[vertex]; }
  bool isAlive(std::uint32_t f) const {
    const Triangle& face = faces_[f];
    return at(face[0]) != at(face[1]) && at(face[1]) != at(face[2]) && at(face[2]) != at(face[0]);
  }
  bool touches(std::uint32_t f, std::uint32_t position) const {
    return at(faces_[f][0]) == position || at(faces_[f][1]) == position || at(faces_[f][2]) == position;
  }
  /// The wedge of a position in a face that touches it.
  std::uint32_t wedgeIn(std::uint32_t f, std::uint32_t position) const {
    return *std::find_if(faces_[f].begin(), faces_[f].end(),
                         [&](std::uint32_t vertex) { return at(vertex) == position; });
  }
  Vec3d posed(std::size_t pose, std::uint32_t position) const { return Vec3d(mesh_.poses[pose][position]); }
  Vec3d areaNormal(std::size_t pose, const std::array<std::uint32_t, 3>& corners) const {
    const Vec3d a = posed(pose, corners[0]);
    return 0.5 * glm::cross(posed(pose, corners[1]) - a, posed(pose, corners[2]) - a);
  }
  std::array<std::uint32_t, 3> corners(std::uint32_t f) const {
    return {at(faces_[f][0]), at(faces_[f][1]), at(faces_[f][2])};
  }
  Quadric& quadric(std::size_t pose, std::uint32_t position) {
    return quadrics_[pose * position_count_ + position];
  }

  void sumQuadrics() {
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      if (!isAlive(f)) continue;
      const std::array<std::uint32_t, 3> face = corners(f);
      std::array<bool, 3> is_line{};
      for (std::size_t c = 0; c < 3; ++c) is_line[c] = edgeOf(face[c], face[(c + 1) % 3]) != Edge::kSmooth;
      for (std::size_t pose = 0; pose < mesh_.poses.size(); ++pose) {
        const Vec3d normal = areaNormal(pose, face);
        const double area = glm::length(normal);
        if (area < 1e-14) continue;
        for (std::size_t c = 0; c < 3; ++c) {
          quadric(pose, face[c]).addPlane(normal / area, posed(pose, face[c]), area);
          if (!is_line[c]) continue;
          // A plane upright on the face keeps the line where it is.
          const std::uint32_t other = face[(c + 1) % 3];
          const Vec3d edge = posed(pose, other) - posed(pose, face[c]);
          const double length = glm::length(edge);
          if (length < 1e-9) continue;
          const Vec3d upright = glm::cross(edge / length, normal / area);
          for (const std::uint32_t end : {face[c], other})
            quadric(pose, end).addPlane(upright, posed(pose, end), kLineWeight * length * length);
        }
      }
    }
  }

  Edge edgeOf(std::uint32_t a, std::uint32_t b) const {
    std::uint32_t count = 0;
    std::array<std::uint32_t, 2> first{};
    bool is_seam = false;
    for (const std::uint32_t f : faces_of_[a]) {
      if (!touches(f, b)) continue;
      const std::array<std::uint32_t, 2> wedges = {wedgeIn(f, a), wedgeIn(f, b)};
      if (count++ == 0) {
        first = wedges;
      } else {
        is_seam = is_seam || wedges != first;
      }
    }
    if (count > 2) return Edge::kTangle;
    return count == 1 || is_seam ? Edge::kLine : Edge::kSmooth;
  }

  void neighbours(std::uint32_t position, std::vector<std::uint32_t>& result) const {
    result.clear();
    for (const std::uint32_t f : faces_of_[position]) {
      for (const std::uint32_t vertex : faces_[f]) {
        if (at(vertex) != position) result.push_back(at(vertex));
      }
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
  }

  /// The cheapest allowed collapse of a position onto a neighbour.
  Candidate findBest(std::uint32_t from) {
    const Candidate none{0.0, from, from};
    if (is_locked_[from] != 0) return none;
    neighbours(from, around_);
    edges_.clear();
    std::size_t lines = 0;
    for (const std::uint32_t other : around_) {
      edges_.push_back(edgeOf(from, other));
      if (edges_.back() == Edge::kTangle) return none;
      lines += edges_.back() == Edge::kLine ? 1 : 0;
    }
    if (lines != 0 && lines != 2) return none;  // where lines end or meet
    const Edge along = lines == 0 ? Edge::kSmooth : Edge::kLine;
    candidates_.clear();
    for (std::size_t i = 0; i < around_.size(); ++i) {
      if (edges_[i] == along) candidates_.push_back({cost(from, around_[i]), from, around_[i]});
    }
    std::sort(candidates_.begin(), candidates_.end(), [](const auto& a, const auto& b) { return b > a; });
    for (const Candidate& candidate : candidates_) {
      if (isAllowed(candidate)) return candidate;
    }
    return none;
  }

  double cost(std::uint32_t from, std::uint32_t to) {
    double area = 0.0, sum = 0.0;
    for (const std::uint32_t f : faces_of_[from]) area += glm::length(areaNormal(0, corners(f)));
    for (std::size_t pose = 0; pose < mesh_.poses.size(); ++pose)
      sum += quadric(pose, from).at(posed(pose, to));
    sum /= static_cast<double>(mesh_.poses.size());
    double tolerance = double{options_.compactness} * options_.compactness;
    if (!mesh_.skins.empty()) {
      const double apart = options_.skin_weight * (1.0 - likeness(mesh_.skins[from], mesh_.skins[to]));
      tolerance += apart * apart;
    }
    const Vec3d edge = posed(0, to) - posed(0, from);
    return sum + tolerance * glm::dot(edge, edge) * area;
  }

  /// @pre `around_` holds the neighbours of candidate.from
  bool isAllowed(const Candidate& candidate) {
    const auto [cost, from, to] = candidate;
    if (!findWedges(from, to)) return false;
    // The link condition: who neighbours both are the far corners of the faces that go.
    std::size_t dying = 0, common = 0;
    for (const std::uint32_t f : faces_of_[from]) dying += touches(f, to) ? 1 : 0;
    neighbours(to, other_);
    for (const std::uint32_t position : other_)
      common += std::binary_search(around_.begin(), around_.end(), position) ? 1 : 0;
    if (common != dying) return false;
    // Closed pieces stay solid, and of open ones a triangle stays.
    if (around_.size() <= 3 && other_.size() <= 3) return false;
    for (const std::uint32_t f : faces_of_[from]) {
      if (touches(f, to)) continue;
      const std::array<std::uint32_t, 3> before = corners(f);
      std::array<std::uint32_t, 3> after = before;
      std::replace(after.begin(), after.end(), from, to);
      for (std::size_t pose = 0; pose < mesh_.poses.size(); ++pose) {
        const Vec3d old_normal = areaNormal(pose, before), new_normal = areaNormal(pose, after);
        const double product = glm::length(old_normal) * glm::length(new_normal);
        if (glm::dot(old_normal, new_normal) < kLeastCosine * product) return false;
      }
    }
    return true;
  }

  /// Fills `wedges_`: each wedge of `from`, and the one of `to` that continues its side. False where one has
  /// none or several.
  bool findWedges(std::uint32_t from, std::uint32_t to) {
    wedges_.clear();
    const auto find = [&](std::uint32_t wedge) {
      return std::find_if(wedges_.begin(), wedges_.end(),
                          [&](const auto& pair) { return pair.first == wedge; });
    };
    for (const std::uint32_t f : faces_of_[from]) {
      if (!touches(f, to)) continue;
      const std::pair<std::uint32_t, std::uint32_t> pair = {wedgeIn(f, from), wedgeIn(f, to)};
      const auto found = find(pair.first);
      if (found == wedges_.end()) {
        wedges_.push_back(pair);
      } else if (found->second != pair.second) {
        return false;
      }
    }
    return std::all_of(faces_of_[from].begin(), faces_of_[from].end(),
                       [&](std::uint32_t f) { return find(wedgeIn(f, from)) != wedges_.end(); });
  }

  void enqueue(std::uint32_t position) {
    if (is_queued_[position] != 0 || faces_of_[position].empty()) return;
    const Candidate best = findBest(position);
    if (best.to == position) return;  // asked again when a neighbour has changed
    is_queued_[position] = 1;
    queue_.push(best);
  }

  /// Collapses until as many positions are left; those that others moved onto outlast the level.
  /// @return whether any went
  bool makeLevel(std::uint32_t level, std::size_t left) {
    std::fill(is_locked_.begin(), is_locked_.end(), std::uint8_t{0});
    std::fill(is_queued_.begin(), is_queued_.end(), std::uint8_t{0});
    queue_ = {};
    for (std::uint32_t position = 0; position < position_count_; ++position) enqueue(position);
    const std::size_t before = shown_;
    while (shown_ > left && !queue_.empty()) {
      const Candidate stale = queue_.top();
      queue_.pop();
      is_queued_[stale.from] = 0;
      // Costs in the queue may be out of date: a position is asked again when its turn comes.
      const Candidate best = findBest(stale.from);
      if (best.to == best.from) continue;
      if (!queue_.empty() && best > queue_.top()) {
        is_queued_[best.from] = 1;
        queue_.push(best);
        continue;
      }
      apply(best, level);
      neighbours(best.to, touched_);
      for (const std::uint32_t position : touched_) enqueue(position);
    }
    return shown_ < before;
  }

  void apply(const Candidate& collapse, std::uint32_t level) {
    const std::uint32_t from = collapse.from, to = collapse.to;
    ENSEMBLE_CHECK(findWedges(from, to));
    // Those whose faces have all gone go nowhere: the next wedge may be of another part.
    for (const std::uint32_t wedge : wedges_of_[from])
      collapses_[wedge].level = static_cast<std::uint8_t>(level);
    for (const auto& [wedge, onto] : wedges_) collapses_[wedge].target = onto;
    is_locked_[to] = 1;
    --shown_;
    for (std::size_t pose = 0; pose < mesh_.poses.size(); ++pose) quadric(pose, to).add(quadric(pose, from));
    for (const std::uint32_t f : faces_of_[from]) {
      if (touches(f, to)) {
        for (const std::uint32_t corner : corners(f)) {
          if (corner != from) std::erase(faces_of_[corner], f);
        }
      } else {
        std::uint32_t& wedge = *std::find(faces_[f].begin(), faces_[f].end(), wedgeIn(f, from));
        wedge = collapses_[wedge].target;
        faces_of_[to].push_back(f);
      }
    }
    faces_of_[from].clear();
  }

  const CollapseMesh& mesh_;
  const CollapseOptions& options_;
  std::size_t position_count_, shown_ = 0;
  std::vector<Triangle> faces_;                        // as they are by now
  std::vector<std::vector<std::uint32_t>> faces_of_;   // per position
  std::vector<std::vector<std::uint32_t>> wedges_of_;  // per position
  std::vector<Quadric> quadrics_;                      // per pose and position
  std::vector<VertexCollapse> collapses_;              // per vertex
  std::vector<std::uint8_t> is_locked_, is_queued_;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue_;
  std::vector<std::uint32_t> around_, other_, touched_;  // scratch
  std::vector<Edge> edges_;
  std::vector<Candidate> candidates_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> wedges_;
};

}  // namespace

CollapseMesh makeCollapseMesh(std::span<const RawVertex> vertices, std::span<const Triangle> faces,
                              std::span<const std::vector<Mat4>> poses) {
  CollapseMesh mesh;
  mesh.faces.assign(faces.begin(), faces.end());
  mesh.poses.resize(1 + poses.size());
  std::map<std::array<float, 3>, std::uint32_t> position_at;
  for (const RawVertex& vertex : vertices) {
    // Adding 0 makes -0 equal to 0.
    const Vec3 place = vertex.position + 0.0f;
    const auto [found, is_new] =
        position_at.try_emplace({place.x, place.y, place.z}, static_cast<std::uint32_t>(mesh.skins.size()));
    mesh.position_of_vertex.push_back(found->second);
    if (!is_new) continue;
    mesh.skins.push_back(vertex.skin);
    mesh.poses[0].push_back(place);
    for (std::size_t pose = 0; pose < poses.size(); ++pose)
      mesh.poses[1 + pose].push_back(skinPosition(place, vertex.skin, poses[pose]));
  }
  return mesh;
}

std::vector<VertexCollapse> findCollapseOrder(const CollapseMesh& mesh, const CollapseOptions& options) {
  ENSEMBLE_CHECK(!mesh.poses.empty());
  ENSEMBLE_CHECK(options.levels <= 255u);
  return Orderer(mesh, options).run();
}

}  // namespace ensemble
