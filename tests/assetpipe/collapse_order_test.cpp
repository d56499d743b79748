#include "assetpipe/collapse_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/collapse.h"

namespace ensemble {
namespace {

using ::testing::Each;
using ::testing::IsEmpty;
using ::testing::Not;

/// A tube along x, or with `caps` closed, whose quads are cut in two; one wedge a position.
CollapseMesh tube(std::uint32_t rings, std::uint32_t sides, bool caps) {
  CollapseMesh mesh;
  mesh.poses.resize(1);
  for (std::uint32_t r = 0; r < rings; ++r) {
    for (std::uint32_t s = 0; s < sides; ++s) {
      const float angle = 2.0f * kPi * static_cast<float>(s) / static_cast<float>(sides);
      mesh.poses[0].push_back({static_cast<float>(r) / static_cast<float>(rings - 1), 0.1f * std::cos(angle),
                               0.1f * std::sin(angle)});
    }
  }
  const auto at = [&](std::uint32_t r, std::uint32_t s) { return r * sides + s % sides; };
  for (std::uint32_t r = 0; r + 1 < rings; ++r) {
    for (std::uint32_t s = 0; s < sides; ++s) {
      mesh.faces.push_back({at(r, s), at(r, s + 1), at(r + 1, s + 1)});
      mesh.faces.push_back({at(r, s), at(r + 1, s + 1), at(r + 1, s)});
    }
  }
  if (caps) {
    for (const std::uint32_t r : {0u, rings - 1}) {
      const auto middle = static_cast<std::uint32_t>(mesh.poses[0].size());
      mesh.poses[0].emplace_back(r == 0 ? 0.0f : 1.0f, 0.0f, 0.0f);
      for (std::uint32_t s = 0; s < sides; ++s) {
        if (r == 0) {
          mesh.faces.push_back({at(r, s + 1), at(r, s), middle});
        } else {
          mesh.faces.push_back({at(r, s), at(r, s + 1), middle});
        }
      }
    }
  }
  for (std::uint32_t p = 0; p < mesh.poses[0].size(); ++p) mesh.position_of_vertex.push_back(p);
  return mesh;
}

/// Gives the faces beyond the middle, and those of every second half around, wedges of their own.
std::vector<std::uint32_t> splitWedges(CollapseMesh& mesh, std::uint32_t sides) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> wedges;  // position and part
  std::vector<std::uint32_t> parts, positions;
  for (Triangle& face : mesh.faces) {
    float x = 0.0f;
    std::uint32_t first_half = 0;
    for (const std::uint32_t p : face) {
      x += mesh.poses[0][p].x / 3.0f;
      first_half += p % sides > 0 && p % sides < sides / 2 ? 1 : 0;
    }
    const std::uint32_t part = (x > 0.5f ? 2u : 0u) + (first_half > 0 ? 1u : 0u);
    for (std::uint32_t& corner : face) {
      const auto [found, is_new] =
          wedges.try_emplace({corner, part}, static_cast<std::uint32_t>(positions.size()));
      if (is_new) {
        positions.push_back(corner);
        parts.push_back(part);
      }
      corner = found->second;
    }
  }
  mesh.position_of_vertex = positions;
  return parts;
}

using EdgeCounts = std::map<std::pair<std::uint32_t, std::uint32_t>, int>;

/// How often each edge between positions is used, as directed: a sound surface uses each at most once.
EdgeCounts edgesOf(const CollapseMesh& mesh, const std::vector<Triangle>& faces) {
  EdgeCounts edges;
  for (const Triangle& face : faces) {
    for (std::size_t c = 0; c < 3; ++c)
      ++edges[{mesh.position_of_vertex[face[c]], mesh.position_of_vertex[face[(c + 1) % 3]]}];
  }
  return edges;
}

/// Edges that only one face has, by their ends.
std::set<std::pair<std::uint32_t, std::uint32_t>> bordersOf(const CollapseMesh& mesh,
                                                            const std::vector<Triangle>& faces) {
  const EdgeCounts edges = edgesOf(mesh, faces);
  std::set<std::pair<std::uint32_t, std::uint32_t>> borders;
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1) << "a face is there twice, or turned over";
    if (!edges.contains({edge.second, edge.first})) borders.insert(edge);
  }
  return borders;
}

using Collapses = std::vector<VertexCollapse>;

std::vector<Triangle> at(const Collapses& order, const CollapseMesh& mesh, std::uint32_t level) {
  return facesAtLevel(mesh.faces, verticesAtLevel(order, level),
                      [&](std::uint32_t vertex) { return mesh.position_of_vertex[vertex]; });
}

std::set<std::uint32_t> positionsOf(const CollapseMesh& mesh, const std::vector<Triangle>& faces) {
  std::set<std::uint32_t> positions;
  for (const Triangle& face : faces) {
    for (const std::uint32_t vertex : face) positions.insert(mesh.position_of_vertex[vertex]);
  }
  return positions;
}

