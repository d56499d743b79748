#include "renderer/picture_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <fstream>
#include <limits>

#include "core/atomic_file.h"
#include "core/check.h"
#include "core/image_file.h"
#include "core/random.h"
#include "renderer/finished_picture.h"
#include "tests/renderer/read_exr.h"

namespace ensemble {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;
using testing_support::ExrPicture;
using testing_support::readExr;

/// A folder of its own, gone at the end.
class PictureWriterTest : public testing::Test {
 protected:
  PictureWriterTest()
      : folder_(std::filesystem::path(testing::TempDir()) /
                ("ensemble_pictures_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~PictureWriterTest() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST(EncodeExr, KeepsEveryBit) {
  const std::uint32_t width = 37, height = 19;  // no multiple of a ZIP block's 16 lines
  const RandomStream random(1, 0);
  std::vector<std::uint32_t> ids(width * height);
  std::vector<float> floats(width * height);
  for (std::uint32_t i = 0; i < ids.size(); ++i) {
    ids[i] = random.bits32(i);
    floats[i] = static_cast<float>(random.uniform(i) * 1e6 - 5e5);
  }
  ids[0] = 0;
  ids[1] = UINT32_MAX;
  floats[0] = std::numeric_limits<float>::infinity();
  const ExrChannel channels[] = {{"id", ids}, {"Z", floats}};
  const std::vector<std::byte> bytes = encodeExr(width, height, channels);
  const ExrPicture picture = readExr(bytes);
  EXPECT_EQ(picture.width, width);
  EXPECT_EQ(picture.height, height);
  EXPECT_TRUE(picture.is_zip);
  EXPECT_THAT(picture.uint_channels, SizeIs(1));
  EXPECT_EQ(picture.uint_channels.at("id"), ids);
  EXPECT_EQ(picture.float_channels.at("Z"), floats);
  EXPECT_EQ(encodeExr(width, height, channels), bytes);
}

TEST(EncodeExr, ChecksItsCaller) {
  const std::vector<std::uint32_t> ids(5);
  const ExrChannel few[] = {{"id", ids}};
  EXPECT_THROW(encodeExr(3, 2, few), CheckError);
  EXPECT_THROW(encodeExr(0, 2, few), CheckError);
  EXPECT_THROW(encodeExr(1, 16385, few), CheckError);
  const ExrChannel twice[] = {{"id", ids}, {"id", ids}};
  EXPECT_THROW(encodeExr(2, 2, twice), CheckError);
  EXPECT_THROW(encodeExr(2, 2, {}), CheckError);
}

TEST_F(PictureWriterTest, WritesAovsWithTheirChannels) {
  const std::vector<std::uint32_t> ids{0, 1, 2, 3, 4, 70'000};
  writeFileAtomically(folder_ / "a.face.exr", encodeIdAov(Aov::kFace, 3, 2, ids));
  EXPECT_EQ(readExr(folder_ / "a.face.exr").uint_channels.at("id"), ids);

  const std::vector<float> depth{0.5f, 1, 2, 3, 4, 5};
  writeFileAtomically(folder_ / "a.depth.exr", encodeFloatAov(Aov::kDepth, 3, 2, depth));
  EXPECT_EQ(readExr(folder_ / "a.depth.exr").float_channels.at("Z"), depth);

  const std::vector<float> normals{1, 0, 0, 0, 1, 0, 0, 0, -1, 0.6f, 0.8f, 0, 0, 0, 0, 0, -1, 0};
  writeFileAtomically(folder_ / "a.normal.exr", encodeFloatAov(Aov::kNormal, 3, 2, normals));
  const ExrPicture picture = readExr(folder_ / "a.normal.exr");
  EXPECT_THAT(picture.float_channels, SizeIs(3));
  EXPECT_THAT(picture.float_channels.at("N.X"), ElementsAre(1, 0, 0, 0.6f, 0, 0));
  EXPECT_THAT(picture.float_channels.at("N.Y"), ElementsAre(0, 1, 0, 0.8f, 0, -1));
  EXPECT_THAT(picture.float_channels.at("N.Z"), ElementsAre(0, 0, -1, 0, 0, 0));

  EXPECT_THROW(encodeIdAov(Aov::kDepth, 3, 2, ids), CheckError);
  EXPECT_THROW(encodeFloatAov(Aov::kFace, 3, 2, depth), CheckError);
  EXPECT_THROW(encodeFloatAov(Aov::kNormal, 3, 2, depth), CheckError);
}

TEST_F(PictureWriterTest, WritesPngThatReadsBack) {
  Image8 image{3, 2, {}};
  for (int i = 0; i < 3 * 2 * 4; ++i) image.rgba.push_back(static_cast<std::uint8_t>(i * 10));
  writeFileAtomically(folder_ / "a.png", encodePng(image));
  RawImage raw;
  raw.bytes = readFile(folder_ / "a.png");
  readImageHeader(raw.bytes, "a.png", "", raw);
  const Image8 back = decodeImage(raw, "a.png");
  EXPECT_EQ(back.width, 3u);
  EXPECT_EQ(back.height, 2u);
  EXPECT_EQ(back.rgba, image.rgba);
}

TEST_F(PictureWriterTest, WritesLinearLightBitForBit) {
  const std::uint32_t width = 5, height = 4;
  std::vector<std::uint16_t> rgba(4 * width * height);
  for (std::uint16_t i = 0; i < rgba.size(); ++i) rgba[i] = static_cast<std::uint16_t>(0x2c00 + 37 * i);
  writeFileAtomically(folder_ / "a.exr", encodeLinearPicture(width, height, rgba));
  const ExrPicture picture = readExr(folder_ / "a.exr");
  EXPECT_TRUE(picture.says_rec709);
  EXPECT_THAT(picture.half_channels, SizeIs(4));
  const char* const names[] = {"R", "G", "B", "A"};
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    EXPECT_EQ(picture.half_channels.at(names[i % 4])[i / 4], rgba[i]) << i;
  }
  const std::vector<float> depth(width * height, 1.0f);
  writeFileAtomically(folder_ / "a.depth.exr", encodeFloatAov(Aov::kDepth, width, height, depth));
  EXPECT_FALSE(readExr(folder_ / "a.depth.exr").says_rec709) << "metres have no primaries";
}

TEST_F(PictureWriterTest, TellsFinishedFilesFromOthers) {
  const std::uint32_t width = 40, height = 37;  // three blocks of lines
  Image8 image{width, height, std::vector<std::uint8_t>(4 * width * height)};
  std::vector<float> normals(3 * width * height);
  const RandomStream random(3, 0);
  for (std::uint32_t i = 0; i < image.rgba.size(); ++i) {
    image.rgba[i] = static_cast<std::uint8_t>(random.bits32(i));
    if (i < normals.size()) normals[i] = static_cast<float>(random.uniform(i));
  }
  writeFileAtomically(folder_ / "a.png", encodePng(image));
  writeFileAtomically(folder_ / "a.exr", encodeFloatAov(Aov::kNormal, width, height, normals));
  const auto is_png = [&](const char* name) { return isFinishedPng(folder_ / name, width, height); };
  const auto is_exr = [&](const char* name) {
    return isFinishedExr(folder_ / name, width, height, exrChannelsOf(Aov::kNormal));
  };
  EXPECT_TRUE(is_png("a.png"));
  EXPECT_TRUE(is_exr("a.exr"));
  EXPECT_FALSE(is_png("a.exr"));
  EXPECT_FALSE(is_exr("a.png"));
  EXPECT_FALSE(is_png("none.png"));
  EXPECT_FALSE(is_exr("none.exr"));
  EXPECT_FALSE(isFinishedPng(folder_, width, height));
  EXPECT_FALSE(isFinishedExr(folder_, width, height, exrChannelsOf(Aov::kNormal)));
  EXPECT_FALSE(isFinishedPng(folder_ / "a.png", width, height + 1));
  EXPECT_FALSE(isFinishedPng(folder_ / "a.png", width + 1, height));
  EXPECT_FALSE(isFinishedExr(folder_ / "a.exr", width, height + 1, exrChannelsOf(Aov::kNormal)));
  EXPECT_FALSE(isFinishedExr(folder_ / "a.exr", width - 1, height, exrChannelsOf(Aov::kNormal)));
  EXPECT_FALSE(isFinishedExr(folder_ / "a.exr", width, height, exrChannelsOf(Aov::kDepth)));
  EXPECT_FALSE(isFinishedExr(folder_ / "a.exr", width, height, exrChannelsOfLight()));
  // Cut off anywhere, they are not whole.
  for (const char* name : {"a.png", "a.exr"}) {
    const std::vector<std::byte> bytes = readFile(folder_ / name);
    for (std::size_t size = 0; size < bytes.size(); size += size < 400 ? 1 : 97) {
      writeFileAtomically(folder_ / "cut", std::span(bytes).first(size));
      EXPECT_FALSE(is_png("cut")) << size;
      EXPECT_FALSE(is_exr("cut")) << size;
    }
    writeFileAtomically(folder_ / "cut", std::span(bytes).first(bytes.size() - 1));
    EXPECT_FALSE(is_png("cut") || is_exr("cut"));
  }
}

}  // namespace
}  // namespace ensemble
