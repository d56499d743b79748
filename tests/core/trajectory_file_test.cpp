#include "core/trajectory_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

using ::testing::ElementsAre;

Trajectories parse(const std::string& text) { return parseTrajectories(text, "walk.txt"); }

void expectRefused(const std::string& text, const std::string& message) {
  EXPECT_INPUT_ERROR(parse(text), "walk.txt: " + message);
}

TEST(TrajectoryFile, ReadsPeopleByIdInOurFrame) {
  const Trajectories read = parse(
      "# framerate: 25.00\n# id frame x/m y/m z/m\n"
      "7 3 1.5 2.5 0.25\n2\t10\t-1e1\t-.5\t0\n7 4 2 3 0\n\n  2 11 -10 0 0  \r\n");
  EXPECT_EQ(read.fps, 25.0f);
  ASSERT_EQ(read.people.size(), 2u);
  EXPECT_EQ(read.people[0].id, 2u);
  EXPECT_EQ(read.people[0].first_frame, 10u);
  EXPECT_THAT(read.people[0].positions, ElementsAre(Vec3(-10, 0, 0.5), Vec3(-10, 0, 0)));
  EXPECT_EQ(read.people[1].id, 7u);
  EXPECT_EQ(read.people[1].first_frame, 3u);
  // z is up there and y here; x cross y is z in both.
  EXPECT_THAT(read.people[1].positions, ElementsAre(Vec3(1.5, 0.25, -2.5), Vec3(2, 0, -3)));
  EXPECT_TRUE(read.warnings.empty());
}

TEST(TrajectoryFile, ReadsWhatJpscoreWrites) {
  const Trajectories read = parse(
      "#description: jpscore (0.8.4)\n#count: 0\n#framerate: 16.00\n#geometry: geometry.xml\n"
      "#ID: the agent ID\n#FR: the current frame\n#X,Y,Z: the agents coordinates (in metres)\n"
      "#A, B: semi-axes of the ellipse\n#ANGLE: orientation of the ellipse\n#COLOR: color of the ellipse\n\n"
      "#ID\tFR\tX\tY\tZ\tA\tB\tANGLE\tCOLOR\n"
      "1\t0\t2.00\t1.00\t0.00\t0.18\t0.27\t0.00\t162\n1\t1\t2.10\t1.00\t0.00\t0.18\t0.27\t0.00\t162\n");
  EXPECT_EQ(read.fps, 16.0f);
  ASSERT_EQ(read.people.size(), 1u);
  EXPECT_THAT(read.people[0].positions, ElementsAre(Vec3(2, 0, -1), Vec3(2.1f, 0, -1)));
  EXPECT_THAT(read.warnings, ElementsAre("walk.txt:13: columns after id frame x y z are not used"));
}

TEST(TrajectoryFile, FrameRateIsReadFromHeaderCommentsOnly) {
  for (const char* comment : {"#framerate: 12.5", "# framerate 12.5 fps", "# made at a framerate: 12.5fps",
                              "# Frame rate = 12.5", "# fps: 12.5", "## FPS 12.5"}) {
    EXPECT_EQ(parse(std::string(comment) + "\n1 0 0 0\n").fps, 12.5f) << comment;
  }
  EXPECT_EQ(parse("1 0 0 0\n").fps, 0.0f);
  EXPECT_EQ(parse("# the framerate of the camera is not known\n1 0 0 0\n").fps, 0.0f);
  EXPECT_EQ(parse("1 0 0 0\n# framerate: none\n1 1 0 0\n").fps, 0.0f);
}

