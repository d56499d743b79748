// An environment from its file to pieces.
#include "core/environment_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "core/image_file.h"
#include "tests/core/glb_builder.h"
#include "tests/support/expect_error.h"
#include "tests/support/small_sets.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

using ::testing::ElementsAre;
using testing::floorAt;
using testing::quad;
using testing::setOf;
using testing::skinnedGlb;
using testing::TestGlb;
using testing::triangleGlb;

/// Corners' positions of a piece, face by face.
std::vector<std::array<Vec3, 3>> facesOf(const EnvironmentPiece& piece) {
  std::vector<std::array<Vec3, 3>> faces;
  const auto at = [&](std::size_t i) {
    const float* p = piece.vertices[piece.indices[i]].position;
    return Vec3(p[0], p[1], p[2]);
  };
  for (std::size_t i = 0; i < piece.indices.size(); i += 3) faces.push_back({at(i), at(i + 1), at(i + 2)});
  return faces;
}

std::uint64_t faceCount(const EnvironmentMesh& mesh) {
  std::uint64_t count = 0;
  for (const EnvironmentPiece& piece : mesh.pieces) count += piece.indices.size() / 3;
  return count;
}

class EnvironmentFile : public ::testing::Test {
 protected:
  /// Loads the environment of a scene that names `file`.
  EnvironmentMesh load(const std::string& file) const {
    Scene scene;
    scene.file = folder_ / "scene.yaml";
    scene.environment = {folder_ / file, {.line = 4, .column = 14, .key_path = "environment"}};
    return loadEnvironmentMesh(scene);
  }
  EnvironmentMesh load(const TestGlb& glb) const {
    write("set.glb", glb.bytes());
    return load("set.glb");
  }
  void write(const std::string& name, const std::vector<std::byte>& bytes) const {
    std::ofstream stream(folder_ / name, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  testing::TemporaryFolder folder_;
};

TEST_F(EnvironmentFile, StandsWhereItsNodesPutIt) {
  TestGlb glb = triangleGlb();
  glb.json["nodes"][0]["translation"] = {10, 0, 0};
  glb.json["nodes"][0]["scale"] = {2, 2, 2};
  const float half = 0.70710678f;  // A quarter turn about Y: +X to -Z.
  glb.add("nodes", {{"rotation", {0, half, 0, half}}, {"translation", {0, 1, 0}}, {"children", {0, 2}}});
  glb.add("nodes", {{"mesh", 0}, {"scale", {-1, 1, 1}}});
  glb.add("nodes", {{"mesh", 0}});  // in no scene
  glb.json["scenes"][0]["nodes"] = {1};
  const EnvironmentMesh mesh = load(glb);
  ASSERT_EQ(mesh.pieces.size(), 1u);
  const auto faces = facesOf(mesh.pieces[0]);
  ASSERT_EQ(faces.size(), 2u);
  std::vector<Vec3> corners;
  for (const auto& face : faces) corners.insert(corners.end(), face.begin(), face.end());
  const auto has = [&](Vec3 wanted) {
    return std::count_if(corners.begin(), corners.end(),
                         [&](Vec3 corner) { return glm::distance(corner, wanted) < 1e-5f; });
  };
  EXPECT_EQ(has({0, 1, -10}), 1);
  EXPECT_EQ(has({0, 1, -12}), 1);
  EXPECT_EQ(has({0, 5, -10}), 1);
  EXPECT_EQ(has({0, 1, 0}), 1);
  EXPECT_EQ(has({0, 1, 1}), 1);  // mirrored,
  EXPECT_EQ(has({0, 3, 0}), 1);
  for (const auto& face : faces) {  // and its winding turned back: both look along +X.
    EXPECT_GT(glm::cross(face[1] - face[0], face[2] - face[0]).x, 0.0f);
  }
  EXPECT_LT(glm::distance(mesh.bounds.low, Vec3(0, 1, -12)), 1e-5f);
  EXPECT_LT(glm::distance(mesh.bounds.high, Vec3(0, 5, 1)), 1e-5f);
  EXPECT_THAT(mesh.dropped, ElementsAre("node 'node 3', which is not in the default scene"));
}

TEST_F(EnvironmentFile, TellsWhatItDoesNotUse) {
  TestGlb glb = skinnedGlb();
  addTurn(glb, 1);
  glb.add("materials", {{"name", "glass"}, {"alphaMode", "BLEND"}, {"normalTexture", {{"index", 0}}}});
  glb.json["meshes"][0]["primitives"][0]["material"] = 0;
  const EnvironmentMesh mesh = load(glb);
  EXPECT_THAT(mesh.dropped, ElementsAre("normal maps", "skins", "animations"));
  EXPECT_THAT(mesh.warnings, ElementsAre("material 'glass': BLEND is treated as MASK"));
  EXPECT_EQ(mesh.materials[0].alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(faceCount(mesh), 1u) << "a skinned mesh stands as it is bound";
  EXPECT_EQ(mesh.bounds.high, Vec3(1, 2, 0));
}

TEST_F(EnvironmentFile, IsRefusedAtItsPlaceInTheScene) {
  const std::string place = path("scene.yaml") + ": 4:14: the environment ";
  write("empty.glb", {});
  write("text.glb", std::vector<std::byte>(12, std::byte{'x'}));
  TestGlb points = triangleGlb();
  points.json["meshes"][0]["primitives"][0]["mode"] = 0;
  write("points.glb", points.bytes());
  EXPECT_INPUT_ERROR(load("none.glb"), place + path("none.glb") + ": no such file; check the path");
  EXPECT_INPUT_ERROR(load("."), place + path(".") + ": is not a regular file; give a file");
  EXPECT_INPUT_ERROR(load("empty.glb"),
                     place + path("empty.glb") + ": the file is empty; export the file again");
  EXPECT_INPUT_ERROR(load("text.glb"),
                     place + path("text.glb") + ": this is neither a GLB nor a .gltf; export as glTF 2.0");
  EXPECT_INPUT_ERROR(load("points.glb"),
                     place + path("points.glb") +
                         ": the environment has no triangles; export its meshes in the default scene");
}

TEST_F(EnvironmentFile, WhatIsWrongInsideIsToldAtItsPlaceThere) {
  TestGlb glb = triangleGlb();
  glb.json["meshes"][0]["primitives"][0]["material"] = 3;
  EXPECT_INPUT_ERROR(load(glb), path("set.glb") +
                                    ": /meshes/0/primitives/0/material: there is no 'materials' "
                                    "number 3; export the file again");
  glb = triangleGlb();
  glb.json["nodes"][0]["translation"] = {0, -1.1e6, 0};
  EXPECT_INPUT_ERROR(load(glb), path("set.glb") +
                                    ": /nodes/0: a vertex of the node is more than 1000000 metres from the "
                                    "origin; scale the set to metres and export it again");
}

// Over 65,536 vertices of one material: every face is there once, every piece is small and compact.
TEST(EnvironmentMesh, LargeSetsAreCutByPlace) {
  constexpr int kSide = 200;
  RawPrimitive grid;
  for (int z = 0; z <= kSide; ++z) {
    for (int x = 0; x <= kSide; ++x) {
      grid.vertices.push_back({.position = Vec3(x, 0, z), .normal = Vec3(0, 1, 0), .uv = {}, .skin = {}});
    }
  }
  for (std::uint32_t z = 0; z < kSide; ++z) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const std::uint32_t a = z * (kSide + 1) + x, b = a + 1, c = a + kSide + 1, d = c + 1;
      grid.faces.push_back({a, c, b});
      grid.faces.push_back({b, c, d});
    }
  }
  RawPrimitive second = grid;
  for (RawVertex& vertex : second.vertices) vertex.position.x += kSide;  // They share an edge.
  const EnvironmentMesh mesh = buildEnvironmentMesh(setOf({grid, second}), "set.glb");
  EXPECT_EQ(faceCount(mesh), 2u * 2 * kSide * kSide);
  EXPECT_EQ(mesh.pieces.size(), (4u * kSide * kSide + 8191) / 8192);
  std::map<std::array<int, 2>, int> seen;  // By the middle of a face, times 3.
  std::size_t vertices = 0;
  float area = 0.0f;
  for (const EnvironmentPiece& piece : mesh.pieces) {
    EXPECT_LE(piece.indices.size(), 3u * 8192);
    vertices += piece.vertices.size();
    for (const auto& face : facesOf(piece)) {
      const Vec3 sum = face[0] + face[1] + face[2];
      ++seen[{static_cast<int>(sum.x), static_cast<int>(sum.z)}];
      EXPECT_GT(glm::cross(face[1] - face[0], face[2] - face[0]).y, 0.0f);
    }
    area += piece.bounds.extent().x * piece.bounds.extent().z;
  }
  EXPECT_EQ(seen.size(), 4u * kSide * kSide) << "each face once";
  EXPECT_LT(vertices, 1.05 * (2 * kSide + 1) * (kSide + 1)) << "equal vertices are one, but at cuts";
  EXPECT_LT(area, 3.0f * (2 * kSide * kSide)) << "20 pieces without order would cover it 20 times";
  const EnvironmentMesh again = buildEnvironmentMesh(setOf({grid, second}), "set.glb");
  ASSERT_EQ(again.pieces.size(), mesh.pieces.size());
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    EXPECT_EQ(again.pieces[i].vertices, mesh.pieces[i].vertices);
    EXPECT_EQ(again.pieces[i].indices, mesh.pieces[i].indices);
  }
}

TEST(EnvironmentMesh, FacesGoByMaterial) {
  RawAsset asset = setOf({floorAt(0, 1), quad(1, Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)), floorAt(2, 1)});
  asset.materials.push_back(testing::setMaterial("wood", Vec3(0.2f)));
  const EnvironmentMesh mesh = buildEnvironmentMesh(std::move(asset), "set.glb");
  ASSERT_EQ(mesh.pieces.size(), 2u);
  EXPECT_EQ(mesh.pieces[0].material, 0u);
  EXPECT_EQ(mesh.pieces[0].indices.size(), 12u);
  EXPECT_EQ(mesh.pieces[0].vertices.size(), 8u);
  EXPECT_EQ(mesh.pieces[0].bounds.low, Vec3(-1, 0, -1));
  EXPECT_EQ(mesh.pieces[0].bounds.high, Vec3(1, 2, 1));
  EXPECT_EQ(mesh.pieces[1].material, 1u);
  EXPECT_EQ(mesh.pieces[1].indices.size(), 6u);
}

}  // namespace
}  // namespace ensemble
