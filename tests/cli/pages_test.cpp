// What `report` and `bench` write beside JSON: the same figures as CSV and as web pages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "assetpipe/report.h"
#include "assetpipe/tag_regions.h"
#include "cli/bench_figures.h"
#include "cli/bench_page.h"
#include "cli/html_page.h"
#include "cli/picture_error.h"
#include "cli/report_page.h"
#include "core/wardrobe.h"
#include "tests/support/temporary_folder.h"

namespace ensemble::cli {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::HasSubstr;
using ::testing::Not;

/// Rows of a CSV without quotes, as {column: text}.
std::vector<std::map<std::string, std::string>> readCsv(const std::string& text) {
  const auto fieldsOf = [](const std::string& line) {
    std::vector<std::string> fields;
    std::stringstream stream(line + ",");
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    return fields;
  };
  std::stringstream stream(text);
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> header = fieldsOf(line);
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(stream, line)) {
    const std::vector<std::string> fields = fieldsOf(line);
    EXPECT_EQ(fields.size(), header.size()) << line;
    auto& row = rows.emplace_back();
    for (std::size_t i = 0; i < std::min(fields.size(), header.size()); ++i) row[header[i]] = fields[i];
  }
  return rows;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// Another program's parser reads the page, and it asks nothing of elsewhere.
void expectWholePage(const std::string& page) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "page.html") << page;
  const std::string command = "python3 -c 'import sys, xml.dom.minidom as m; m.parse(sys.argv[1])' " +
                              (folder / "page.html").string();
  EXPECT_EQ(std::system(command.c_str()), 0) << "not well-formed";
  for (const char* foreign : {"<script", "<link", "<img", "url(", "@import", "src=", "href="})
    EXPECT_THAT(page, Not(HasSubstr(foreign)));
}

Report smallReport() { return makeReport(loadWardrobe("tests/formats/wardrobe-1"), 250); }

TEST(Pages, TextIsSafeInXml) {
  EXPECT_EQ(escapeXml("a<b> & \"c\"\n\x01\xc3\xa9"), "a&lt;b&gt; &amp; &quot;c&quot;??\xc3\xa9");
  EXPECT_EQ(groupDigits(0), "0");
  EXPECT_EQ(groupDigits(999), "999");
  EXPECT_EQ(groupDigits(1000), "1,000");
  EXPECT_EQ(groupDigits(12345678), "12,345,678");
}

TEST(Pages, PartsOfTheReportAddUp) {
  const Report report = smallReport();
  const Json figures = toJson(report);
  for (const char* technique : {"naive", "prefitted", "tagged"}) {
    const Json& row = figures["techniques"][technique];
    for (const auto& [parts, total] : {std::pair("faces_of", "faces"), std::pair("bytes_of", "bytes")}) {
      std::uint64_t sum = 0;
      for (const Json& part : row[parts]) sum += part.get<std::uint64_t>();
      EXPECT_EQ(sum, row[total]) << technique << " " << parts;
    }
  }
  const Json& tagged = figures["techniques"]["tagged"]["bytes_of"];
  const Json& naive = figures["techniques"]["naive"]["bytes_of"];
  EXPECT_EQ(tagged["template"], naive["template"]);
  EXPECT_EQ(tagged["garments"], naive["garments"]);
  EXPECT_EQ(naive["fitted_body"], 0);
  // The wardrobe has one outfit, so its dedicated sub-meshes are all there are: 6 bytes a face.
  EXPECT_EQ(tagged["fitted_body"], figures["outfits"][0]["dedicated_faces"].get<int>() * 6);
  EXPECT_EQ(figures["outfits"][0]["bytes"]["tagged"]["fitted_body"], tagged["fitted_body"]);
  EXPECT_EQ(figures["techniques"]["prefitted"]["bytes_of"]["template"], 0);
}