TEST(TrajectoryFile, UnitsAreConverted) {
  const char* sample = "1 0 150 -200 50\n";
  for (const char* comment : {"# id frame x/cm y/cm z/cm\n", "# unit: cm\n", "#X,Y,Z (in cm)\n"}) {
    EXPECT_THAT(parse(std::string(comment) + sample).people[0].positions, ElementsAre(Vec3(1.5, 0.5, 2)))
        << comment;
  }
  EXPECT_THAT(parse("# id frame x/mm y/mm\n1 0 150 -200 50\n").people[0].positions,
              ElementsAre(Vec3(0.15f, 0, 0.2f)));
  EXPECT_THAT(parse("# in cmd order\n1 0 1 2 3\n").people[0].positions, ElementsAre(Vec3(1, 3, -2)));
}

TEST(TrajectoryFile, AFifthColumnIsZUnlessTheHeaderSaysOtherwise) {
  EXPECT_EQ(parse("1 0 1 2 3\n").people[0].positions[0].y, 3.0f);
  EXPECT_EQ(parse("1 0 1 2\n").people[0].positions[0].y, 0.0f);
  const Trajectories speed = parse("#ID FR X Y SPEED\n1 0 1 2 fast\n");
  EXPECT_EQ(speed.people[0].positions[0].y, 0.0f);
  EXPECT_EQ(speed.warnings.size(), 1u);
}

TEST(TrajectoryFile, MissingFramesAreInterpolated) {
  const Trajectories read = parse("4 1 0 0 0\n4 5 4 -8 2\n4 6 4 -8 2\n");
  EXPECT_THAT(read.people[0].positions, ElementsAre(Vec3(0, 0, 0), Vec3(1, 0.5, 2), Vec3(2, 1, 4),
                                                    Vec3(3, 1.5, 6), Vec3(4, 2, 8), Vec3(4, 2, 8)));
  EXPECT_THAT(read.warnings, ElementsAre("walk.txt: 3 missing frames were interpolated"));
  EXPECT_EQ(parse("4 0 0 0\n4 51 51 0\n").people[0].positions.size(), 52u);
  expectRefused(
      "4 0 0 0\n4 52 51 0\n",
      "2:3: 51 frames of person 4 are missing before this one, more than the 50 that are interpolated; "
      "add them, or give the person another id from here on");
}

TEST(TrajectoryFile, NumbersMayBeWrittenAsNumpyWritesThem) {
  const Trajectories read = parse(
      "\xef\xbb\xbf"
      "3.000e+00 1.2e+01 1.5e+00 0\n");
  EXPECT_EQ(read.people[0].id, 3u);
  EXPECT_EQ(read.people[0].first_frame, 12u);
}

TEST(TrajectoryFile, RefusesWhatIsNoSample) {
  const std::string whole = "write a whole number from 0 to 2147483647";
  expectRefused("", "there is no trajectory in this file; write lines `id frame x y z`");
  expectRefused("# framerate: 25\n", "there is no trajectory in this file; write lines `id frame x y z`");
  expectRefused("1 0 2.5\n",
                "1:8: the line has 3 of the fields id frame x y z; write at least id, frame, x and y");
  expectRefused("1 0 0 0\n-1 0 0 0\n", "2:1: '-1' is not a person's number; " + whole);
  expectRefused("1.5 0 0 0\n", "1:1: '1.5' is not a person's number; " + whole);
  expectRefused("1,0,0,0\n",
                "1:8: the line has 1 of the fields id frame x y z; write at least id, frame, x and y");
  expectRefused("1 2147483648 0 0\n", "1:3: '2147483648' is not a frame's number; " + whole);
  expectRefused("1 nan 0 0\n", "1:3: 'nan' is not a frame's number; " + whole);
  for (const std::string number :
       {"nan", "inf", "-inf", "1e999", "0x10", "1.5.2", "+1", "--1", "north", "1\x01"}) {
    std::string shown = number;
    if (shown.back() == '\x01') shown.back() = '?';
    expectRefused("1 0 0 " + number + "\n",
                  "1:7: '" + shown + "' is not a coordinate; write a decimal number such as -1.25");
  }
  expectRefused("1 0 0 0 zero\n", "1:9: 'zero' is not a coordinate; write a decimal number such as -1.25");
  expectRefused(
      "1 0 100001 0\n",
      "1:5: the coordinate '100001' is more than 100000 m from the origin; move the origin near the "
      "people, and check the unit");
  expectRefused(
      "1 0 0 " + std::string(60, '7') + "\n",
      "1:7: the coordinate '" + std::string(40, '7') +
          " ...' is more than 100000 m from the origin; move the origin near the people, and check the "
          "unit");
}

