// What `debug` lays over a picture, as colours.
#include "renderer/debug_overlay.h"

#include <gtest/gtest.h>

#include <set>

namespace ensemble {
namespace {

Image8 pictureOf(std::vector<std::array<std::uint8_t, 4>> pixels) {
  Image8 picture;
  picture.width = static_cast<std::uint32_t>(pixels.size());
  picture.height = 1;
  for (const auto& pixel : pixels) picture.rgba.insert(picture.rgba.end(), pixel.begin(), pixel.end());
  return picture;
}

TEST(DebugOverlay, OverdrawGoesByPowersOfTwo) {
  std::set<OverlayColor> colors;
  const std::uint32_t last_of_step[] = {1, 2, 4, 8, 16, 32, 64};
  for (const std::uint32_t count : last_of_step) {
    EXPECT_TRUE(colors.insert(colorOfOverdraw(count)).second) << count;
    EXPECT_NE(colorOfOverdraw(count), colorOfOverdraw(count + 1)) << count;
  }
  EXPECT_EQ(colorOfOverdraw(3), colorOfOverdraw(4));
  EXPECT_EQ(colorOfOverdraw(65), colorOfOverdraw(0xffffffffu));
  EXPECT_EQ(colors.count(colorOfOverdraw(65)), 0u);
}

TEST(DebugOverlay, KeysOfAClipAreToldApart) {
  for (std::uint32_t key = 0; key < 40; ++key) {
    EXPECT_NE(colorOfPose(key), colorOfPose(key + 1));
    EXPECT_NE(colorOfPose(key), colorOfPose(ViewPeople::kExact));
  }
  EXPECT_EQ(colorOfPose(7), colorOfPose(7));
  EXPECT_NE(colorOfRasteriser(false), colorOfRasteriser(true));
}

TEST(DebugOverlay, PeopleAreTintedAndTheRestIsGrey) {
  Image8 picture = pictureOf({{200, 10, 30, 255}, {200, 10, 30, 255}, {200, 10, 30, 128}});
  const std::uint32_t character[] = {0, 1, 2};
  tintPeople(
      character,
      [](std::uint32_t person) {
        return OverlayColor{0, std::uint8_t(person == 1 ? 255 : 0), 90};
      },
      picture);
  const auto grey = static_cast<std::uint8_t>(luma(pictureOf({{200, 10, 30, 255}}).rgba.data()));
  const auto third = static_cast<std::uint8_t>(grey / 3), blue = static_cast<std::uint8_t>((180 + grey) / 3);
  EXPECT_EQ(picture.rgba, pictureOf({{grey, grey, grey, 255},
                                     {third, third, blue, 255},
                                     {third, static_cast<std::uint8_t>((510 + grey) / 3), blue, 128}})
                              .rgba);
}

TEST(DebugOverlay, OverdrawDarkensWhereNobodyIs) {
  Image8 picture = pictureOf({{100, 100, 100, 255}, {100, 100, 100, 255}});
  const std::uint32_t counts[] = {0, 5};
  showOverdraw(counts, picture);
  const OverlayColor color = colorOfOverdraw(5);
  EXPECT_EQ(picture.rgba, pictureOf({{50, 50, 50, 255}, {color[0], color[1], color[2], 255}}).rgba);
}

}  // namespace
}  // namespace ensemble
