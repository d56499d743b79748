#include "renderer/picture_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <fstream>
#include <limits>

#include "core/atomic_file.h"
#include "core/check.h"
#include "core/input_error.h"
#include "core/random.h"
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

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no usage error";
}

std::string nameError(const std::string& output, std::uint32_t frames = 1) {
  return messageOf([&] { FrameNames(output, frames); });
}

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
  writeIdAov(folder_ / "a.face.exr", Aov::kFace, 3, 2, ids);
  EXPECT_EQ(readExr(folder_ / "a.face.exr").uint_channels.at("id"), ids);

  const std::vector<float> depth{0.5f, 1, 2, 3, 4, 5};
  writeFloatAov(folder_ / "a.depth.exr", Aov::kDepth, 3, 2, depth);
  EXPECT_EQ(readExr(folder_ / "a.depth.exr").float_channels.at("Z"), depth);

  const std::vector<float> normals{1, 0, 0, 0, 1, 0, 0, 0, -1, 0.6f, 0.8f, 0, 0, 0, 0, 0, -1, 0};
  writeFloatAov(folder_ / "a.normal.exr", Aov::kNormal, 3, 2, normals);
  const ExrPicture picture = readExr(folder_ / "a.normal.exr");
  EXPECT_THAT(picture.float_channels, SizeIs(3));
  EXPECT_THAT(picture.float_channels.at("N.X"), ElementsAre(1, 0, 0, 0.6f, 0, 0));
  EXPECT_THAT(picture.float_channels.at("N.Y"), ElementsAre(0, 1, 0, 0.8f, 0, -1));
  EXPECT_THAT(picture.float_channels.at("N.Z"), ElementsAre(0, 0, -1, 0, 0, 0));

  EXPECT_THROW(writeIdAov(folder_ / "b.exr", Aov::kDepth, 3, 2, ids), CheckError);
  EXPECT_THROW(writeFloatAov(folder_ / "b.exr", Aov::kFace, 3, 2, depth), CheckError);
  EXPECT_THROW(writeFloatAov(folder_ / "b.exr", Aov::kNormal, 3, 2, depth), CheckError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "b.exr"));
}

TEST_F(PictureWriterTest, WritesPngThatReadsBack) {
  Image8 image{3, 2, {}};
  for (int i = 0; i < 3 * 2 * 4; ++i) image.rgba.push_back(static_cast<std::uint8_t>(i * 10));
  writePicture(folder_ / "a.png", image);
  RawImage raw;
  raw.bytes = readFile(folder_ / "a.png");
  readImageHeader(raw.bytes, "a.png", "", raw);
  const Image8 back = decodeImage(raw, "a.png");
  EXPECT_EQ(back.width, 3u);
  EXPECT_EQ(back.height, 2u);
  EXPECT_EQ(back.rgba, image.rgba);
}

TEST_F(PictureWriterTest, SaysWhenAFileCantBeWritten) {
  const std::vector<std::uint32_t> ids(4);
  EXPECT_THROW(writeIdAov(folder_ / "missing" / "a.exr", Aov::kRegion, 2, 2, ids), SystemError);
}

TEST(FrameNames, InAFolder) {
  const FrameNames names("out/", 3);
  EXPECT_EQ(names.picture(0), "out/frame_0000.png");
  EXPECT_EQ(names.picture(12345), "out/frame_12345.png");
  EXPECT_EQ(names.aov(7, Aov::kCharacter), "out/frame_0007.character.exr");
  EXPECT_EQ(names.ids(7), "out/frame_0007.ids.json");
  EXPECT_EQ(FrameNames(".", 3).picture(1), "./frame_0001.png");
}

TEST_F(PictureWriterTest, NamesFilesInAFolderThatExistsAndMakesOthers) {
  const FrameNames existing(folder_.string(), 2);
  EXPECT_EQ(existing.picture(1), folder_ / "frame_0001.png");
  const FrameNames made((folder_ / "a" / "b" / "").string(), 2);
  made.createFolder();
  EXPECT_TRUE(std::filesystem::is_directory(folder_ / "a" / "b"));
  made.createFolder();
  std::ofstream(folder_ / "file") << "x";
  EXPECT_THROW(FrameNames((folder_ / "file" / "x.png").string(), 1).createFolder(), SystemError);
}

