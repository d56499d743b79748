#include "core/crowd_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/atomic_file.h"
#include "core/check.h"
#include "core/csv_file.h"
#include "core/random.h"
#include "tests/support/expect_error.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

using ::testing::ElementsAre;

CrowdTable parse(const std::string& text) { return parseCrowdTable(text, "crowd.csv"); }

void expectRefused(const std::string& text, const std::string& message) {
  EXPECT_INPUT_ERROR(parse(text), "crowd.csv: " + message);
}

std::vector<std::string> record(const std::string& text) {
  CsvReader reader(text, "a.csv");
  std::vector<CsvField> fields;
  std::vector<std::string> texts;
  if (reader.readRecord(fields)) {
    for (const CsvField& field : fields) texts.push_back(field.text);
  }
  return texts;
}

TEST(CsvFile, ReadsFieldsAsTheRfcHasThem) {
  EXPECT_THAT(record("a,b c,\n"), ElementsAre("a", "b c", ""));
  EXPECT_THAT(record(","), ElementsAre("", ""));
  EXPECT_THAT(record("\"a\",\"\",\"b, \"\"c\"\"\"\r\nnext"), ElementsAre("a", "", "b, \"c\""));
  EXPECT_THAT(record("\"two\r\nlines\",b\n"), ElementsAre("two\r\nlines", "b"));
  EXPECT_THAT(record("\xef\xbb\xbf  a\t, \" b \" ,c "), ElementsAre("a", " b ", "c")) << "blanks";
  EXPECT_THAT(record(" \n\r\n\n\t\na"), ElementsAre("a")) << "empty lines";
  EXPECT_THAT(record(" \n\n"), ElementsAre());
}

TEST(CsvFile, TellsPlacesAcrossLineEnds) {
  CsvReader reader("a\r\nb\rc\n\n\"x\ny\",d\n e", "a.csv");
  std::vector<CsvField> fields;
  const auto place = [&](std::size_t i) { return fields.at(i).mark().toString(); };
  ASSERT_TRUE(reader.readRecord(fields));
  EXPECT_EQ(place(0), "1:1");
  ASSERT_TRUE(reader.readRecord(fields));
  EXPECT_EQ(place(0), "2:1");
  ASSERT_TRUE(reader.readRecord(fields));
  EXPECT_EQ(place(0), "3:1");
  ASSERT_TRUE(reader.readRecord(fields));
  EXPECT_EQ(place(0), "5:1");
  EXPECT_EQ(place(1), "6:4");
  ASSERT_TRUE(reader.readRecord(fields));
  EXPECT_EQ(place(0), "7:2");
  EXPECT_FALSE(reader.readRecord(fields));
}

TEST(CsvFile, RefusesQuotesThatDontFit) {
  const std::string twice = "put the whole field in quotes, and write each quote in it twice";
  EXPECT_INPUT_ERROR(record("a,b\"c\n"),
                     "a.csv: 1:4: there is a quote inside a field that does not begin with one; " + twice);
  EXPECT_INPUT_ERROR(record("\"a\" b\n"),
                     "a.csv: 1:5: there is more after the field's closing quote; " + twice);
  EXPECT_INPUT_ERROR(record("a, \"b\n"),
                     "a.csv: 1:4: the field's quotes are not closed; add the closing quote");
  EXPECT_INPUT_ERROR(record("a,\"" + std::string(4097, 'b')),
                     "a.csv: 1:3: the field is longer than 4096 bytes; shorten it, or close its quotes");
  EXPECT_INPUT_ERROR(
      record(std::string(64, ',')),
      "a.csv: 1:65: the row has more than 64 fields; see whether its line ends where it should");
}

TEST(CsvFile, ReadsBackWhatItWrites) {
  for (const std::string field : {"", "a", " a", "a\t", "a,b", "\"", "a\"\"b", "a\r\nb", "\n", "\r", "a'b;c",
                                  "\xc3\xa4", "a b", "\x01"}) {
    std::string text;
    appendCsvField(text, field);
    text += ",end\n";
    EXPECT_THAT(record(text), ElementsAre(field, "end")) << text;
  }
}

