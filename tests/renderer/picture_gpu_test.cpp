// Colours: backgrounds, coverage, textures, cut-outs, light.
#include "tests/renderer/gpu_fixture.h"

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