TEST(CollapseOrder, LevelsShrinkByAShareAndTargetsAreCoarser) {
  const CollapseMesh mesh = tube(40, 24, true);
  const Collapses order = findCollapseOrder(mesh, {.levels = 8, .coarsest_share = 0.05f});
  ASSERT_EQ(levelCount(order), 8u);
  EXPECT_EQ(at(order, mesh, 0), mesh.faces);
  const double all = static_cast<double>(mesh.poses[0].size());
  for (std::uint32_t level = 0; level < 8; ++level) {
    const auto shown = static_cast<double>(positionsOf(mesh, at(order, mesh, level)).size());
    EXPECT_NEAR(shown, all * std::pow(0.05, level / 7.0), 1.0) << level;
  }
  EXPECT_TRUE(areValid(order)) << "a target outlasts the whole level";
}

TEST(CollapseOrder, AClosedSurfaceStaysClosed) {
  const CollapseMesh mesh = tube(30, 16, true);
  const Collapses order = findCollapseOrder(mesh, {.levels = 10, .coarsest_share = 0.02f});
  for (std::uint32_t level = 0; level < levelCount(order); ++level) {
    const std::vector<Triangle> faces = at(order, mesh, level);
    EXPECT_THAT(bordersOf(mesh, faces), IsEmpty()) << level;
    EXPECT_EQ(faces.size(), 2 * positionsOf(mesh, faces).size() - 4) << "Euler's formula, level " << level;
  }
}

TEST(CollapseOrder, SeamsBordersAndRegionsGetCoarserAlikeOnBothSides) {
  CollapseMesh mesh = tube(41, 24, false);
  const std::vector<std::uint32_t> parts = splitWedges(mesh, 24);
  const Collapses order = findCollapseOrder(mesh, {.levels = 9, .coarsest_share = 0.05f});
  ASSERT_GT(levelCount(order), 4u);
  for (std::uint32_t level = 0; level < levelCount(order); ++level) {
    const std::vector<Triangle> faces = at(order, mesh, level);
    for (const auto& [from, to] : bordersOf(mesh, faces)) {
      EXPECT_EQ(mesh.poses[0][from].x, mesh.poses[0][to].x) << "a crack, level " << level;
      EXPECT_TRUE(mesh.poses[0][from].x == 0.0f || mesh.poses[0][from].x == 1.0f);
    }
    for (const Triangle& face : faces) {
      EXPECT_EQ(parts[face[0]], parts[face[1]]);
      EXPECT_EQ(parts[face[0]], parts[face[2]]);
    }
    // Each half alone ends in the middle, at the same places.
    std::array<std::set<std::pair<std::uint32_t, std::uint32_t>>, 2> in_the_middle;
    for (std::uint32_t half = 0; half < 2; ++half) {
      std::vector<Triangle> own;
      for (const Triangle& face : faces) {
        if (parts[face[0]] / 2 == half) own.push_back(face);
      }
      for (const auto& [from, to] : bordersOf(mesh, own)) {
        if (mesh.poses[0][from].x == 0.0f || mesh.poses[0][from].x == 1.0f) continue;
        in_the_middle[half].insert(half == 0 ? std::pair(from, to) : std::pair(to, from));
      }
    }
    EXPECT_EQ(in_the_middle[0], in_the_middle[1]) << level;
    EXPECT_GE(in_the_middle[0].size(), 3u);
  }
}

TEST(CollapseOrder, WhatBendsInAPoseKeepsItsRings) {
  const CollapseMesh straight = tube(41, 12, false);
  CollapseMesh bent = straight;
  bent.poses.push_back(straight.poses[0]);
  for (Vec3& p : bent.poses[1]) {
    const float angle = 1.5f * std::clamp((p.x - 0.4f) / 0.2f, 0.0f, 1.0f);
    p = Vec3(0.5f, 0.0f, 0.0f) + Vec3(std::cos(angle) * (p.x - 0.5f) - std::sin(angle) * p.y,
                                      std::sin(angle) * (p.x - 0.5f) + std::cos(angle) * p.y, p.z);
  }
  const auto around_the_bend = [](const CollapseMesh& mesh) {
    const Collapses order = findCollapseOrder(mesh, {.levels = 6, .coarsest_share = 0.15f});
    std::size_t count = 0;
    for (const std::uint32_t p : positionsOf(mesh, at(order, mesh, levelCount(order) - 1)))
      count += std::abs(mesh.poses[0][p].x - 0.5f) < 0.15f ? 1 : 0;
    return count;
  };
  EXPECT_GE(around_the_bend(bent), 2 * around_the_bend(straight));
}