TEST(CrowdTable, ReadsPeople) {
  const CrowdTable read = parse(
      "wardrobe,z,x,tint,outfit,y,heading,number,clip,phase,speed,scale\n"
      "women,2.5,-1e1,4294967295,casual01+hat,.5,-90,7,walk,0.25,0,1.5\r\n\n"
      ", -0.5 ,3,,,,,,,,,\n"
      "women,0,0,0,\"casual01+hat\",0,45,1,\"a, b\",1,100,100\n");
  EXPECT_TRUE(read.columns.all());
  ASSERT_EQ(read.rows.size(), 3u);
  EXPECT_THAT(read.names, ElementsAre("", "women", "casual01+hat", "walk", "a, b"));
  const CrowdTableRow& first = read.rows[0];
  EXPECT_EQ(first.number, 7u);
  EXPECT_EQ(first.wardrobe.name, 1u);
  EXPECT_EQ(first.outfit.name, 2u);
  EXPECT_EQ(first.outfit.mark().toString(), "2:27");
  EXPECT_EQ(first.clip.name, 3u);
  EXPECT_EQ(first.phase, 0.25f);
  EXPECT_EQ(first.speed, 0.0f);
  EXPECT_EQ(first.position, Vec3(-10, 0.5, 2.5));
  EXPECT_EQ(first.heading, radians(-90.0f));
  EXPECT_EQ(first.scale, 1.5f);
  EXPECT_EQ(first.tint, 4294967295u);
  const CrowdTableRow& empty = read.rows[1];
  EXPECT_EQ(empty.number, 1u) << "its row's";
  EXPECT_EQ(empty.wardrobe.name, 0u);
  EXPECT_EQ(empty.clip.name, 0u);
  EXPECT_EQ(empty.phase, 0.0f);
  EXPECT_EQ(empty.speed, 1.0f);
  EXPECT_EQ(empty.position, Vec3(3, 0, -0.5));
  EXPECT_EQ(empty.heading, 0.0f);
  EXPECT_EQ(empty.scale, 1.0f);
  EXPECT_FALSE(empty.tint);
  EXPECT_EQ(read.rows[2].clip.name, 4u);
  EXPECT_EQ(read.rows[2].clip.mark().toString(), "5:35");
}

TEST(CrowdTable, NeedsNoMoreThanXAndZ) {
  const CrowdTable read = parse("x,z\n1,2\n");
  EXPECT_EQ(read.rows.at(0).position, Vec3(1, 0, 2));
  EXPECT_TRUE(read.has(CrowdColumn::kX));
  EXPECT_FALSE(read.has(CrowdColumn::kY));
  EXPECT_TRUE(parse("x,z\n").rows.empty()) << "a crowd of nobody";
}

TEST(CrowdTable, RefusesHeadersThatMislead) {
  const std::string known =
      " (known: number, wardrobe, outfit, clip, phase, speed, x, y, z, heading, scale, tint)";
  expectRefused("", "the crowd table is empty; begin with a row of column names: x,z");
  expectRefused("\n \n", "the crowd table is empty; begin with a row of column names: x,z");
  expectRefused("1.5,2\n", "1:1: the table begins with a number; begin with a row of column names: x,z");
  expectRefused("x,z,headng\n", "1:5: unknown column 'headng'; write 'heading'" + known);
  expectRefused("x,z,\n", "1:5: unknown column ''; write 'x'" + known);
  expectRefused("x,Z\n", "1:3: unknown column 'Z'; write 'z'" + known);
  expectRefused("x,z,x\n", "1:5: the column 'x' is here a second time; remove one of them");
  expectRefused("x,y\n1,2\n",
                "1:1: there is no column 'z'; add it: x and z are where people stand, in metres");
  expectRefused("z\n", "1:1: there is no column 'x'; add it: x and z are where people stand, in metres");
  expectRefused("x;y;z\n", "1:1: fields are parted by ';' here; part them by commas, and write 0.5, not 0,5");
  expectRefused("x\tz\n", "1:1: fields are parted by tabs here; part them by commas, and write 0.5, not 0,5");
}

