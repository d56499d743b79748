#include "renderer/frame_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

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

TEST(FrameNames, InAFolder) {
  const FrameNames names("out/", 3);
  EXPECT_EQ(names.picture(0), "out/frame_0000.png");
  EXPECT_EQ(names.picture(12345), "out/frame_12345.png");
  EXPECT_EQ(names.aov(7, Aov::kCharacter), "out/frame_0007.character.exr");
  EXPECT_EQ(names.ids(7), "out/frame_0007.ids.json");
  EXPECT_EQ(FrameNames(".", 3).picture(1), "./frame_0001.png");
}

TEST(FrameNames, InAFolderThatExistsAndInOthers) {
  const testing::TemporaryFolder folder;
  const FrameNames existing(folder.path().string(), 2);
  EXPECT_EQ(existing.picture(1), folder / "frame_0001.png");
  const FrameNames made((folder / "a" / "b" / "").string(), 2);
  made.createFolder();
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a" / "b"));
  made.createFolder();
  std::ofstream(folder / "file") << "x";
  EXPECT_THROW(FrameNames((folder / "file" / "x.png").string(), 1).createFolder(), SystemError);
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

TEST(FrameNames, OfLinearPictures) {
  const FrameNames names("a/b_%03d.EXR", 9);
  EXPECT_EQ(names.format(), PictureFormat::kExr);
  EXPECT_EQ(names.picture(5), "a/b_005.exr");
  EXPECT_EQ(names.aov(5, Aov::kDepth), "a/b_005.depth.exr");
  EXPECT_EQ(FrameNames("a/b.exr", 1).picture(5), "a/b.exr");
  EXPECT_EQ(FrameNames("a/b.png", 1).format(), PictureFormat::kPng);
}

TEST(FrameNames, OfAVideo) {
  const FrameNames names("a/b.c.MP4", 900);
  EXPECT_EQ(names.format(), PictureFormat::kVideo);
  EXPECT_EQ(names.picture(5), "a/b.c.mp4");
  EXPECT_EQ(names.aov(5, Aov::kCharacter), "a/b.c_0005.character.exr");
  EXPECT_EQ(names.ids(12345), "a/b.c_12345.ids.json");
  EXPECT_EQ(FrameNames("100%%.mp4", 2).picture(0), "100%.mp4");
}

TEST(FrameNames, SayWhatIsWrong) {
  EXPECT_EQ(nameError("a/b.png", 2), "-o a/b.png: 2 frames don't fit one file; write a/b_%04d.png");
  EXPECT_EQ(nameError("a/b.EXR", 3), "-o a/b.EXR: 3 frames don't fit one file; write a/b_%04d.exr");
  EXPECT_EQ(nameError("b.jpg"),
            "-o b.jpg: pictures can't be written as '.jpg'; write .png, .exr or .mp4: name.png, "
            "name_%04d.exr, name.mp4, or a folder dir/");
  EXPECT_EQ(nameError("b_%04d.mp4"),
            "-o b_%04d.mp4: a video holds all frames; write name.mp4 without a frame's number");
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
  EXPECT_THAT(parseAovs("character,region,face,depth,normal"), ::testing::ElementsAreArray(kAllAovs));
  const std::string known = " (known: character, region, face, depth, normal)";
  EXPECT_EQ(messageOf([] { parseAovs("depth,normals"); }),
            "--aov depth,normals: there is no kind 'normals'; write 'normal'" + known);
  EXPECT_EQ(messageOf([] { parseAovs("depth,"); }),
            "--aov depth,: there is no kind ''; write 'face'" + known);
}

}  // namespace
}  // namespace ensemble