TEST(CollapseOrder, IsTheSameEachTime) {
  const CollapseMesh mesh = tube(20, 12, true);
  const Collapses once = findCollapseOrder(mesh, {}), again = findCollapseOrder(mesh, {});
  EXPECT_EQ(once, again);
}

CollapseMesh meshOf(std::vector<Vec3> positions, std::vector<Triangle> faces) {
  CollapseMesh mesh{
      .poses = {std::move(positions)}, .position_of_vertex = {}, .skins = {}, .faces = std::move(faces)};
  for (std::uint32_t p = 0; p < mesh.poses[0].size(); ++p) mesh.position_of_vertex.push_back(p);
  return mesh;
}

TEST(CollapseOrder, WhatCantGetCoarserStays) {
  EXPECT_EQ(levelCount(findCollapseOrder(meshOf({}, {}), {})), 1u);
  const CollapseMesh triangle = meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  EXPECT_EQ(levelCount(findCollapseOrder(triangle, {})), 1u);
  const CollapseMesh none_with_area =
      meshOf({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}, {0, 0, 3}});
  EXPECT_EQ(levelCount(findCollapseOrder(none_with_area, {})), 1u);
  const CollapseMesh three_at_an_edge =
      meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}});
  const Collapses order = findCollapseOrder(three_at_an_edge, {});
  for (const std::uint32_t end : {0u, 1u}) EXPECT_EQ(order[end].target, end) << "an end of that edge";
  EXPECT_THAT(at(order, three_at_an_edge, levelCount(order) - 1), Not(IsEmpty()));
}

TEST(CollapseOrder, WedgesGoWithTheirLastFaces) {
  CollapseMesh mesh = tube(12, 8, true);
  const auto count = static_cast<std::uint32_t>(mesh.position_of_vertex.size());
  for (std::uint32_t p = 0; p < count; ++p) mesh.position_of_vertex.push_back(p);
  mesh.faces.push_back({count, count, count + 1});
  mesh.faces.front() = {mesh.faces[0][0] + count, mesh.faces[0][1] + count, mesh.faces[0][2] + count};
  const Collapses order = findCollapseOrder(mesh, {});
  ASSERT_TRUE(areValid(order));
  for (std::uint32_t level = 1; level < levelCount(order); ++level) {
    std::set<std::uint32_t> used;
    for (const Triangle& face : at(order, mesh, level)) used.insert(face.begin(), face.end());
    for (std::uint32_t v = 0; v < 2 * count; ++v)
      EXPECT_EQ(isShownAt(order[v], level), used.contains(v)) << v << " at " << level;
  }
}

TEST(CollapseOrder, NothingGoesToAnotherPart) {
  // Each face by itself, then stripes: where a part narrows to its last face, only the other part is near.
  for (const std::uint32_t part_faces : {1u, 3u, 16u, 40u}) {
    CollapseMesh mesh = tube(12, 8, true);
    const std::vector<Triangle> faces = mesh.faces;
    const std::vector<std::uint32_t> places = mesh.position_of_vertex;
    std::vector<std::uint32_t> part_of;
    mesh.position_of_vertex.clear();
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> vertex_of;
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
      for (std::uint32_t& vertex : mesh.faces[f]) {
        const auto count = static_cast<std::uint32_t>(part_of.size());
        const auto [found, is_new] = vertex_of.try_emplace({f / part_faces, vertex}, count);
        if (is_new) {
          part_of.push_back(f / part_faces);
          mesh.position_of_vertex.push_back(places[vertex]);
        }
        vertex = found->second;
      }
    }
    const Collapses order = findCollapseOrder(mesh, {.levels = 12, .coarsest_share = 0.02f});
    ASSERT_TRUE(areValid(order));
    for (std::uint32_t v = 0; v < order.size(); ++v)
      EXPECT_EQ(part_of[order[v].target], part_of[v]) << v << " of parts of " << part_faces;
  }
}

TEST(CollapseOrder, PiecesApartAllStay) {
  CollapseMesh mesh = tube(12, 8, true);
  const auto count = static_cast<std::uint32_t>(mesh.poses[0].size());
  const std::vector<Triangle> faces = mesh.faces;
  for (std::uint32_t p = 0; p < count; ++p) {
    mesh.poses[0].push_back(mesh.poses[0][p] + Vec3(0.0f, 1.0f, 0.0f));
    mesh.position_of_vertex.push_back(count + p);
  }
  for (const Triangle& face : faces)
    mesh.faces.push_back({face[0] + count, face[1] + count, face[2] + count});
  const Collapses order = findCollapseOrder(mesh, {.levels = 12, .coarsest_share = 0.001f});
  std::array<std::size_t, 2> left{};
  for (const Triangle& face : at(order, mesh, levelCount(order) - 1)) ++left[face[0] / count];
  EXPECT_THAT(left, Each(::testing::Ge(4u))) << "solid, however coarse";
}

}  // namespace
}  // namespace ensemble