TEST(CrowdTable, RefusesFieldsByTheirPlace) {
  const std::string place = "a number from -10000000000 to 10000000000 (metres)";
  expectRefused("x,z\n1\n",
                "2:1: the row has 1 fields, the first row names 2 columns; write a field for each column; it "
                "may be empty");
  expectRefused("x,z\n1,2,3,4\n",
                "2:5: the row has 4 fields, the first row names 2 columns; write a field for each column; it "
                "may be empty");
  expectRefused("x,z\n1,\n", "2:3: z is empty; give " + place);
  for (const std::string number :
       {"nan", "inf", "-inf", "1e999", "0x10", "1.5.2", "+1", "--1", "1e11", "1 2"}) {
    expectRefused("x,z\n" + number + ",0\n", "2:1: x is '" + number + "'; give " + place);
  }
  const auto refusedField = [](const std::string& column, const std::string& field, const std::string& mend) {
    expectRefused("x,z," + column + "\n0,0," + field + "\n",
                  "2:5: " + column + " is '" + field + "'; give " + mend);
  };
  refusedField("y", "up", place);
  refusedField("phase", "1.01", "a number from 0 to 1");
  refusedField("speed", "-1", "a number from 0 to 100");
  refusedField("heading", "3601", "a number from -3600 to 3600 (degrees)");
  refusedField("scale", "0", "a number from 0.01 to 100");
  refusedField("number", "-1", "a whole number from 0 to 4294967295");
  refusedField("number", "1.0", "a whole number from 0 to 4294967295");
  refusedField("tint", "4294967296", "a whole number from 0 to 4294967295");
  refusedField("tint", "-1", "a whole number from 0 to 4294967295");
}

TEST(CrowdTable, LimitsHold) {
  CrowdTableLimits limits;
  limits.max_rows = 2;
  limits.max_names = 1;
  limits.max_field_bytes = 8;
  const auto limited = [&](const std::string& text) { return parseCrowdTable(text, "crowd.csv", limits); };
  EXPECT_EQ(limited("x,z,clip\n0,0,a\n0,0,a\n").rows.size(), 2u);
  EXPECT_INPUT_ERROR(limited("x,z\n0,0\n0,0\n0,0\n"),
                     "crowd.csv: 4:1: there are more than 2 rows; split the file");
  EXPECT_INPUT_ERROR(limited("x,z,clip\n0,0,a\n0,0,b\n"),
                     "crowd.csv: 3:5: there are more than 1 different names; split the file");
  EXPECT_INPUT_ERROR(limited("x,z\n0,0.0000001\n"),
                     "crowd.csv: 2:3: the field is longer than 8 bytes; shorten it, or close its quotes");
}

TEST(CrowdTable, LoadsFilesThatAreNamedCsv) {
  EXPECT_TRUE(isCrowdTable("a/b.csv"));
  EXPECT_TRUE(isCrowdTable("B.CSV"));
  EXPECT_FALSE(isCrowdTable("csv"));
  EXPECT_FALSE(isCrowdTable("a.csv.txt"));
  const testing::TemporaryFolder folder;
  const std::string path = (folder / "c.csv").string();
  writeFileAtomically(path, std::string_view("x,z\n1,2\n"));
  EXPECT_EQ(loadCrowdTable(path).rows.size(), 1u);
  CrowdTableLimits limits;
  limits.max_bytes = 7;
  EXPECT_INPUT_ERROR(loadCrowdTable(path, limits),
                     path + ": has 8 bytes, more than the 7 that are read; split it or reduce its content");
  EXPECT_INPUT_ERROR(loadCrowdTable(folder / "none.csv"),
                     (folder / "none.csv").string() + ": no such file; check the path");
}

// ---- Writing

CrowdTable oneOf(const CrowdTableRow& row) {
  CrowdTable table;
  table.columns.set();
  table.rows.push_back(row);
  return table;
}

CrowdTable headed(float heading) {
  CrowdTableRow row;
  row.heading = heading;
  return oneOf(row);
}

