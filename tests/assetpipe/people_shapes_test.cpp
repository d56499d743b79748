// What sex, height, build, girth and age do to a body, and that it stays a sound solid.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <set>
#include <string>

#include "assetpipe/people_body.h"
#include "assetpipe/people_skin.h"
#include "assetpipe/surface_check.h"
#include "core/image_file.h"

namespace ensemble {
namespace {

struct Shape {
  const char* name;
  FigureOptions options;
  std::size_t faces = 3400;
};

void PrintTo(const Shape& shape, std::ostream* stream) { *stream << shape.name; }

class EveryShape : public ::testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(
    People, EveryShape,
    ::testing::Values(Shape{"ShortSlightThinOldWoman", {Sex::kFemale, 1.40f, -1.0f, -1.0f, AgeGroup::kOld}},
                      Shape{"ShortBroadThinOldWoman", {Sex::kFemale, 1.40f, 1.0f, -1.0f, AgeGroup::kOld}},
                      Shape{"TallBroadHeavyWoman", {Sex::kFemale, 2.10f, 1.0f, 1.0f, AgeGroup::kAdult}},
                      Shape{"SlightHeavyYoungWoman", {Sex::kFemale, 1.55f, -1.0f, 1.0f, AgeGroup::kYoung}},
                      Shape{"ShortBroadHeavyOldMan", {Sex::kMale, 1.40f, 1.0f, 1.0f, AgeGroup::kOld}},
                      Shape{"TallSlightThinYoungMan", {Sex::kMale, 2.10f, -1.0f, -1.0f, AgeGroup::kYoung}},
                      Shape{"PlainWoman", {Sex::kFemale, 1.66f, 0.0f, 0.0f, AgeGroup::kAdult}},
                      Shape{"WomanOfFewFaces", {Sex::kFemale, 1.66f, 0.0f, 0.0f, AgeGroup::kAdult}, 1500},
                      Shape{"ManOfFewFaces", {Sex::kMale, 1.78f, 0.0f, 0.0f, AgeGroup::kAdult}, 1500}),
    [](const auto& shape) { return std::string(shape.param.name); });

TEST_P(EveryShape, IsClosedAndDoesNotCutItself) {
  const Figure figure = makeFigure(GetParam().options);
  const FieldMesh mesh = makeBodyMesh(figure, GetParam().faces);
  const SurfaceCheck check = checkSurface(mesh.positions, mesh.faces);
  EXPECT_TRUE(check.is_manifold);
  EXPECT_TRUE(check.is_closed);
  EXPECT_TRUE(check.faces_outwards);
  for (const Vec3& at : check.crossings)
    ADD_FAILURE() << "cuts itself at " << at.x << " " << at.y << " " << at.z;
  // A sphere's topology: no handles, as fingers grown together would make.
  EXPECT_EQ(static_cast<int>(mesh.positions.size()) - static_cast<int>(mesh.faces.size()) / 2, 2);
  EXPECT_NEAR(static_cast<double>(mesh.faces.size()), static_cast<double>(GetParam().faces), 10.0);
  EXPECT_EQ(std::set<std::uint8_t>(mesh.labels.begin(), mesh.labels.end()).size(), kBodyRegionCount);
  float highest = 0.0f;
  for (const Vec3& p : mesh.positions) highest = std::max(highest, p.y);
  EXPECT_NEAR(highest, GetParam().options.height, 0.015f);
}

/// Half the body's width at a part of its height, left of the middle; arms are farther out.
float halfWidth(const FigureOptions& options, float part) {
  const Figure figure = makeFigure(options);
  float x = 0.0f;
  while (figure.torso(Vec3(x, part * options.height, 0.0f)) < 0.0f) x += 0.0005f;
  return x / options.height;
}

/// How far the belly stands out in front at a part of the height.
float bellyDepth(const FigureOptions& options, float part) {
  const Figure figure = makeFigure(options);
  float z = 0.0f;
  while (figure.torso(Vec3(0.0f, part * options.height, z)) < 0.0f) z += 0.0005f;
  return z / options.height;
}

class EachParameter : public ::testing::TestWithParam<Sex> {};
INSTANTIATE_TEST_SUITE_P(People, EachParameter, ::testing::Values(Sex::kFemale, Sex::kMale),
                         [](const auto& sex) { return sex.param == Sex::kFemale ? "Woman" : "Man"; });

TEST_P(EachParameter, ShowsWhereItShould) {
  const FigureOptions plain{GetParam(), 1.70f};
  FigureOptions heavy = plain, thin = plain, broad = plain, old = plain, young = plain;
  heavy.girth = 1.0f;
  thin.girth = -1.0f;
  broad.build = 1.0f;
  old.age = AgeGroup::kOld;
  young.age = AgeGroup::kYoung;
  constexpr float kWaist = 0.63f;
  EXPECT_GT(halfWidth(heavy, kWaist), 1.15f * halfWidth(plain, kWaist));
  EXPECT_LT(halfWidth(thin, kWaist), 0.95f * halfWidth(plain, kWaist));
  EXPECT_GT(bellyDepth(heavy, kWaist), 1.25f * bellyDepth(plain, kWaist));
  const auto shoulder = [](const FigureOptions& options) { return makeFigure(options).joints[kUpperArm].x; };
  EXPECT_GT(shoulder(broad), 1.04f * shoulder(plain));
  EXPECT_LT(shoulder(young), 0.97f * shoulder(plain));
  EXPECT_FLOAT_EQ(shoulder(heavy), shoulder(plain)) << "flesh does not move the bones";
  const auto head = [](const FigureOptions& options) { return makeFigure(options).joints[kHead].z; };
  EXPECT_GT(head(old), head(plain) + 0.03f) << "an old back is round";
  EXPECT_GT(bellyDepth(old, kWaist), bellyDepth(plain, kWaist));
  EXPECT_GT(makeFigure(young).head_size, makeFigure(plain).head_size);
}

TEST_P(EachParameter, HeadsDifferLessThanHeights) {
  const Figure small = makeFigure({GetParam(), 1.40f}), tall = makeFigure({GetParam(), 2.10f});
  const float heads = tall.head_size / small.head_size;
  EXPECT_GT(heads, 1.1f);
  EXPECT_LT(heads, 1.35f);  // heights: 1.5
}

Vec3 texelAt(const Image8& image, const Vec2& uv) {
  const auto pixel = [&](float part, std::uint32_t side) {
    return std::min(static_cast<std::uint32_t>(part * static_cast<float>(side)), side - 1);
  };
  const std::size_t at =
      4 * (std::size_t{pixel(uv.y, image.height)} * image.width + pixel(uv.x, image.width));
  return Vec3(image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]);
}

TEST_P(EachParameter, FaceIsPaintedWhereTheFaceIs) {
  const Figure figure = makeFigure({GetParam(), 1.70f});
  PersonColors colors;
  colors.hair = Vec3(0.02f, 0.20f, 0.02f);  // green, to be told from skin
  const Image8 image = decodeImage(paintHead(figure, colors), "head");
  const auto at = [&](float x, float y, float z) {
    return texelAt(image, headUv(figure, figure.head_center + figure.head_size * Vec3(x, y, z), x < 0.0f));
  };
  const Vec3 cheek = at(0.0f, -0.020f, 0.100f);
  EXPECT_GT(cheek.r, cheek.b) << "skin";
  EXPECT_LT(at(0.0322f, -0.0066f, 0.0845f).r, 60.0f) << "the pupil";
  EXPECT_EQ(at(0.0322f, -0.0066f, 0.0845f), at(-0.0322f, -0.0066f, 0.0845f)) << "both eyes";
  const Vec3 lip = at(0.004f, -0.089f, 0.095f);
  EXPECT_LT(lip.g / lip.r, 0.93f * cheek.g / cheek.r) << "lips are redder than skin";
  // The crown and the back of the head have the hair's colour, thinned by the skin below.
  for (const Vec3& hair : {at(0.0f, 0.100f, -0.03f), at(0.001f, -0.02f, -0.11f)}) {
    EXPECT_LT(hair.r, 0.8f * cheek.r);
    EXPECT_GT(hair.g / hair.r, 1.1f * cheek.g / cheek.r);
  }
  const Vec3 nape = at(0.001f, -0.13f, -0.05f);
  EXPECT_NEAR(nape.g / nape.r, cheek.g / cheek.r, 0.03f) << "the neck is skin";
}

TEST(People, HeadsTextureHasItsSeamBehind) {
  const Figure figure = makeFigure({Sex::kFemale, 1.70f});
  const Vec3 behind = figure.head_center - Vec3(0.0f, 0.0f, 0.1f),
             before = figure.head_center + Vec3(0, 0, 0.1f);
  EXPECT_NEAR(headUv(figure, behind, false).x, 1.0f, 1e-5f);
  EXPECT_NEAR(headUv(figure, behind, true).x, 0.0f, 1e-5f);
  EXPECT_FLOAT_EQ(headUv(figure, before, false).x, 0.5f);
  EXPECT_FLOAT_EQ(headUv(figure, before, true).x, 0.5f);
}

}  // namespace
}  // namespace ensemble
