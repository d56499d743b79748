#include "assetpipe/surface_check.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace ensemble {
namespace {

struct Surface {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
  SurfaceCheck check() const { return checkSurface(positions, faces); }
};

/// A tetrahedron that faces outwards.
Surface tetrahedron(const Vec3& corner = Vec3(0.0f)) {
  return {{corner, corner + Vec3(1, 0, 0), corner + Vec3(0, 1, 0), corner + Vec3(0, 0, 1)},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

void append(Surface& surface, const Surface& other) {
  const auto first = static_cast<std::uint32_t>(surface.positions.size());
  surface.positions.insert(surface.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& f : other.faces) surface.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
}

TEST(SurfaceCheck, ATetrahedronIsSound) {
  const SurfaceCheck check = tetrahedron().check();
  EXPECT_TRUE(check.isSound());
  EXPECT_TRUE(check.crossings.empty());
}

TEST(SurfaceCheck, FindsAHole) {
  Surface surface = tetrahedron();
  surface.faces.pop_back();
  const SurfaceCheck check = surface.check();
  EXPECT_TRUE(check.is_manifold);
  EXPECT_FALSE(check.is_closed);
  EXPECT_FALSE(check.isSound());
}

TEST(SurfaceCheck, FindsWhatIsInsideOut) {
  Surface surface = tetrahedron();
  for (Triangle& face : surface.faces) std::swap(face[1], face[2]);
  const SurfaceCheck check = surface.check();
  EXPECT_TRUE(check.is_closed);
  EXPECT_FALSE(check.faces_outwards);
  EXPECT_FALSE(check.isSound());
}

TEST(SurfaceCheck, FindsFacesThatCutEachOtherAndWhere) {
  Surface surface = tetrahedron();
  append(surface, tetrahedron(Vec3(0.2f, 0.2f, 0.2f)));
  const SurfaceCheck check = surface.check();
  EXPECT_TRUE(check.is_closed);
  // The slanted face of the one cuts the three upright ones of the other.
  ASSERT_EQ(check.crossings.size(), 3u);
  for (const Vec3& at : check.crossings) EXPECT_LT(glm::distance(at, Vec3(0.35f)), 0.4f);
}

TEST(SurfaceCheck, FindsAnEdgeOfThreeFaces) {
  Surface surface = tetrahedron();
  surface.positions.emplace_back(1.0f, 1.0f, -1.0f);
  surface.faces.push_back({0, 2, 4});
  EXPECT_FALSE(surface.check().is_manifold);
  EXPECT_FALSE(Surface{}.check().is_manifold) << "nothing at all";
}

}  // namespace
}  // namespace ensemble