TEST(FrameNames, ByAPattern) {
  EXPECT_EQ(FrameNames("a/name_%04d.png", 9).picture(3), "a/name_0003.png");
  EXPECT_EQ(FrameNames("name%d-x.png", 9).picture(31), "name31-x.png");
  EXPECT_EQ(FrameNames("%09d.PNG", 9).picture(31), "000000031.png");
  EXPECT_EQ(FrameNames("100%%_%02d.png", 9).picture(3), "100%_03.png");
  EXPECT_EQ(FrameNames("a%sb/name_%02d.png", 9).picture(3), "a%sb/name_03.png");
  EXPECT_EQ(FrameNames("name_%04d.png", 9).aov(3, Aov::kNormal), "name_0003.normal.exr");
  EXPECT_EQ(FrameNames("{}_%d.png", 9).picture(3), "{}_3.png");
}

TEST(FrameNames, OfASinglePicture) {
  const FrameNames names("a/b.c.png", 1);
  EXPECT_EQ(names.picture(5), "a/b.c.png");
  EXPECT_EQ(names.aov(5, Aov::kDepth), "a/b.c.depth.exr");
  EXPECT_EQ(names.ids(5), "a/b.c.ids.json");
  EXPECT_EQ(names.folder(), "a");
}

TEST(FrameNames, SayWhatIsWrong) {
  EXPECT_EQ(nameError("a/b.png", 2), "-o a/b.png: 2 frames don't fit one file; write a/b_%04d.png");
  EXPECT_EQ(
      nameError("b.exr"),
      "-o b.exr: colour as .exr is not supported yet; write PNG: name.png, name_%04d.png or a folder dir/");
  EXPECT_EQ(
      nameError("b.MP4"),
      "-o b.MP4: colour as .mp4 is not supported yet; write PNG: name.png, name_%04d.png or a folder dir/");
  EXPECT_EQ(
      nameError("b.jpg"),
      "-o b.jpg: pictures can't be written as '.jpg'; write PNG: name.png, name_%04d.png or a folder dir/");
  EXPECT_EQ(nameError("nowhere"),
            "-o nowhere: the name has no extension; write nowhere/ for a folder, or nowhere.png");
  EXPECT_EQ(nameError(""), "-o : the path is empty; write a folder dir/, name_%04d.png or name.png");
  const std::string mend = "; write %04d for the frame's number, %% for a percent sign";
  for (const char* bad : {"a%.png", "a%s.png", "a%4d.png", "a%00d.png", "a%010d.png", "a%0d.png", "a%n.png",
                          "a%04x.png", "a%-4d.png"}) {
    EXPECT_EQ(nameError(bad), std::string("-o ") + bad +
                                  ": a '%' that is followed by neither d nor 0Nd (N from 1 to 9)" + mend);
  }
  EXPECT_EQ(nameError("%d_%d.png"), "-o %d_%d.png: the frame's number is there twice; write %04d once");
}

TEST(Aovs, AreParsed) {
  EXPECT_THAT(parseAovs(""), IsEmpty());
  EXPECT_THAT(parseAovs("depth,character,depth"), ElementsAre(Aov::kCharacter, Aov::kDepth));
  EXPECT_THAT(parseAovs("character,region,face,depth,normal"), testing::ElementsAreArray(kAllAovs));
  const std::string known = " (known: character, region, face, depth, normal)";
  EXPECT_EQ(messageOf([] { parseAovs("depth,normals"); }),
            "--aov depth,normals: there is no kind 'normals'; write 'normal'" + known);
  EXPECT_EQ(messageOf([] { parseAovs("depth,"); }),
            "--aov depth,: there is no kind ''; write 'face'" + known);
}

}  // namespace
}  // namespace ensemble