TEST(CrowdTable, IsWrittenByTheLine) {
  CrowdTable table = oneOf({.number = 3,
                            .wardrobe = {1},
                            .outfit = {2},
                            .clip = {},
                            .phase = 0.1f,
                            .speed = 0.0f,
                            .position = Vec3(-1.5f, 0.0f, 1e-7f),
                            .heading = radians(90.0f),
                            .scale = 1.0f,
                            .tint = std::nullopt});
  table.names = {"", "a, b", "say \"hi\""};
  EXPECT_EQ(crowdTableText(table),
            "number,wardrobe,outfit,clip,phase,speed,x,y,z,heading,scale,tint\n"
            "3,\"a, b\",\"say \"\"hi\"\"\",,0.1,0,-1.5,0,1e-07,90,1,\n");
  table.columns.reset();
  table.columns.set(static_cast<std::size_t>(CrowdColumn::kX));
  table.columns.set(static_cast<std::size_t>(CrowdColumn::kZ));
  EXPECT_EQ(crowdTableText(table), "x,z\n-1.5,1e-07\n");
}

bool sameBits(float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0; }

TEST(CrowdTable, EveryNumberIsReadBackToTheBit) {
  CrowdTable table;
  table.columns.set();
  const RandomStream random(3, 1);
  constexpr std::uint64_t kRows = 20'000;
  for (std::uint64_t i = 0; i < kRows; ++i) {
    const auto wide = [&](std::uint64_t k) {  // over all magnitudes
      const float exponent = 60.0f * random.uniformFloat(20 * i + k) - 27.0f;
      return (random.bits32(20 * i + k) % 2 == 0 ? 1.0f : -1.0f) * std::exp2(exponent);
    };
    table.rows.push_back({.number = static_cast<std::uint32_t>(i + 1),
                          .wardrobe = {},
                          .outfit = {},
                          .clip = {},
                          .phase = random.uniformFloat(20 * i),
                          .speed = 100.0f * random.uniformFloat(20 * i + 1),
                          .position = Vec3(wide(2), wide(3), wide(4)),
                          // As populateCrowd turns people, and near 0.
                          .heading = i % 4 == 0
                                         ? 1e-3f * wide(5) / 1e7f
                                         : static_cast<float>(random.uniform(20 * i + 6) * 6.283185307179586),
                          .scale = 0.01f + 99.0f * random.uniformFloat(20 * i + 7),
                          .tint = random.bits32(20 * i + 8)});
  }
  const CrowdTable read = parse(crowdTableText(table));
  ASSERT_EQ(read.rows.size(), kRows);
  for (std::uint64_t i = 0; i < kRows; ++i) {
    const CrowdTableRow &a = table.rows[i], &b = read.rows[i];
    ASSERT_TRUE(sameBits(a.phase, b.phase) && sameBits(a.speed, b.speed) && sameBits(a.scale, b.scale)) << i;
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(sameBits(a.position[k], b.position[k])) << a.position[k];
    ASSERT_TRUE(sameBits(a.heading, b.heading)) << i << ": " << a.heading;
    ASSERT_EQ(a.number, b.number);
    ASSERT_EQ(a.tint, b.tint);
  }
}

TEST(CrowdTable, EveryFloatOfAHeadingHasADecimal) {
  // All the floats of an interval in which those of degrees are too few, and the ends of the circle.
  for (const float begin : {1.2f, 6.2831850f, -3.1415927f, 1e-30f}) {
    float heading = begin;
    for (int i = 0; i < 2000; ++i) {
      const std::string text = crowdTableText(headed(heading));
      ASSERT_EQ(parse(text).rows.at(0).heading, heading) << text;
      heading = std::nextafter(heading, 10.0f);
    }
  }
  // Degrees that people write are written as they were.
  for (int degrees = -360; degrees <= 360; degrees += 5) {
    const CrowdTable read = parse("x,z,heading\n0,0," + std::to_string(degrees) + "\n");
    EXPECT_EQ(crowdTableText(read), "x,z,heading\n0,0," + std::to_string(degrees) + "\n");
  }
  EXPECT_THROW(crowdTableText(headed(std::numeric_limits<float>::quiet_NaN())), CheckError);
}

}  // namespace
}  // namespace ensemble