TEST(Pages, CsvOfTheReportSaysWhatTheJsonSays) {
  const Report report = smallReport();
  const Json figures = toJson(report);
  const auto rows = readCsv(toCsv(report));
  const Json& curve = figures["extrapolated"]["curve"];
  ASSERT_EQ(rows.size(), 3 * figures["outfits"].size() + 3 + 1 + 3 * curve.size());
  std::size_t r = 0;
  for (const Json& outfit : figures["outfits"]) {
    for (const char* technique : {"naive", "prefitted", "tagged"}) {
      auto row = rows[r++];
      EXPECT_EQ(row["kind"], "outfit");
      EXPECT_EQ(row["name"], outfit["name"]);
      EXPECT_EQ(row["technique"], technique);
      EXPECT_EQ(row["garment_faces"], outfit["garment_faces"].dump());
      EXPECT_EQ(row["garment_bytes"], outfit["bytes"][technique]["garments"].dump());
      EXPECT_EQ(row["fitted_body_bytes"], outfit["bytes"][technique]["fitted_body"].dump());
      for (const Json& region : outfit["regions"])
        EXPECT_EQ(row["visible." + region["name"].get<std::string>()], region["visible_faces"].dump());
    }
    auto prefitted = rows[r - 2], tagged = rows[r - 1];
    EXPECT_EQ(prefitted["faces"], outfit["prefitted_faces"].dump());
    EXPECT_EQ(tagged["fitted_body_faces"], outfit["dedicated_faces"].dump());
  }
  for (const char* technique : {"naive", "prefitted", "tagged"}) {
    auto row = rows[r++];
    EXPECT_EQ(row["kind"], "total");
    EXPECT_EQ(row["faces"], figures["techniques"][technique]["faces"].dump());
    EXPECT_EQ(row["bytes"], figures["techniques"][technique]["bytes"].dump());
    EXPECT_EQ(row["template_bytes"], figures["techniques"][technique]["bytes_of"]["template"].dump());
  }
  auto bound = rows[r++];
  EXPECT_EQ(bound["kind"], "lower bound");
  EXPECT_EQ(bound["bytes"], figures["lower_bound_bytes"].dump());
  for (const Json& point : curve) {
    for (const char* technique : {"naive", "prefitted", "tagged"}) {
      auto row = rows[r++];
      EXPECT_EQ(row["kind"], point["kind"]);
      EXPECT_EQ(row["name"], point["outfits"].dump());
      EXPECT_EQ(row["faces"], point[technique].dump());
      EXPECT_EQ(row["bytes"], "") << "bytes are not extrapolated";
    }
  }
}

TEST(Pages, TheReportsPageShowsItsFigures) {
  Json figures = toJson(smallReport());
  figures["wardrobe"] = "<a> & b";
  const std::string page = reportPage(figures);
  expectWholePage(page);
  EXPECT_THAT(page, HasSubstr("<h1>What tagging saves: &lt;a&gt; &amp; b</h1>"));
  EXPECT_EQ(count(page, "<svg "), 6u);
  for (const char* key : {"garment_faces", "dedicated_faces", "prefitted_faces"})
    EXPECT_THAT(page, HasSubstr("<td>" + groupDigits(figures["outfits"][0][key]) + "</td>"));
  EXPECT_THAT(page, HasSubstr("<td>" + groupDigits(figures["lower_bound_bytes"]) + "</td>"));
  // Three curves of faces and one of shares, each marked where it was counted.
  EXPECT_EQ(count(page, "class=\"mark "), 4u);
  figures.erase("extrapolated");
  EXPECT_EQ(count(reportPage(figures), "<svg "), 4u);
}

const Json kStored = {{"visible_bodies", 1234},       {"dedicated_sub_meshes", 56},
                      {"lower_bound_bytes", 2000000}, {"tagged_bytes", 2100000},
                      {"prefitted_bytes", 6300000},   {"tagged_vs_lower_bound", 1.05},
                      {"prefitted_vs_tagged", 3.0}};

TEST(Pages, TheReportsPageTellsOfCombinations) {
  Json figures = toJson(smallReport());
  figures["wardrobe"] = "w";
  EXPECT_THAT(reportPage(figures), Not(HasSubstr("Combined"))) << "complete outfits are not combined";
  figures["combinations"] = {
      {"items", {{"upper", 20}, {"head", 0}, {"lower", 30}}}, {"count", 600}, {"stored", kStored}};
  const std::string page = reportPage(figures);
  expectWholePage(page);
  EXPECT_THAT(page, HasSubstr("<p>600 combinations of the items (20 upper, 30 lower) dress a person.</p>"));
  EXPECT_THAT(page, HasSubstr("1.050 times the items once"));
  EXPECT_THAT(page, HasSubstr("3.00 times as much as tagged"));
  EXPECT_THAT(page, HasSubstr("<td>w</td><td>600</td><td>1,234</td><td>56</td><td>2,000,000</td>"
                              "<td>2,100,000</td><td>6,300,000</td>"));
  EXPECT_EQ(count(page, "<svg "), 7u);
  figures["combinations"]["count"] = nullptr;
  figures["combinations"]["stored"] = nullptr;
  EXPECT_THAT(reportPage(figures), HasSubstr("<p>2^64 or more combinations of the items"));
  EXPECT_THAT(reportPage(figures), HasSubstr("too many different bodies"));
}

