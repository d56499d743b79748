// The lists of the three techniques, on tagged outfits (core/sub_mesh_lists.h).
#include "core/sub_mesh_lists.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "assetpipe/segment.h"
#include "assetpipe/tag_regions.h"
#include "tests/support/small_people.h"

namespace ensemble {
namespace {

Wardrobe tubeWardrobe() {
  std::vector<std::string> warnings;
  Wardrobe wardrobe;
  wardrobe.body = segmentTemplate(testing::tubeTemplate(), {}, "tube.glb", warnings);
  const auto add = [&](const char* name, const auto& keep, float radius = 0.23f) {
    wardrobe.items.push(
        tagOutfit(testing::tubeOutfit(keep, radius), wardrobe.body, {}, name, name, warnings));
  };
  add("tunic", [](int region, int face) { return region == 0 || (region == 1 && face % 2 == 0); });
  add("hood", [](int region, int) { return region < 2; });
  add("same", [](int region, int face) { return region == 0 || (region == 1 && face % 2 == 0); });
  add(
      "wide", [](int region, int face) { return region != 1 || face < 10; }, 0.3f);
  return wardrobe;
}

std::vector<Combination> eachItem(const Wardrobe& wardrobe) {
  std::vector<Combination> combinations;
  for (std::size_t i = 0; i < wardrobe.items.size(); ++i) combinations.push_back({ItemId(i)});
  return combinations;
}

/// Corner positions of every face that a combination draws, garments and body apart.
using Corner = std::array<float, 3>;
std::multiset<std::array<Corner, 3>> drawnFaces(const SubMeshLists& lists, std::size_t combination,
                                                SubMeshKind kind) {
  std::multiset<std::array<Corner, 3>> faces;
  for (const SubMeshId id : lists.shown[combination]) {
    const SubMesh& sub_mesh = lists.sub_meshes[id];
    if (sub_mesh.kind != kind) continue;
    const IndexList& list = lists.index_lists[sub_mesh.list];
    const Mesh& mesh = lists.meshes[list.mesh];
    EXPECT_EQ(list.indices.size(), 3 * list.source_faces.size());
    for (std::size_t i = 0; i < list.indices.size(); i += 3) {
      std::array<Corner, 3> face;
      for (std::size_t k = 0; k < 3; ++k) {
        const float* p = mesh.vertices[list.indices[i + k]].position;
        face[k] = {p[0], p[1], p[2]};
      }
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
      faces.insert(face);
    }
  }
  return faces;
}

TEST(SubMeshLists, TechniquesDifferInHiddenBodyFacesOnly) {
  const Wardrobe wardrobe = tubeWardrobe();
  const auto combinations = eachItem(wardrobe);
  const SubMeshLists naive = buildSubMeshLists(wardrobe, combinations, Technique::kNaive);
  const SubMeshLists prefitted = buildSubMeshLists(wardrobe, combinations, Technique::kPrefitted);
  const SubMeshLists tagged = buildSubMeshLists(wardrobe, combinations, Technique::kTagged);
  for (std::size_t c = 0; c < combinations.size(); ++c) {
    for (const SubMeshKind kind : {SubMeshKind::kGarment, SubMeshKind::kBody}) {
      EXPECT_EQ(drawnFaces(tagged, c, kind), drawnFaces(prefitted, c, kind)) << c;
    }
    EXPECT_EQ(drawnFaces(tagged, c, SubMeshKind::kGarment), drawnFaces(naive, c, SubMeshKind::kGarment));
    EXPECT_EQ(drawnFaces(naive, c, SubMeshKind::kBody).size(), wardrobe.body.faces.size());
    EXPECT_EQ(drawnFaces(tagged, c, SubMeshKind::kBody).size(),
              wardrobe.items[ItemId(c)].visibleBodyFaceCount());
    std::size_t hidden = 0;
    for (const std::uint32_t word : tagged.hidden_sets[tagged.hidden_set[c]])
      hidden += static_cast<std::size_t>(__builtin_popcount(word));
    EXPECT_EQ(hidden, wardrobe.body.faces.size() - wardrobe.items[ItemId(c)].visibleBodyFaceCount());
  }
}

// Under another item garments lose faces, in tagged and pre-fitted; each face is stored once all the same.
TEST(SubMeshLists, TechniquesDifferInHiddenGarmentFacesOnly) {
  Wardrobe wardrobe = tubeWardrobe();
  const std::vector<Combination> combinations = {{ItemId(0)}, {ItemId(0), ItemId(1)}, {ItemId(0), ItemId(3)}};
  const std::uint64_t whole = buildSubMeshLists(wardrobe, combinations, Technique::kNaive).meshBytes();
  HiddenGarmentFaces under_hood(80, 0), under_wide(80, 0);
  std::fill_n(under_hood.begin(), 30, std::uint8_t{1});
  std::fill_n(under_wide.begin() + 20, 60, std::uint8_t{1});
  wardrobe.hidden_under[{ItemId(0), ItemId(1)}] = under_hood;
  wardrobe.hidden_under[{ItemId(0), ItemId(3)}] = under_wide;
  const SubMeshLists naive = buildSubMeshLists(wardrobe, combinations, Technique::kNaive);
  const SubMeshLists prefitted = buildSubMeshLists(wardrobe, combinations, Technique::kPrefitted);
  const SubMeshLists tagged = buildSubMeshLists(wardrobe, combinations, Technique::kTagged);
  EXPECT_EQ(naive.meshBytes(), whole + 80 * 6) << "the tunic in pieces, and whole, as it is the hood's, too";
  EXPECT_EQ(tagged.meshes.size(), naive.meshes.size());
  const std::size_t hidden[] = {0, 30, 60};
  for (std::size_t c = 0; c < combinations.size(); ++c) {
    const auto all = drawnFaces(naive, c, SubMeshKind::kGarment),
               left = drawnFaces(tagged, c, SubMeshKind::kGarment);
    EXPECT_EQ(left, drawnFaces(prefitted, c, SubMeshKind::kGarment)) << c;
    EXPECT_EQ(left.size() + hidden[c], all.size()) << c;
    EXPECT_TRUE(std::includes(all.begin(), all.end(), left.begin(), left.end())) << c;
    std::size_t covered = 0;
    for (const SubMeshId id : naive.shown[c]) {
      const SubMesh& sub_mesh = naive.sub_meshes[id];
      covered += sub_mesh.is_covered ? naive.index_lists[sub_mesh.list].source_faces.size() : 0;
    }
    EXPECT_EQ(covered, hidden[c]) << "cast no shadow";
    for (const SubMeshId id : tagged.shown[c]) EXPECT_FALSE(tagged.sub_meshes[id].is_covered);
  }
}

TEST(SubMeshLists, StoreEqualContentOnce) {
  const Wardrobe wardrobe = tubeWardrobe();
  const auto combinations = eachItem(wardrobe);
  const SubMeshLists tagged = buildSubMeshLists(wardrobe, combinations, Technique::kTagged);
  // The template, the tunic that three items share, the wide one.
  EXPECT_EQ(tagged.meshes.size(), 3u);
  // 3 generic regions, 2 garments, the torso's two partial sets (tunic = same, wide).
  EXPECT_EQ(tagged.index_lists.size(), 7u);
  EXPECT_EQ(tagged.shown[0], tagged.shown[2]);
  const SubMeshLists prefitted = buildSubMeshLists(wardrobe, combinations, Technique::kPrefitted);
  EXPECT_EQ(prefitted.meshes.size(), 2u + 3u) << "tunic and same have equal bodies";
}

TEST(SubMeshLists, CountBytesAsTheGpuHoldsThem) {
  const Wardrobe wardrobe = tubeWardrobe();
  const auto combinations = eachItem(wardrobe);
  const std::uint64_t body = wardrobe.body.vertices.size() * 40 + 192 * 6;
  const std::uint64_t garments = 2 * (48u * 40 + 80 * 6);
  EXPECT_EQ(lowerBoundBytes(wardrobe, combinations), body + garments);
  EXPECT_EQ(buildSubMeshLists(wardrobe, combinations, Technique::kNaive).meshBytes(), body + garments);
  EXPECT_EQ(buildSubMeshLists(wardrobe, combinations, Technique::kTagged).meshBytes(),
            body + garments + (32 + 10) * 6);
}

TEST(SubMeshLists, DrawGarmentsFirstAndFacesInOneOrder) {
  const Wardrobe wardrobe = tubeWardrobe();
  const auto combinations = eachItem(wardrobe);
  std::array<std::vector<std::vector<std::uint32_t>>, 3>
      order;  // per technique and combination: FaceIds as drawn
  for (const Technique technique : kAllTechniques) {
    const SubMeshLists lists = buildSubMeshLists(wardrobe, combinations, technique);
    for (std::size_t c = 0; c < combinations.size(); ++c) {
      auto& drawn = order[static_cast<std::size_t>(technique)].emplace_back();
      bool body_began = false;
      EXPECT_TRUE(std::is_sorted(lists.shown[c].begin(), lists.shown[c].end()));
      for (const SubMeshId id : lists.shown[c]) {
        const SubMesh& sub_mesh = lists.sub_meshes[id];
        EXPECT_FALSE(body_began && sub_mesh.kind == SubMeshKind::kGarment);
        body_began = sub_mesh.kind == SubMeshKind::kBody;
        const IndexList& list = lists.index_lists[sub_mesh.list];
        if (list.is_template) drawn.insert(drawn.end(), list.source_faces.begin(), list.source_faces.end());
      }
    }
  }
  for (std::size_t c = 0; c < combinations.size(); ++c) {
    EXPECT_EQ(order[1][c], order[2][c]) << "pre-fitted and tagged draw a body in different orders";
    std::vector<std::uint32_t> naive_visible;
    for (const std::uint32_t face : order[0][c]) {
      if (wardrobe.items[ItemId(c)].visible[FaceId(face)] != 0) naive_visible.push_back(face);
    }
    EXPECT_EQ(naive_visible, order[2][c]) << "naive draws visible faces in another order";
  }
}

TEST(SubMeshLists, CombineItemsByUnionOfWhatTheyHide) {
  const Wardrobe wardrobe = tubeWardrobe();
  const std::vector<Combination> combinations = {{}, {ItemId(0), ItemId(1)}};
  const SubMeshLists lists = buildSubMeshLists(wardrobe, combinations, Technique::kTagged);
  EXPECT_EQ(drawnFaces(lists, 0, SubMeshKind::kBody).size(), 192u) << "the bare body";
  EXPECT_EQ(drawnFaces(lists, 1, SubMeshKind::kBody).size(), 64u + 32u);
  EXPECT_EQ(drawnFaces(lists, 1, SubMeshKind::kGarment).size(), 80u) << "one shared garment is drawn once";
}

TEST(SubMeshLists, PackWeightsToExactlyOne) {
  RawVertex vertex;
  vertex.skin.joints = {3, 1, 2, 0};
  vertex.skin.weights = {1.0f / 3, 1.0f / 3, 1.0f / 3, 0.0f};
  const GpuVertex packed = packVertex(vertex);
  EXPECT_EQ(packed.weights[0] + packed.weights[1] + packed.weights[2] + packed.weights[3], 65535);
  vertex.skin.weights = {0.9999f, 0.00003f, 0.00004f, 0.00003f};
  const GpuVertex small = packVertex(vertex);
  EXPECT_EQ(small.weights[0] + small.weights[1] + small.weights[2] + small.weights[3], 65535);
}

TEST(SubMeshLists, NamesOfTechniques) {
  for (const Technique technique : kAllTechniques) EXPECT_EQ(parseTechnique(toString(technique)), technique);
  EXPECT_FALSE(parseTechnique("fitted").has_value());
}

}  // namespace
}  // namespace ensemble
