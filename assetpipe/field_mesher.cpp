// Marching tetrahedra over the Kuhn subdivision of a grid's cells: six tetrahedra around each cell's
// main diagonal, which fit together across cells, so the surface has no ambiguous case.
#include "assetpipe/field_mesher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/check.h"

namespace ensemble {
namespace {

using Node = std::array<int, 3>;

/// Corners of the tetrahedra as bits x=1, y=2, z=4, positively oriented.
constexpr int kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7},
                                   {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}};

class Mesher {
 public:
  Mesher(const Field& field, const FieldMesherOptions& options) : field_(field), options_(options) {
    if (options_.half) options_.low.x = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      count_[axis] =
          static_cast<int>(std::ceil((options_.high[axis] - options_.low[axis]) / options_.cell)) + 1;
      ENSEMBLE_CHECK(count_[axis] > 1);
      ENSEMBLE_CHECK(count_[axis] < (1 << 20));
    }
  }

  FieldMesh run() {
    seed();
    for (std::size_t next = 0; next < queue_.size(); ++next) {
      const Node cell = queue_[next];
      march(cell);
    }
    return std::move(mesh_);
  }

 private:
  static constexpr int kSeedStride = 4;

  std::uint64_t key(const Node& node) const {
    return (static_cast<std::uint64_t>(node[2]) << 40) | (static_cast<std::uint64_t>(node[1]) << 20) |
           static_cast<std::uint64_t>(node[0]);
  }

  Vec3 position(const Node& node) const {
    return options_.low + options_.cell * Vec3(static_cast<float>(node[0]), static_cast<float>(node[1]),
                                               static_cast<float>(node[2]));
  }

  float value(const Node& node) {
    const auto [entry, is_new] = values_.try_emplace(key(node), 0.0f);
    if (is_new) {
      const float raw = field_(position(node));
      entry->second = std::abs(raw) < 1e-6f ? 1e-6f : raw;  // no vertex exactly on a node
    }
    return entry->second;
  }

  void push(const Node& cell) {
    for (int axis = 0; axis < 3; ++axis) {
      if (cell[axis] < 0 || cell[axis] + 1 >= count_[axis]) return;
    }
    if (seen_.insert(key(cell)).second) queue_.push_back(cell);
  }

  /// Walks along each coarse edge that crosses the surface and pushes the cells around it.
  void seed() {
    for (int z = 0; z < count_[2]; z += kSeedStride) {
      for (int y = 0; y < count_[1]; y += kSeedStride) {
        for (int x = 0; x < count_[0]; x += kSeedStride) {
          for (int axis = 0; axis < 3; ++axis) seedEdge({x, y, z}, axis);
        }
      }
    }
  }

  void seedEdge(const Node& start, int axis) {
    Node end = start;
    end[axis] += kSeedStride;
    if (end[axis] >= count_[axis] || (value(start) < 0.0f) == (value(end) < 0.0f)) return;
    Node node = start;
    while (node[axis] < end[axis]) {
      Node after = node;
      ++after[axis];
      if ((value(node) < 0.0f) != (value(after) < 0.0f)) push(node);
      node = after;
    }
  }

  void march(const Node& cell) {
    std::array<Node, 8> corners;
    std::array<bool, 8> inside;
    for (int c = 0; c < 8; ++c) {
      corners[c] = {cell[0] + (c & 1), cell[1] + ((c >> 1) & 1), cell[2] + ((c >> 2) & 1)};
      inside[c] = value(corners[c]) < 0.0f;
    }
    for (const auto& tetrahedron : kTetrahedra) marchTetrahedron(corners, inside, tetrahedron);
    // The surface goes on behind every side of the cell that it crosses.
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        bool some_in = false, some_out = false;
        for (int c = 0; c < 8; ++c) {
          if (((c >> axis) & 1) == side) (inside[c] ? some_in : some_out) = true;
        }
        Node neighbour = cell;
        neighbour[axis] += side == 1 ? 1 : -1;
        if (some_in && some_out) push(neighbour);
      }
    }
  }

  void marchTetrahedron(const std::array<Node, 8>& corners, const std::array<bool, 8>& inside,
                        const int (&t)[4]) {
    // Even permutations of (0 1 2 3) that bring corner i, or the pair (i, j), to the front.
    static constexpr int kFirst[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
    static constexpr int kPairs[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                         {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};
    int count = 0;
    for (const int corner : t) count += inside[corner] ? 1 : 0;
    if (count == 0 || count == 4) return;
    const auto cut = [&](int a, int b) { return edgeVertex(corners[a], corners[b]); };
    if (count == 2) {
      for (const auto& pair : kPairs) {
        const int a = t[pair[0]], b = t[pair[1]], c = t[pair[2]], d = t[pair[3]];
        if (!inside[a] || !inside[b]) continue;
        const std::uint32_t quad[4] = {cut(a, c), cut(a, d), cut(b, d), cut(b, c)};
        mesh_.faces.push_back({quad[0], quad[1], quad[2]});
        mesh_.faces.push_back({quad[0], quad[2], quad[3]});
      }
      return;
    }
    for (const auto& first : kFirst) {
      const int a = t[first[0]], b = t[first[1]], c = t[first[2]], d = t[first[3]];
      if (inside[a] != (count == 1)) continue;
      const Triangle face{cut(a, b), cut(a, c), cut(a, d)};
      mesh_.faces.push_back(count == 1 ? face : Triangle{face[0], face[2], face[1]});
    }
  }

  std::uint32_t edgeVertex(Node a, Node b) {
    if (key(b) < key(a)) std::swap(a, b);
    const int direction = (b[0] - a[0]) + 2 * (b[1] - a[1]) + 4 * (b[2] - a[2]);
    // Nodes of a cell differ by 0 or 1 in each axis, all in the same direction along Kuhn edges.
    ENSEMBLE_CHECK(direction >= 1 && direction <= 7);
    const std::uint64_t edge = key(a) * 8 + static_cast<std::uint64_t>(direction);
    const auto [entry, is_new] = vertices_.try_emplace(edge, 0u);
    if (is_new) {
      entry->second = static_cast<std::uint32_t>(mesh_.positions.size());
      const float va = value(a), vb = value(b);
      const float t = std::clamp(va / (va - vb), 0.03f, 0.97f);
      mesh_.positions.push_back(glm::mix(position(a), position(b), t));
    }
    return entry->second;
  }

  const Field& field_;
  FieldMesherOptions options_;
  Node count_{};
  std::unordered_map<std::uint64_t, float> values_;            // looked up only, never walked
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;  // likewise
  std::unordered_set<std::uint64_t> seen_;
  std::vector<Node> queue_;
  FieldMesh mesh_;
};

}  // namespace

