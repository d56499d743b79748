// Model space: vertices end where a viewer shows them at rest, whatever the skeleton's frames are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "core/clip.h"
#include "core/gltf_file.h"
#include "tests/core/glb_builder.h"

namespace ensemble {
namespace {

using ::testing::ElementsAre;
using testing::skinnedGlb;
using testing::TestGlb;
using testing::translationMatrix;

RawAsset read(const TestGlb& glb) { return readGlb(glb.bytes(), "x.glb"); }

std::vector<float> toFloats(const Mat4& matrix) {
  std::vector<float> numbers;
  for (int i = 0; i < 16; ++i) numbers.push_back(matrix[i / 4][i % 4]);
  return numbers;
}

void setInverseBinds(TestGlb& glb, const std::vector<Mat4>& matrices) {
  std::vector<float> numbers;
  for (const Mat4& matrix : matrices) {
    const auto more = toFloats(matrix);
    numbers.insert(numbers.end(), more.begin(), more.end());
  }
  glb.json["skins"][0]["inverseBindMatrices"] = glb.addAccessor<float>(numbers, "MAT4");
}

// Under the rest pose every vertex stays in model space, which is where a viewer shows it.
void expectRestIsModelSpace(const RawAsset& asset) {
  const std::vector<Mat4> matrices = skinningMatrices(asset.skeleton, restPose(asset.skeleton));
  for (const RawMeshNode& mesh : asset.meshes) {
    for (const RawPrimitive& primitive : mesh.primitives) {
      for (const RawVertex& vertex : primitive.vertices) {
        EXPECT_NEAR(glm::distance(skinPosition(vertex, matrices), vertex.position), 0.0f, 1e-5f);
      }
    }
  }
}

TEST(GltfSkeleton, BoundAtRestIsBitExact) {
  const RawAsset asset = read(skinnedGlb());
  ASSERT_EQ(asset.skeleton.bones.size(), 2u);
  EXPECT_EQ(asset.skeleton.bones[0].name, "hip");
  EXPECT_EQ(asset.skeleton.bones[1].parent, 0);
  EXPECT_EQ(asset.skeleton.joints[1].bone, 1u);
  EXPECT_EQ(asset.skeleton.joints[0].joint_from_model, glm::translate(Mat4(1.0f), Vec3(0, -1, 0)));
  EXPECT_TRUE(asset.meshes[0].skinned);
  EXPECT_EQ(asset.meshes[0].primitives[0].vertices[2].position, Vec3(0, 2, 0));
  expectRestIsModelSpace(asset);
}

TEST(GltfSkeleton, TheNodeOfASkinnedMeshDoesNotMoveIt) {
  TestGlb glb = skinnedGlb();
  glb.json["nodes"][0]["translation"] = {5, 5, 5};
  EXPECT_EQ(read(glb).meshes[0].primitives[0].vertices[2].position, Vec3(0, 2, 0));
}

TEST(GltfSkeleton, ArmatureInCentimetresLyingOnItsBack) {
  // As exported from FBX: vertices in centimetres with Z up, an armature that scales and turns.
  TestGlb glb = skinnedGlb();
  const int armature = glb.add("nodes", {{"name", "Armature"},
                                         {"scale", {0.01, 0.01, 0.01}},
                                         {"rotation", {-0.70710678, 0, 0, 0.70710678}},
                                         {"children", {1}}});
  glb.json["scenes"][0]["nodes"] = {0, armature};
  auto& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["POSITION"] = glb.addAccessor<float>({0, 0, 0, 100, 0, 0, 0, 0, 200}, "VEC3");
  attributes["NORMAL"] = glb.addAccessor<float>({0, -1, 0, 0, -1, 0, 0, -1, 0}, "VEC3");
  glb.json["nodes"][1]["translation"] = {0, 0, 100};
  glb.json["nodes"][2]["translation"] = {0, 0, -100};
  setInverseBinds(glb, {glm::translate(Mat4(1.0f), Vec3(0, 0, -100)), Mat4(1.0f)});
  const RawAsset asset = read(glb);
  const auto& vertices = asset.meshes[0].primitives[0].vertices;
  EXPECT_NEAR(glm::distance(vertices[1].position, Vec3(1, 0, 0)), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::distance(vertices[2].position, Vec3(0, 2, 0)), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::distance(vertices[0].normal, Vec3(0, 0, 1)), 0.0f, 1e-6f);
  ASSERT_EQ(asset.skeleton.bones.size(), 3u);  // the armature stands above the joints
  EXPECT_EQ(asset.skeleton.bones[0].name, "Armature");
  expectRestIsModelSpace(asset);
}

TEST(GltfSkeleton, MirroredArmatureTurnsFaces) {
  TestGlb glb = skinnedGlb();
  const int armature = glb.add("nodes", {{"scale", {-1, 1, 1}}, {"children", {1}}});
  glb.json["scenes"][0]["nodes"] = {0, armature};
  const RawAsset asset = read(glb);
  EXPECT_EQ(asset.meshes[0].primitives[0].vertices[1].position, Vec3(-1, 0, 0));
  EXPECT_EQ(asset.meshes[0].primitives[0].faces[0], (Triangle{0, 2, 1}));
  expectRestIsModelSpace(asset);
}

TEST(GltfSkeleton, SavedInAPose) {
  // The knee is bent in the file; the bind pose is where the mesh was modelled, unmoved.
  TestGlb glb = skinnedGlb();
  glb.json["nodes"][2]["rotation"] = {0, 0, 0.70710678, 0.70710678};
  RawAsset asset = read(glb);
  EXPECT_EQ(asset.meshes[0].primitives[0].vertices[1].position, Vec3(1, 0, 0));
  EXPECT_EQ(asset.skeleton.joints[1].joint_from_model, Mat4(1.0f));
  // At rest the skeleton shows the pose: the vertex follows the knee.
  const auto matrices = skinningMatrices(asset.skeleton, restPose(asset.skeleton));
  EXPECT_NEAR(glm::distance(skinPosition(asset.meshes[0].primitives[0].vertices[1], matrices), Vec3(0, 1, 0)),
              0.0f, 1e-6f);
}

TEST(GltfSkeleton, SavedInAPoseUnderAnArmature) {
  TestGlb glb = skinnedGlb();
  const int armature = glb.add("nodes", {{"scale", {0.01, 0.01, 0.01}}, {"children", {1}}});
  glb.json["scenes"][0]["nodes"] = {0, armature};
  glb.json["nodes"][2]["rotation"] = {0, 0, 0.70710678, 0.70710678};
  // The root joint agrees with the armature, not with the identity.
  EXPECT_NEAR(read(glb).meshes[0].primitives[0].vertices[2].position.y, 0.02f, 1e-6f);
}

TEST(GltfSkeleton, WithoutInverseBindsVerticesAreInTheJointsFrame) {
  TestGlb glb = skinnedGlb();
  glb.json["skins"][0].erase("inverseBindMatrices");
  glb.json["nodes"][2].erase("translation");  // both joints at (0, 1, 0)
  const RawAsset asset = read(glb);
  EXPECT_EQ(asset.meshes[0].primitives[0].vertices[0].position, Vec3(0, 1, 0));
  expectRestIsModelSpace(asset);
}

TEST(GltfSkeleton, JointsInReverseOrder) {
  TestGlb glb = skinnedGlb();
  glb.json["skins"][0]["joints"] = {2, 1};
  setInverseBinds(glb, {Mat4(1.0f), glm::translate(Mat4(1.0f), Vec3(0, -1, 0))});
  const RawAsset asset = read(glb);
  EXPECT_EQ(asset.skeleton.bones[0].name, "hip");  // parents first
  EXPECT_EQ(asset.skeleton.joints[0].bone, 1u);    // the skin's own order
  expectRestIsModelSpace(asset);
}

TEST(GltfSkeleton, SkinsAreJoined) {
  TestGlb glb = skinnedGlb();
  // A second mesh, bound to the knee alone by a skin of its own, in millimetres.
  const std::vector<float> matrix = toFloats(glm::scale(Mat4(1.0f), Vec3(0.001f)));
  glb.add("skins", {{"joints", {2}}, {"inverseBindMatrices", glb.addAccessor<float>(matrix, "MAT4")}});
  auto mesh = glb.json["meshes"][0];
  auto& attributes = mesh["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = glb.addAccessor<std::uint8_t>(std::vector<std::uint8_t>(12, 0), "VEC4");
  attributes["WEIGHTS_0"] = glb.addAccessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  const int shoe = glb.add("nodes", {{"name", "Shoe"}, {"mesh", glb.add("meshes", mesh)}, {"skin", 1}});
  glb.json["scenes"][0]["nodes"].push_back(shoe);
  const RawAsset asset = read(glb);
  EXPECT_EQ(asset.skeleton.joints.size(), 2u);
  const auto& vertices = asset.meshes.at(1).primitives[0].vertices;
  EXPECT_NEAR(vertices[2].position.y, 0.002f, 1e-7f);
  EXPECT_THAT(vertices[2].skin.joints, ElementsAre(1, 0, 0, 0));
  EXPECT_TRUE(asset.warnings.empty());
  expectRestIsModelSpace(asset);
}

TEST(GltfSkeleton, SkinsBoundInDifferentPosesAreBoundAtRest) {
  TestGlb glb = skinnedGlb();
  const Mat4 bent = glm::translate(Mat4(1.0f), Vec3(0, 0, 1)) * glm::rotate(Mat4(1.0f), 1.0f, Vec3(1, 0, 0));
  std::vector<float> matrices = toFloats(glm::translate(Mat4(1.0f), Vec3(0, -1, 0)));
  const auto second = toFloats(bent);
  matrices.insert(matrices.end(), second.begin(), second.end());
  glb.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", glb.addAccessor<float>(matrices, "MAT4")}});
  const int twin = glb.add("nodes", {{"mesh", 0}, {"skin", 1}});
  glb.json["scenes"][0]["nodes"].push_back(twin);
  const RawAsset asset = read(glb);
  EXPECT_THAT(asset.warnings,
              ElementsAre("the file's skins were bound in different poses; all are bound anew at rest"));
  expectRestIsModelSpace(asset);
  EXPECT_NEAR(
      glm::distance(asset.meshes[1].primitives[0].vertices[1].position, Vec3(bent * Vec4(1, 0, 0, 1))), 0.0f,
      1e-6f);
}

TEST(GltfSkeleton, RigidMeshBelowAJoint) {
  TestGlb glb = skinnedGlb();
  auto mesh = testing::triangleGlb().json["meshes"][0];  // the same accessors, no skin
  const int hat =
      glb.add("nodes", {{"name", "Hat"}, {"mesh", glb.add("meshes", mesh)}, {"translation", {0, 0, 3}}});
  const int socket = glb.add("nodes", {{"name", "Socket"}, {"children", {hat}}});
  glb.json["nodes"][1]["children"].push_back(socket);
  const RawAsset asset = read(glb);
  ASSERT_EQ(asset.meshes.size(), 2u);
  EXPECT_TRUE(asset.meshes[1].skinned);
  const RawVertex& vertex = asset.meshes[1].primitives[0].vertices[0];
  EXPECT_EQ(vertex.position, Vec3(0, 1, 3));
  EXPECT_THAT(vertex.skin.joints, ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(vertex.skin.weights, ElementsAre(1.0f, 0.0f, 0.0f, 0.0f));
  expectRestIsModelSpace(asset);
}

TEST(GltfSkeleton, RigidMeshInAPosedFile) {
  TestGlb glb = skinnedGlb();
  glb.json["nodes"][2]["rotation"] = {0, 0, 0.70710678, 0.70710678};
  auto mesh = testing::triangleGlb().json["meshes"][0];
  const int shoe = glb.add("nodes", {{"mesh", glb.add("meshes", mesh)}});
  glb.json["nodes"][2]["children"] = {shoe};
  const RawAsset asset = read(glb);
  // Shown bent with the knee, bound straight.
  const RawVertex& vertex = asset.meshes.at(1).primitives[0].vertices[1];
  EXPECT_NEAR(glm::distance(vertex.position, Vec3(1, 0, 0)), 0.0f, 1e-6f);
  const auto matrices = skinningMatrices(asset.skeleton, restPose(asset.skeleton));
  EXPECT_NEAR(glm::distance(skinPosition(vertex, matrices), Vec3(0, 1, 0)), 0.0f, 1e-6f);
}

TEST(GltfSkeleton, MeshOutsideTheSkeletonIsFlagged) {
  TestGlb glb = skinnedGlb();
  auto mesh = testing::triangleGlb().json["meshes"][0];
  glb.json["scenes"][0]["nodes"].push_back(glb.add("nodes", {{"mesh", glb.add("meshes", mesh)}}));
  EXPECT_FALSE(read(glb).meshes.at(1).skinned);
}

TEST(GltfSkeleton, ShearInABoneIsTold) {
  TestGlb glb = skinnedGlb();
  glb.json["nodes"][2].erase("translation");
  glb.json["nodes"][2]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
  EXPECT_THAT(read(glb).warnings, ElementsAre("bone 'knee' has a matrix with shear, which is left out"));
}

}  // namespace
}  // namespace ensemble
