// Colours: backgrounds, coverage, textures, cut-outs, light.
#include "tests/renderer/gpu_fixture.h"

#include <cmath>

namespace ensemble {
namespace {

using testing::GpuTest;

class PictureTest : public GpuTest {
 protected:
  static Scene onePerson(const std::string& outfit) {
    Scene scene = testing::tubeScene(0);
    ScenePerson person;
    person.outfit.value = outfit;
    person.tint = 3u;
    scene.people.push_back(person);
    scene.camera.position = Vec3(0.0f, 1.2f, 3.0f);
    scene.camera.target = Vec3(0.0f, 0.95f, 0.0f);
    return scene;
  }
};

TEST_F(PictureTest, ATransparentBackgroundHasTheCoverageAsAlpha) {
  const Scene scene = onePerson("tunic");
  View view = viewOf(scene);
  view.background = BackgroundKind::kTransparent;
  view.aovs = testing::allAovs();
  const auto renderer = makeRenderer(scene);
  const Picture sharp = draw(*renderer, view);
  for (std::size_t i = 0; i < sharp.character.size(); ++i) {
    ASSERT_EQ(sharp.color.rgba[4 * i + 3], sharp.character[i] != 0 ? 255 : 0) << i;
  }
  view.samples = 4;
  const Picture smooth = draw(*renderer, view);
  std::set<int> alphas;
  for (std::size_t i = 0; i < smooth.character.size(); ++i) alphas.insert(smooth.color.rgba[4 * i + 3]);
  EXPECT_THAT(alphas, ::testing::ElementsAre(0, 64, 128, 191, 255)) << "quarters";
}

TEST_F(PictureTest, APlainBackgroundIsTheColourThatWasAskedFor) {
  const Scene scene = onePerson("tunic");
  View view = viewOf(scene);
  view.background = BackgroundKind::kColor;
  view.background_color = Vec3(0.2f, 0.4f, 0.8f);
  view.ground = false;
  const Picture picture = draw(*makeRenderer(scene), view);
  EXPECT_THAT(std::span(picture.color.rgba).first(4), ::testing::ElementsAre(51, 102, 204, 255));
}

/// The value of half-precision bits (IEEE 754-2008), finite ones.
float floatOf(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
  const float value = exponent == 0 ? std::ldexp(static_cast<float>(mantissa), -24)
                                    : std::ldexp(static_cast<float>(mantissa + 1024), exponent - 25);
  return (bits & 0x8000u) != 0 ? -value : value;
}

/// IEC 61966-2-1, 0 .. 255.
float encodeSrgb(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  return 255.0f * (c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f);
}

// The linear picture, encoded by the standard's formula, is the 8-bit picture within a step.
TEST_F(PictureTest, TheLinearPictureIsThePictureBeforeItsEncoding) {
  Scene scene = onePerson("tunic");
  View view = viewOf(scene);
  view.samples = 4;
  const auto renderer = makeRenderer(scene);
  EXPECT_THAT(draw(*renderer, view).linear, ::testing::IsEmpty()) << "nobody asked";
  for (const BackgroundKind background : {BackgroundKind::kSky, BackgroundKind::kTransparent}) {
    view.background = background;
    view.linear = true;
    const Picture picture = draw(*renderer, view);
    ASSERT_EQ(picture.linear.size(), picture.color.rgba.size());
    std::size_t soft = 0;
    for (std::size_t i = 0; i < picture.linear.size(); i += 4) {
      const float alpha = floatOf(picture.linear[i + 3]);
      ASSERT_NEAR(255.0f * alpha, picture.color.rgba[i + 3], 0.51f) << i;
      soft += alpha > 0.0f && alpha < 1.0f;
      for (std::size_t k = i; k < i + 3; ++k) {
        const float premultiplied = floatOf(picture.linear[k]);
        if (alpha == 0.0f) {
          ASSERT_EQ(premultiplied, 0.0f) << k;
        } else {
          ASSERT_NEAR(encodeSrgb(premultiplied / alpha), picture.color.rgba[k], 1.0f) << k;
        }
      }
    }
    EXPECT_EQ(soft > 50, background == BackgroundKind::kTransparent) << soft;
  }
  view.linear = false;
  EXPECT_THAT(draw(*renderer, view).linear, ::testing::IsEmpty());
}

TEST_F(PictureTest, SamplesSmoothEdgesOnly) {
  const Scene scene = onePerson("patch");
  View view = viewOf(scene);
  const auto renderer = makeRenderer(scene);
  const Picture sharp = draw(*renderer, view);
  view.samples = 4;
  const Picture smooth = draw(*renderer, view);
  const std::size_t differing = testing::differingPixels(sharp.color, smooth.color).size();
  EXPECT_GT(differing, 100u);
  EXPECT_LT(differing, sharp.color.rgba.size() / 4 / 4);
}

TEST_F(PictureTest, ACutOutShowsWhatIsBehindIt) {
  const Scene scene = onePerson("net");
  View view = viewOf(scene);
  view.aovs = testing::allAovs();
  const auto renderer = makeRenderer(scene);
  const Picture picture = draw(*renderer, view);
  // A row across the net: its squares alternate with the body behind them.
  const std::size_t row = std::size_t{view.width} * 60;
  std::size_t changes = 0;
  for (std::size_t x = 1; x < view.width; ++x) {
    const auto is_net = [&](std::size_t i) {
      return picture.region[i] >= renderer->aovNumbers().first_garment;
    };
    if (picture.character[row + x] != 0 && picture.character[row + x - 1] != 0) {
      changes += is_net(row + x) != is_net(row + x - 1);
    }
  }
  EXPECT_GE(changes, 4u);
}

TEST_F(PictureTest, ATextureHasItsColours) {
  const Scene scene = onePerson("patch");
  View view = viewOf(scene);
  view.aovs = testing::allAovs();
  const auto renderer = makeRenderer(scene);
  const Picture picture = draw(*renderer, view);
  std::vector<int> reds;
  for (std::size_t i = 0; i < picture.region.size(); ++i) {
    if (picture.region[i] < renderer->aovNumbers().first_garment) continue;
    const std::string& garment =
        renderer->aovNumbers().garments[picture.region[i] - renderer->aovNumbers().first_garment];
    if (garment == "garment.patch") reds.push_back(picture.color.rgba[4 * i]);
  }
  ASSERT_GT(reds.size(), 200u);
  // The checker's two colours have 230 and 40 of red, and a tint multiplies both.
  const int most = *std::max_element(reds.begin(), reds.end());
  EXPECT_GT(std::count_if(reds.begin(), reds.end(), [&](int red) { return red * 3 > most * 2; }), 40);
  EXPECT_GT(std::count_if(reds.begin(), reds.end(), [&](int red) { return red * 5 < most * 2; }), 40);
}

TEST_F(PictureTest, PeopleCastShadows) {
  Scene scene = onePerson("tunic");
  scene.camera.position = Vec3(0.0f, 5.0f, 5.0f);
  View view = viewOf(scene);
  view.aovs = {Aov::kCharacter};
  const auto renderer = makeRenderer(scene);
  const Picture lit = draw(*renderer, view);
  view.light.shadows = false;
  const Picture unlit = draw(*renderer, view);
  std::size_t darker = 0, brighter = 0;
  for (std::size_t i = 0; i < lit.character.size(); ++i) {
    if (lit.character[i] != 0) continue;
    darker += lit.color.rgba[4 * i] + 20 < unlit.color.rgba[4 * i];
    brighter += lit.color.rgba[4 * i] > unlit.color.rgba[4 * i];
  }
  EXPECT_GT(darker, 60u) << "on the ground";
  EXPECT_EQ(brighter, 0u);
}

TEST_F(PictureTest, TintSeedsDressPeopleDifferently) {
  Scene scene = onePerson("tunic");
  View view = viewOf(scene);
  std::vector<Image8> pictures;
  for (const std::uint32_t seed : {1u, 2u, 3u, 4u}) {
    scene.people[0].tint = seed;
    pictures.push_back(drawScene(scene, view).color);
    for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
      EXPECT_NE(pictures[i].rgba, pictures.back().rgba) << seed;
  }
}

}  // namespace
}  // namespace ensemble