FieldMesh meshField(const Field& field, const FieldMesherOptions& options) {
  FieldMesh mesh = Mesher(field, options).run();
  mesh.labels.assign(mesh.faces.size(), 0);
  return mesh;
}

namespace {

/// Where a vertex goes to lie on both the border and the surface; where it is if that is too far.
Vec3 onBorder(const Vec3& start, const Field& field, const Field& border, float cell) {
  Vec3 position = start;
  for (int step = 0; step < 3; ++step) {
    const Vec3 gradient = fieldGradient(border, position);
    const Vec3 normal = fieldNormal(field, position);
    const Vec3 tangent = gradient - normal * glm::dot(gradient, normal);
    const float square = glm::dot(tangent, tangent);
    if (square < 1e-4f) break;
    position -= tangent * (border(position) / square);
    position = projectToSurface(field, position, cell);
  }
  if (glm::distance(position, start) > 1.5f * cell) return start;
  if (start.x == 0.0f) position.x = 0.0f;
  return position;
}

Vec3 areaNormal(const FieldMesh& mesh, std::uint32_t face) {
  const Triangle& corners = mesh.faces[face];
  const Vec3 a = mesh.positions[corners[0]];
  return glm::cross(mesh.positions[corners[1]] - a, mesh.positions[corners[2]] - a);
}

/// Moves a vertex unless one of its faces would turn over.
void moveVertex(FieldMesh& mesh, std::uint32_t v, const std::vector<std::uint32_t>& faces,
                const Vec3& target) {
  const Vec3 start = mesh.positions[v];
  for (const std::uint32_t f : faces) {
    const Vec3 before = areaNormal(mesh, f);
    mesh.positions[v] = target;
    const bool turns = glm::dot(before, areaNormal(mesh, f)) <= 0.0f;
    mesh.positions[v] = start;
    if (turns) return;
  }
  mesh.positions[v] = target;
}

}  // namespace

void snapToBorder(FieldMesh& mesh, const Field& field, const Field& border, float cell) {
  std::vector<float> level(mesh.positions.size());
  for (std::size_t v = 0; v < level.size(); ++v) level[v] = border(mesh.positions[v]);
  std::map<std::uint32_t, std::vector<std::uint32_t>> faces_of;  // of those to be moved
  for (const Triangle& face : mesh.faces) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t a = face[corner], b = face[(corner + 1) % 3];
      if ((level[a] < 0.0f) != (level[b] < 0.0f)) faces_of[std::abs(level[a]) < std::abs(level[b]) ? a : b];
    }
  }
  std::vector<std::uint8_t> is_near(mesh.positions.size(), 0);
  for (const auto& entry : faces_of) is_near[entry.first] = 1;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    for (const std::uint32_t v : mesh.faces[f]) {
      if (is_near[v] != 0) faces_of[v].push_back(f);
    }
  }
  for (const auto& [v, faces] : faces_of) {
    moveVertex(mesh, v, faces, onBorder(mesh.positions[v], field, border, cell));
  }
}

FieldMesh mirrored(const FieldMesh& half) {
  FieldMesh mesh = half;
  std::vector<std::uint32_t> image(half.positions.size());
  for (std::size_t v = 0; v < image.size(); ++v) {
    const Vec3& position = half.positions[v];
    image[v] = static_cast<std::uint32_t>(position.x == 0.0f ? v : mesh.positions.size());
    if (position.x != 0.0f) mesh.positions.push_back({-position.x, position.y, position.z});
  }
  for (std::size_t f = 0; f < half.faces.size(); ++f) {
    const Triangle& face = half.faces[f];
    mesh.faces.push_back({image[face[0]], image[face[2]], image[face[1]]});
    mesh.labels.push_back(half.labels[f]);
  }
  return mesh;
}

FieldMesh keepFaces(const FieldMesh& mesh, const std::vector<std::uint8_t>& keep) {
  ENSEMBLE_CHECK(keep.size() == mesh.faces.size());
  FieldMesh kept;
  std::vector<std::uint32_t> renumbered(mesh.positions.size(), ~0u);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if (keep[f] == 0) continue;
    Triangle face = mesh.faces[f];
    for (std::uint32_t& vertex : face) {
      if (renumbered[vertex] == ~0u) {
        renumbered[vertex] = static_cast<std::uint32_t>(kept.positions.size());
        kept.positions.push_back(mesh.positions[vertex]);
      }
      vertex = renumbered[vertex];
    }
    kept.faces.push_back(face);
    kept.labels.push_back(mesh.labels[f]);
  }
  return kept;
}

}  // namespace ensemble
