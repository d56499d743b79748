#include "assetpipe/mesh_levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "assetpipe/body_motion.h"
#include "assetpipe/pipeline.h"
#include "core/collapse.h"
#include "core/gltf_file.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

namespace fs = std::filesystem;
using ::testing::IsSubsetOf;

const fs::path kPeople = "../shared/people";  // tests run in the project's folder

/// Vertices, faces and collapses of a mesh, or of several parts of one.
struct Mesh {
  std::vector<RawVertex> vertices;
  std::vector<Triangle> faces;
  std::vector<VertexCollapse> collapses;

  void add(const ItemPart& part) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Triangle& face : part.faces)
      faces.push_back({face[0] + first, face[1] + first, face[2] + first});
    for (const VertexCollapse& collapse : part.collapses)
      collapses.push_back({collapse.target + first, collapse.level});
  }
  std::vector<Triangle> at(std::uint32_t level) const {
    return facesAtLevel(faces, verticesAtLevel(collapses, level),
                        [&](std::uint32_t v) { return vertices[v].position; });
  }
};

Mesh meshOf(const TemplateBody& body) {
  return {body.vertices.raw(), body.faces.raw(), body.collapses.raw()};
}

Mesh meshOf(const Garment& garment) {
  Mesh mesh;
  for (const ItemPart& part : garment.parts) mesh.add(part);
  return mesh;
}

using Place = std::array<float, 3>;

/// The places where the surface ends: the ends of edges that one face alone has.
std::set<Place> bordersOf(const Mesh& mesh, const std::vector<Triangle>& faces) {
  std::map<std::pair<Place, Place>, int> edges;
  const auto place = [&](std::uint32_t v) {
    const Vec3 p = mesh.vertices[v].position;
    return Place{p.x, p.y, p.z};
  };
  for (const Triangle& face : faces) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Place a = place(face[c]), b = place(face[(c + 1) % 3]);
      ++edges[{std::min(a, b), std::max(a, b)}];
    }
  }
  std::set<Place> borders;
  for (const auto& [edge, count] : edges) {
    if (count == 1) borders.insert({edge.first, edge.second});
  }
  return borders;
}

/// At every level the surface ends only where it ended at full detail: nothing opens between triangles,
/// regions, materials and seams, in no pose, as corners in one place are moved by the same joints.
void expectNoCracks(const Mesh& mesh, const std::string& name) {
  ASSERT_EQ(mesh.collapses.size(), mesh.vertices.size()) << name;
  ASSERT_TRUE(areValid(mesh.collapses)) << name;
  EXPECT_EQ(mesh.at(0), mesh.faces) << name;
  std::set<Place> borders = bordersOf(mesh, mesh.faces);
  for (std::uint32_t level = 1; level < levelCount(mesh.collapses); ++level) {
    const std::set<Place> left = bordersOf(mesh, mesh.at(level));
    EXPECT_THAT(left, IsSubsetOf(borders)) << name << " at level " << level;
    borders = left;
  }
}

class RealLevels : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!fs::exists(kPeople / "expected.json"))
      GTEST_SKIP() << "LOUD: ../shared/people is absent, so the levels of real people were not checked";
  }
  Wardrobe tagged(const PipelineOptions& options = {}) const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(kPeople / GetParam() / "outfits"))
      files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    tagWardrobe(kPeople / GetParam() / "template.glb", files, folder_.path(), options);
    return loadWardrobe(folder_.path());
  }
  testing::TemporaryFolder folder_;
};

TEST_P(RealLevels, NothingOpensAtAnyLevel) {
  const Wardrobe wardrobe = tagged();
  expectNoCracks(meshOf(wardrobe.body), "the body");
  for (const Item& item : wardrobe.items) {
    for (const Garment& garment : item.garments)
      expectNoCracks(meshOf(garment), item.name + ", " + garment.name);
  }
}

TEST_P(RealLevels, EachHasAboutThreeQuartersOfTheLastOnesFaces) {
  const Wardrobe wardrobe = tagged();
  std::vector<Mesh> meshes = {meshOf(wardrobe.body)};
  for (const Item& item : wardrobe.items) {
    for (const Garment& garment : item.garments) meshes.push_back(meshOf(garment));
  }
  for (const Mesh& mesh : meshes) {
    ASSERT_EQ(levelCount(mesh.collapses), 12u);
    for (std::uint32_t level = 1; level < 10; ++level) {
      const double share =
          static_cast<double>(mesh.at(level).size()) / static_cast<double>(mesh.at(level - 1).size());
      EXPECT_GT(share, 0.65) << level;
      EXPECT_LT(share, 0.80) << level;
    }
    EXPECT_LT(mesh.at(11).size() * 18, mesh.faces.size()) << "the coarsest";
  }
}

TEST_P(RealLevels, AddATenthOfTheFilesAtMost) {
  const Wardrobe wardrobe = tagged();
  std::size_t with = writeGlb(assetFromTemplate(wardrobe.body)).size(), without = 0;
  TemplateBody plain = wardrobe.body;
  plain.collapses = {};
  without += writeGlb(assetFromTemplate(plain)).size();
  for (Item item : wardrobe.items) {
    with += writeGlb(assetFromItem(item, plain, wardrobe.geometry_hash)).size();
    for (Garment& garment : item.garments) {
      for (ItemPart& part : garment.parts) part.collapses.clear();
    }
    without += writeGlb(assetFromItem(item, plain, wardrobe.geometry_hash)).size();
  }
  EXPECT_GT(with, without);
  EXPECT_LT(static_cast<double>(with), 1.1 * static_cast<double>(without));
}

TEST_P(RealLevels, GarmentsAreBroughtDownForGood) {
  PipelineOptions options;
  options.tag.garment_faces = 2000;
  const Wardrobe full = tagged(), reduced = tagged(options);
  for (std::size_t i = 0; i < full.items.size(); ++i) {
    const Item &before = full.items[ItemId(i)], &after = reduced.items[ItemId(i)];
    EXPECT_EQ(after.visible, before.visible) << "authored tags do not depend on the garments";
    ASSERT_EQ(after.garments.size(), before.garments.size());
    for (std::size_t g = 0; g < after.garments.size(); ++g) {
      const Mesh mesh = meshOf(after.garments[g]), was = meshOf(before.garments[g]);
      EXPECT_LE(mesh.faces.size(), 2000u);
      EXPECT_GE(mesh.faces.size(), std::min<std::size_t>(1850, was.faces.size()));
      EXPECT_THAT(bordersOf(mesh, mesh.faces), IsSubsetOf(bordersOf(was, was.faces)));
      expectNoCracks(mesh, after.name);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BothSexes, RealLevels, ::testing::Values("female", "male"));

TEST(ReduceFaces, TellsWhatStays) {
  Garment scarf{"scarf", {{}}};
  scarf.parts[0].vertices.resize(3);
  scarf.parts[0].vertices[1].position = Vec3(1, 0, 0);
  scarf.parts[0].vertices[2].position = Vec3(0, 1, 0);
  scarf.parts[0].faces = {{0, 1, 2}};
  const Garment before = scarf;
  EXPECT_EQ(reduceFaces(scarf, 1, {}), 1u);
  scarf.parts[0].faces.push_back({0, 2, 1});
  EXPECT_EQ(reduceFaces(scarf, 1, {}), 2u) << "a triangle's two sides are solid";
  EXPECT_EQ(scarf.parts[0].vertices, before.parts[0].vertices);
}

}  // namespace
}  // namespace ensemble