TEST(TrajectoryFile, RefusesFramesThatDoNotAscend) {
  expectRefused("1 5 0 0\n2 5 0 0\n1 5 0 0\n",
                "3:3: frame 5 of person 1 stands twice; leave one of the two lines");
  expectRefused("1 5 0 0\n1 4 0 0\n",
                "2:3: frame 4 of person 1 comes after frame 5; sort each person's lines by frame");
}

TEST(TrajectoryFile, RefusesHeadersThatMislead) {
  const std::string mend = "; write it as `# framerate: 25.00`, in frames a second";
  expectRefused("# framerate: fast\n1 0 0 0\n",
                "1:14: the frame rate 'fast' is no number above 0, up to 1000" + mend);
  expectRefused("#framerate: -5\n", "1:13: the frame rate '-5' is no number above 0, up to 1000" + mend);
  expectRefused("#framerate: 0\n", "1:13: the frame rate '0' is no number above 0, up to 1000" + mend);
  expectRefused("#fps: nan\n", "1:7: the frame rate 'nan' is no number above 0, up to 1000" + mend);
  expectRefused("#fps: 25\n# framerate: 30\n",
                "2:14: the frame rate 30 contradicts the 25 above; leave one of the two comments");
  for (const char* header : {"#Frame ID X Y Z", "# id frame y x z", "# fr persid x y"}) {
    EXPECT_THROW(parse(std::string(header) + "\n1 0 0 0\n"), InputError) << header;
  }
  expectRefused("# frame id x/m y/m\n1 0 0 0\n",
                "1:3: the columns are in another order than id frame x y z; write them in that order");
}

TEST(TrajectoryFile, LimitsHoldBeforeMemoryIsTaken) {
  TrajectoryLimits limits;
  limits.max_people = 2;
  limits.max_samples = 4;
  limits.max_line_bytes = 20;
  const auto limited = [&](const std::string& text) { return parseTrajectories(text, "walk.txt", limits); };
  EXPECT_EQ(limited("1 0 0 0\n2 0 0 0\n1 1 0 0\n2 1 0 0\n").people.size(), 2u);
  EXPECT_INPUT_ERROR(limited("1 0 0 0\n2 0 0 0\n3 0 0 0\n"),
                     "walk.txt: 3:1: there are more than 2 people; split the file");
  EXPECT_INPUT_ERROR(limited("1 0 0 0\n1 4 0 0\n"),
                     "walk.txt: 2:3: there are more than 4 samples; split the file");
  EXPECT_INPUT_ERROR(
      limited("1 0 0 0\n# " + std::string(19, 'a')),
      "walk.txt: 2:21: the line is longer than 20 bytes; write one sample a line: id frame x y z");
}

TEST(TrajectoryFile, LoadsFiles) {
  const testing::TemporaryFolder folder;
  const std::string path = (folder / "w.txt").string();
  writeFileAtomically(path, std::string_view("1 0 1 2\n"));
  EXPECT_EQ(loadTrajectories(path).people.size(), 1u);
  TrajectoryLimits limits;
  limits.max_bytes = 7;
  EXPECT_INPUT_ERROR(loadTrajectories(path, limits),
                     path + ": has 8 bytes, more than the 7 that are read; split it or reduce its content");
  EXPECT_INPUT_ERROR(loadTrajectories(folder / "none.txt"),
                     (folder / "none.txt").string() + ": no such file; check the path");
}

}  // namespace
}  // namespace ensemble
