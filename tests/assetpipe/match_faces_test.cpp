#include "assetpipe/match_faces.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "assetpipe/segment.h"
#include "tests/support/small_people.h"

namespace ensemble {
namespace {

TemplateBody tubeBody() {
  std::vector<std::string> warnings;
  return segmentTemplate(testing::tubeTemplate(), {}, "tube.glb", warnings);
}

std::vector<EmbeddedFace> embeddedFaces(const TemplateBody& body) {
  std::vector<EmbeddedFace> faces;
  for (const BodyPart& part : body.parts) {
    for (std::uint32_t f = part.first_face; f < part.first_face + part.face_count; ++f) {
      EmbeddedFace& face = faces.emplace_back();
      face.material = part.material;
      for (std::size_t k = 0; k < 3; ++k) {
        face.corners[k] = body.vertices[VertexId(body.faces[FaceId(f)][k])].position;
      }
    }
  }
  return faces;
}

TEST(MatchFaces, FindsEveryFaceWhateverTheOrderAndFirstCorner) {
  const TemplateBody body = tubeBody();
  const std::vector<EmbeddedFace> in_order = embeddedFaces(body);
  std::vector<EmbeddedFace> shuffled;
  std::vector<std::uint32_t> source;
  for (std::uint32_t i = 0; i < in_order.size(); ++i) {
    source.push_back(static_cast<std::uint32_t>((i * 77u + 5u) % in_order.size()));  // 77 and 192 are coprime
    shuffled.push_back(in_order[source.back()]);
    std::rotate(shuffled.back().corners.begin(), shuffled.back().corners.begin() + i % 3,
                shuffled.back().corners.end());
  }
  const FaceMatches matches = matchFaces(body, shuffled, 0.0002f);
  EXPECT_EQ(matches.unmatched, 0u);
  EXPECT_EQ(matches.max_distance, 0.0f);
  for (std::size_t i = 0; i < shuffled.size(); ++i) EXPECT_EQ(matches.template_face[i], FaceId(source[i]));
}

TEST(MatchFaces, KeepsToToleranceMaterialAndWinding) {
  const TemplateBody body = tubeBody();
  const std::vector<EmbeddedFace> faces = embeddedFaces(body);
  EmbeddedFace near = faces[3], far = faces[3], other_material = faces[3], turned = faces[3], any = faces[3];
  near.corners[0].x += 0.00019f;
  far.corners[0].x += 0.00021f;
  other_material.material = 1;
  std::swap(turned.corners[0], turned.corners[1]);
  any.material = EmbeddedFace::kAnyMaterial;
  for (const auto& [face, expected] :
       {std::pair{near, true}, {far, false}, {other_material, false}, {turned, false}, {any, true}}) {
    const FaceMatches matches = matchFaces(body, std::span(&face, 1), 0.0002f);
    EXPECT_EQ(matches.template_face[0].valid(), expected);
    EXPECT_EQ(matches.unmatched, expected ? 0u : 1u);
  }
}

TEST(MatchFaces, MeasuresHowFarAnotherBodyIs) {
  const TemplateBody body = tubeBody();
  std::vector<EmbeddedFace> faces = embeddedFaces(body);
  for (EmbeddedFace& face : faces) {
    for (Vec3& corner : face.corners) corner.y += 0.005f;
  }
  const FaceMatches matches = matchFaces(body, faces, 0.0002f);
  EXPECT_EQ(matches.unmatched, faces.size());
  EXPECT_NEAR(matches.median_distance, 0.005f, 1e-6f);
  EXPECT_NEAR(matches.max_distance, 0.005f, 1e-6f);
}

/// Faces so small that each is within tolerance of many: all must still find a partner.
TEST(MatchFaces, PairsFacesSmallerThanTheTolerance) {
  RawAsset asset = testing::tubeTemplate();
  for (RawPrimitive& primitive : asset.meshes[0].primitives) {
    for (RawVertex& vertex : primitive.vertices) vertex.position *= 0.0003f;  // the tube is 0.5 mm high
  }
  std::vector<std::string> warnings;
  const TemplateBody body = segmentTemplate(asset, {}, "tiny.glb", warnings);
  std::vector<EmbeddedFace> faces = embeddedFaces(body);
  std::reverse(faces.begin(), faces.end());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      faces[i].corners[k].x += 0.00003f * static_cast<float>((i * 7 + k * 3) % 5) - 0.00006f;
    }
  }
  const FaceMatches matches = matchFaces(body, faces, 0.0002f);
  EXPECT_EQ(matches.unmatched, 0u);
  std::vector<FaceId> taken = matches.template_face;
  std::sort(taken.begin(), taken.end());
  EXPECT_EQ(std::unique(taken.begin(), taken.end()), taken.end()) << "two faces share a partner";
}

TEST(MatchFaces, CountsEqualFacesEachOnce) {
  RawAsset asset = testing::tubeTemplate();
  RawPrimitive& legs = asset.meshes[0].primitives[0];
  legs.faces.push_back(legs.faces[0]);
  std::vector<std::string> warnings;
  const TemplateBody body = segmentTemplate(asset, {}, "double.glb", warnings);
  const EmbeddedFace face = embeddedFaces(body)[0];
  const std::vector<EmbeddedFace> three(3, face);
  EXPECT_EQ(matchFaces(body, std::span(three).first(2), 0.0002f).unmatched, 0u);
  EXPECT_EQ(matchFaces(body, three, 0.0002f).unmatched, 1u);
}

TEST(MatchFaces, OfNothingIsNothing) {
  const FaceMatches matches = matchFaces(tubeBody(), {}, 0.0002f);
  EXPECT_TRUE(matches.template_face.empty());
  EXPECT_EQ(matches.median_distance, 0.0f);
}

}  // namespace
}  // namespace ensemble