TEST(Pages, AScenesPageShowsItsFigures) {
  const Json part = {{"key", "men"}, {"people", 7}, {"combinations", 3}, {"stored", kStored}};
  Json figures = {{"scene", "a<b.yaml"},
                  {"people", 5000},
                  {"combinations", 842},
                  {"wardrobes", {part, part}},
                  {"stored", kStored},
                  {"layers",
                   {{"pairs", 5},
                    {"garment_faces", 90'000},
                    {"hidden_garment_faces", 8'000},
                    {"drawn_garment_faces", 83'500},
                    {"garment_lists", 34}}}};
  const std::string page = sceneReportPage(figures);
  expectWholePage(page);
  EXPECT_THAT(page, HasSubstr("<h1>What a crowd's clothes store: a&lt;b.yaml</h1>"));
  EXPECT_THAT(page, HasSubstr("<p>5,000 people in 842 combinations of items."));
  EXPECT_EQ(count(page, "<td>men, 7 people</td><td>3</td>"), 2u);
  EXPECT_EQ(count(page, "<td>in all</td><td>842</td>"), 1u);
  EXPECT_THAT(page, HasSubstr("<td>5</td><td>90,000</td><td>8,000</td><td>83,500</td><td>34</td>"));
  figures["layers"]["pairs"] = 0;
  EXPECT_THAT(sceneReportPage(figures), Not(HasSubstr("Worn over one another")));
  figures["wardrobes"] = {part};
  EXPECT_EQ(count(sceneReportPage(figures), "<td>in all</td>"), 0u);
}

TEST(Pages, AWardrobeWithoutOutfitsHasAPage) {
  Report report;
  report.template_faces = 10;
  report.faces = countStoredFaces(10, {});
  report.extrapolation = extrapolate(10, {}, 5);
  Json figures = toJson(report);
  figures["wardrobe"] = "bare";
  EXPECT_TRUE(figures["extrapolated"]["tagged_vs_prefitted"].is_null());
  expectWholePage(reportPage(figures));
}

/// A row with given times; counts that tell rows apart. In compute half of the people are drawn.
ContestRow row(Technique technique, std::size_t characters, const std::vector<double>& frame_ms,
               RasterKind raster = RasterKind::kPipeline) {
  ContestRow result{.technique = technique, .raster = raster, .characters = characters};
  for (const double time : frame_ms) {
    FrameStats stats;
    stats.frame_ms = time;
    stats.cpu_ms = 0.25;
    stats.characters_drawn = static_cast<std::uint32_t>(characters);
    stats.main = {.draw_calls = 3, .triangles = 10 * characters, .vertex_invocations = 7 * characters};
    stats.people_triangles = stats.main.triangles;
    stats.shadow.vertex_invocations = 0;
    stats.gpu_mesh_bytes = 1000;
    stats.culled_on_device = raster == RasterKind::kPipeline;
    if (raster == RasterKind::kCompute) {
      stats.characters_computed = stats.characters_drawn / 2;
      stats.triangles_computed = 4 * characters;
      stats.poses = {.kept = 30, .skinned = result.rounds.empty() ? 10u : 0u, .kept_bytes = 4096};
    }
    result.rounds.push_back(stats);
  }
  return result;
}

Json emptyBench() {
  return {{"schema", "ensemble.bench/1"},
          {"device", "<none>"},
          {"width", 64},
          {"height", 32},
          {"samples", 1},
          {"scene", "s.yaml"},
          {"frames", {0}},
          {"rounds", 3},
          {"warm_up_rounds", 1},
          {"rows", Json::array()},
          {"ratios", Json::array()},
          {"picture_errors", Json::array()}};
}

Json benchFigures() {
  Json figures = emptyBench();
  for (const std::size_t people : {10u, 20u}) {
    const std::vector<ContestRow> rows = {row(Technique::kNaive, people, {10, 20, 40}),
                                          row(Technique::kPrefitted, people, {8, 10, 20}),
                                          row(Technique::kTagged, people, {4, 16, 24})};
    addContest(rows, {}, figures);
  }
  return figures;
}

/// Two techniques by two rasterisers, over frames 5 to 7.
Json rasterFigures() {
  Json figures = emptyBench();
  figures["frames"] = {5, 6, 7};
  const std::vector<ContestRow> rows = {row(Technique::kPrefitted, 20, {30, 40, 50}),
                                        row(Technique::kPrefitted, 20, {3, 4, 5}, RasterKind::kCompute),
                                        row(Technique::kTagged, 20, {24, 36, 60}),
                                        row(Technique::kTagged, 20, {6, 6, 6}, RasterKind::kCompute)};
  std::vector<ContestError> errors;
  for (const Technique technique : {Technique::kPrefitted, Technique::kTagged}) {
    errors.push_back({.technique = technique,
                      .characters = 20,
                      .frames = 3,
                      .sum_of_shares = 0.0015,
                      .worst_share = 0.00125,
                      .worst_frame = 6,
                      .most = 77});
  }
  addContest(rows, errors, figures);
  return figures;
}

TEST(Pages, RatiosAreTakenRoundByRound) {
  const Json figures = benchFigures();
  ASSERT_EQ(figures["rows"].size(), 6u);
  ASSERT_EQ(figures["ratios"].size(), 6u);
  const Json &prefitted = figures["ratios"][0], &tagged = figures["ratios"][1], &both = figures["ratios"][2];
  EXPECT_EQ(prefitted["technique"], "prefitted");
  EXPECT_EQ(prefitted["versus"], "naive");
  EXPECT_DOUBLE_EQ(prefitted["frame_ms"], 10.0 / 20.0);
  EXPECT_DOUBLE_EQ(prefitted["frame_ms_of_rounds"]["median"], 0.5);  // of 0.8, 0.5, 0.5
  EXPECT_DOUBLE_EQ(prefitted["frame_ms_of_rounds"]["q3"], 0.65);
  EXPECT_DOUBLE_EQ(tagged["frame_ms"], 16.0 / 20.0);
  EXPECT_DOUBLE_EQ(tagged["frame_ms_of_rounds"]["median"], 0.6);  // of 0.4, 0.8, 0.6
  EXPECT_EQ(both["technique"], "tagged");
  EXPECT_EQ(both["versus"], "prefitted");
  EXPECT_DOUBLE_EQ(both["frame_ms"], 1.6);
  EXPECT_DOUBLE_EQ(both["frame_ms_of_rounds"]["median"], 1.2);  // of 0.5, 1.6, 1.2
  EXPECT_DOUBLE_EQ(both["vertex_invocations"], 1.0);
}

TEST(Pages, WithoutNaiveTheFirstIsTheMeasure) {
  Json figures = emptyBench();
  const std::vector<ContestRow> rows = {row(Technique::kPrefitted, 5, {2.0}),
                                        row(Technique::kTagged, 5, {3.0})};
  addContest(rows, {}, figures);
  ASSERT_EQ(figures["ratios"].size(), 1u);
  EXPECT_EQ(figures["ratios"][0]["versus"], "prefitted");
  EXPECT_DOUBLE_EQ(figures["ratios"][0]["frame_ms"], 1.5);
}

TEST(Pages, CsvOfTheBenchSaysWhatTheJsonSays) {
  const Json figures = benchFigures();
  const auto rows = readCsv(benchCsv(figures));
  ASSERT_EQ(rows.size(), 6u);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    auto text = rows[r];
    const Json& row = figures["rows"][r];
    EXPECT_EQ(text["technique"], row["technique"]);
    for (const char* key :
         {"characters", "rounds", "cpu_ms", "vertex_invocations", "triangles", "draw_calls"})
      EXPECT_EQ(text[key], row[key].dump());
    for (const char* key : {"min", "q1", "median", "q3", "max"})
      EXPECT_EQ(text[std::string("frame_ms_") + key], row["frame_ms"][key].dump());
  }
  auto naive = rows[3], prefitted = rows[4], tagged = rows[5];
  EXPECT_EQ(naive["frame_vs_naive"], "");
  EXPECT_EQ(prefitted["frame_vs_naive"], figures["ratios"][3]["frame_ms"].dump());
  EXPECT_EQ(prefitted["frame_vs_prefitted"], "");
  EXPECT_EQ(tagged["frame_vs_naive_q1"], figures["ratios"][4]["frame_ms_of_rounds"]["q1"].dump());
  EXPECT_EQ(tagged["frame_vs_prefitted_median"], figures["ratios"][5]["frame_ms_of_rounds"]["median"].dump());
}

TEST(Pages, RasterisersAreComparedWithinATechnique) {
  const Json figures = rasterFigures();
  std::vector<std::string> names;
  for (const Json& ratios : figures["ratios"]) names.push_back(nameOfRatio(ratios));
  EXPECT_EQ(names,
            (std::vector<std::string>{"tagged / prefitted by pipeline", "tagged / prefitted by compute",
                                      "prefitted by pipeline / compute", "tagged by pipeline / compute"}));
  EXPECT_DOUBLE_EQ(figures["ratios"][0]["frame_ms"], 36.0 / 40.0);
  EXPECT_DOUBLE_EQ(figures["ratios"][1]["frame_ms"], 6.0 / 4.0);
  EXPECT_DOUBLE_EQ(figures["ratios"][2]["frame_ms"], 10.0);
  EXPECT_DOUBLE_EQ(figures["ratios"][3]["frame_ms"], 6.0);
  EXPECT_DOUBLE_EQ(figures["ratios"][3]["frame_ms_of_rounds"]["min"], 4.0);
  const Json &pipeline = figures["rows"][2], &compute = figures["rows"][3];
  EXPECT_EQ(pipeline["raster"], "pipeline");
  EXPECT_EQ(pipeline["share_of_people_computed"], 0.0);
  EXPECT_TRUE(pipeline["poses"]["share_kept"].is_null());
  EXPECT_EQ(pipeline["culling"], "device");
  EXPECT_EQ(compute["raster"], "compute");
  EXPECT_EQ(compute["culling"], "host");
  EXPECT_DOUBLE_EQ(compute["share_of_people_computed"], 0.5);
  EXPECT_DOUBLE_EQ(compute["share_of_triangles_computed"], 0.4);
  EXPECT_EQ(compute["poses"]["kept"], 90) << "in all rounds";
  EXPECT_EQ(compute["poses"]["skinned"], 10);
  EXPECT_DOUBLE_EQ(compute["poses"]["share_kept"], 0.9);
  EXPECT_EQ(compute["poses"]["kept_bytes"], 4096);
  EXPECT_THAT(benchTable(figures),
              HasSubstr("tagged by compute, 20 people: in compute 50.0 % of the people drawn, "
                        "40.0 % of their triangles; poses 90.00 % kept, 10 skinned in 3 "
                        "rounds, 0.0 MiB\n"));
  EXPECT_THAT(
      benchTable(figures),
      HasSubstr("tagged by pipeline and compute, 20 people: 0.125 % of the pixels that people cover differ "
                "by more than 8 of 255 in the worst of 3 frames (6), 0.050 % in the mean, by 77 at most\n"));
}

TEST(Pages, CountsOfDifferentFramesAreThoseOfTheMiddleOne) {
  Json figures = emptyBench();
  ContestRow moving = row(Technique::kTagged, 20, {1, 2, 3, 4});
  const std::uint64_t triangles[] = {500, 100, 300, 900};
  for (std::size_t i = 0; i < 4; ++i) moving.rounds[i].main.triangles = triangles[i];
  addContest(std::span(&moving, 1), {}, figures);
  EXPECT_EQ(figures["rows"][0]["triangles"], 300);
}

TEST(Pages, CsvOfTheBenchTellsOfRasterisers) {
  const Json figures = rasterFigures();
  const auto rows = readCsv(benchCsv(figures));
  ASSERT_EQ(rows.size(), 4u);
  auto pipeline = rows[2], compute = rows[3];
  EXPECT_EQ(pipeline["raster"], "pipeline");
  EXPECT_EQ(pipeline["frame_vs_compute"], "6.0");
  EXPECT_EQ(pipeline["frame_vs_prefitted"], "0.9");
  EXPECT_EQ(compute["frame_vs_compute"], "");
  EXPECT_EQ(compute["frame_vs_prefitted"], "1.5");
  EXPECT_EQ(compute["share_of_people_computed"], "0.5");
  EXPECT_EQ(compute["poses_kept"], "90");
  EXPECT_EQ(compute["pose_bytes"], "4096");
  EXPECT_EQ(pipeline["picture_vs_compute_worst"], "0.00125");
  EXPECT_EQ(pipeline["picture_vs_compute_mean"], "0.0005");
  EXPECT_EQ(pipeline["picture_vs_compute_most"], "77");
  EXPECT_EQ(compute["picture_vs_compute_most"], "");
}

TEST(Pages, TheBenchsPageTellsOfRasterisers) {
  const std::string page = benchPage(rasterFigures());
  expectWholePage(page);
  EXPECT_THAT(page, HasSubstr("<h1>Techniques and rasterisers compared: s.yaml</h1>"));
  EXPECT_THAT(page, HasSubstr("3 frames of the scene (5 to 7) in turn"));
  EXPECT_EQ(count(page, "<svg "), 6u) << "times by rasteriser and by technique, invocations by rasteriser";
  EXPECT_THAT(page, HasSubstr("<td>tagged, compute</td><td>20</td><td>50.0 %</td><td>40.0 %</td><td>90</td>"
                              "<td>10</td><td>90.00 %</td><td>4,096</td>"));
  EXPECT_THAT(page,
              HasSubstr("<td>tagged, pipeline and compute</td><td>20</td><td>3</td><td>0.125 %</td><td>6</td>"
                        "<td>0.050 %</td><td>77</td>"));
  EXPECT_THAT(page, HasSubstr("class=\"mark fill-compute\""));
}

/// A picture of one row, with who shows in each pixel; black.
Picture blackRow(std::vector<std::uint32_t> people) {
  Picture picture;
  picture.color.width = static_cast<std::uint32_t>(people.size());
  picture.color.height = 1;
  picture.color.rgba.assign(4 * people.size(), 0);
  picture.character = std::move(people);
  return picture;
}

TEST(PictureError, IsOverThePixelsThatPeopleCover) {
  Picture a = blackRow({0, 1, 1, 0, 2}), b = blackRow({0, 1, 0, 0, 3});
  EXPECT_EQ(comparePictures(a, b).covered, 3u) << "in one picture or the other";
  EXPECT_EQ(comparePictures(a, b).differing, 0u);
  a.color.rgba[4 * 1 + 2] = 8;   // not seen
  b.color.rgba[4 * 2 + 0] = 9;   // at a silhouette
  a.color.rgba[4 * 3 + 1] = 40;  // a shadow beside people
  const PictureError error = comparePictures(a, b);
  EXPECT_EQ(error.differing, 2u);
  EXPECT_EQ(error.most, 40);
  EXPECT_DOUBLE_EQ(error.share(), 2.0 / 3.0);
  EXPECT_EQ(comparePictures(blackRow({0, 0}), blackRow({0, 0})).share(), 0.0);
}

TEST(Pages, TheBenchsPageShowsItsFigures) {
  const std::string page = benchPage(benchFigures());
  expectWholePage(page);
  EXPECT_THAT(page, HasSubstr("Measured on &lt;none&gt;, pictures of 64 x 32 pixels"));
  EXPECT_EQ(count(page, "<svg "), 2u);
  EXPECT_EQ(count(page, "class=\"mark "), 12u) << "two plots of three techniques at two numbers of people";
  EXPECT_EQ(count(page, "<polyline "), 6u);
  // 20 people, the longest time 40: the last mark of naive stands at the right, half way up, and one
  // place to the left of the next technique.
  EXPECT_THAT(page, HasSubstr("<circle cx=\"633.00\" cy=\"185.00\" r=\"4.5\" class=\"mark fill-naive\""));
  EXPECT_THAT(page, HasSubstr("Counts of one frame, the same in every round<"));
  Json varying = benchFigures();
  varying["rows"][1]["vertex_invocations_differ_by"] = 3;
  EXPECT_THAT(benchPage(varying), HasSubstr("the same in every round but for the vertex invocations<"));
  Json blind = benchFigures();
  for (Json& row : blind["rows"]) row["vertex_invocations"] = nullptr;
  EXPECT_THAT(benchPage(blind), HasSubstr("This device does not count vertex invocations."));
  EXPECT_THAT(benchTable(blind), HasSubstr(" - "));
}

}  // namespace
}  // namespace ensemble::cli
