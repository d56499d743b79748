#include "assetpipe/pipeline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "assetpipe/report.h"
#include "assetpipe/wardrobe_builder.h"
#include "core/atomic_file.h"
#include "core/collapse.h"
#include "core/gltf_file.h"
#include "core/input_error.h"
#include "core/sub_mesh_lists.h"
#include "tests/support/expect_error.h"
#include "tests/support/small_people.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// Source files on disk: template.glb, tunic.glb (half of the torso hidden), bare.glb (head hidden).
class Pipeline : public ::testing::Test {
 protected:
  Pipeline() {
    writeFileAtomically(folder_ / "template.glb", writeGlb(testing::tubeTemplate()));
    writeFileAtomically(folder_ / "tunic.glb", writeGlb(testing::tubeOutfit([](int region, int face) {
                          return region == 0 || (region == 1 && face % 2 == 0);
                        })));
    writeFileAtomically(folder_ / "bare.glb",
                        writeGlb(testing::tubeOutfit([](int region, int) { return region < 2; })));
  }

  Manifest tagBoth(const PipelineOptions& options = {}) {
    return tagWardrobe(folder_ / "template.glb", {folder_ / "tunic.glb", folder_ / "bare.glb"}, wardrobe_,
                       options);
  }

  std::vector<std::byte> manifestBytes() const { return readFile(wardrobe_ / "wardrobe.json"); }
  std::size_t outfitFileCount() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(wardrobe_ / "outfits"), {}));
  }

  testing::TemporaryFolder folder_;
  fs::path wardrobe_ = folder_ / "wardrobe";
};

TEST_F(Pipeline, WritesAWardrobeThatLoads) {
  tagBoth();
  const Wardrobe wardrobe = loadWardrobe(wardrobe_);
  ASSERT_EQ(wardrobe.items.size(), 2u);
  EXPECT_EQ(wardrobe.body.faces.size(), 192u);
  EXPECT_EQ(wardrobe.body.clips.size(), 1u);
  EXPECT_EQ(wardrobe.body.clips[0].key_count, 11u);
  const Item& tunic = wardrobe.items[ItemId(0)];
  EXPECT_EQ(tunic.name, "tunic");
  EXPECT_EQ(tunic.tags[RegionId(1)].visibility, Visibility::kPartial);
  for (std::uint32_t f = 0; f < 192; ++f)
    EXPECT_EQ(tunic.visible[FaceId(f)] != 0, f < 64 || (f < 128 && f % 2 == 0));
  EXPECT_EQ(tunic.garmentFaceCount(), 80u);
  EXPECT_GT(levelCount(wardrobe.body.collapses.raw()), 4u);
  EXPECT_GT(levelCount(tunic.garments[0].parts[0].collapses), 4u);
}

TEST_F(Pipeline, DracoKeepsNumbersAndClasses) {
  PipelineOptions options;
  options.draco = true;
  tagBoth(options);
  const Wardrobe packed = loadWardrobe(wardrobe_);
  tagBoth();
  const Wardrobe plain = loadWardrobe(wardrobe_);
  EXPECT_EQ(packed.geometry_hash, plain.geometry_hash);
  EXPECT_EQ(packed.body.faces, plain.body.faces);
  EXPECT_EQ(packed.body.collapses.raw(), plain.body.collapses.raw());
  ASSERT_EQ(packed.body.vertices.size(), plain.body.vertices.size());
  for (std::size_t v = 0; v < plain.body.vertices.size(); ++v) {
    EXPECT_NEAR(
        glm::distance(packed.body.vertices[VertexId(v)].position, plain.body.vertices[VertexId(v)].position),
        0.0f, 5e-5f);
  }
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(packed.items[ItemId(i)].visible, plain.items[ItemId(i)].visible);
}

TEST_F(Pipeline, TagShipAddGivesTheSameEntry) {
  const Manifest here = tagBoth();
  const fs::path there = folder_ / "elsewhere";
  tagWardrobe(folder_ / "template.glb", {}, there, {});
  // Ship the file under any name: its own name stands inside.
  fs::copy_file(wardrobe_ / here.outfits[0].file, folder_ / "shipped.glb");
  const Manifest added = addOutfits(there, {folder_ / "shipped.glb"}, {});
  Manifest expected = here;
  expected.outfits.resize(1);
  EXPECT_EQ(writeManifest(added), writeManifest(expected));
  EXPECT_EQ(readFile(there / here.outfits[0].file), readFile(wardrobe_ / here.outfits[0].file));
}

TEST_F(Pipeline, TagsOutfitsThatWereTaggedBefore) {
  const Manifest first = tagBoth();
  const fs::path again = folder_ / "again";
  const Manifest second =
      tagWardrobe(folder_ / "template.glb",
                  {wardrobe_ / first.outfits[0].file, wardrobe_ / first.outfits[1].file}, again, {});
  EXPECT_EQ(writeManifest(first), writeManifest(second));
}

TEST_F(Pipeline, RefusesAnOutfitTaggedForAnotherTemplate) {
  const Manifest here = tagBoth();
  RawAsset other = testing::tubeTemplate();
  other.meshes[0].primitives[0].vertices[0].position.y -= 0.001f;
  writeFileAtomically(folder_ / "other.glb", writeGlb(other));
  const fs::path there = folder_ / "there";
  tagWardrobe(folder_ / "other.glb", {}, there, {});
  const std::vector<std::byte> manifest = readFile(there / "wardrobe.json");
  const std::string shipped = (wardrobe_ / here.outfits[0].file).string();
  EXPECT_INPUT_ERROR(
      addOutfits(there, {shipped}, {}),
      shipped +
          ": /extras/ensemble/template/geometry_hash: this outfit was tagged for another template, "
          "its classes don't hold here; tag the raw outfit for this template");
  EXPECT_EQ(readFile(there / "wardrobe.json"), manifest);
}

TEST_F(Pipeline, AddsAndRemovesWithoutTouchingOthers) {
  const Manifest both = tagBoth();
  const auto tunic_time = fs::last_write_time(wardrobe_ / both.outfits[0].file);
  removeOutfits(wardrobe_, {"bare"});
  EXPECT_EQ(loadWardrobe(wardrobe_).items.size(), 1u);
  EXPECT_EQ(outfitFileCount(), 1u) << "the removed outfit's file stayed";
  addOutfits(wardrobe_, {folder_ / "bare.glb"}, {});
  EXPECT_EQ(writeManifest(both),
            std::string(reinterpret_cast<const char*>(manifestBytes().data()), manifestBytes().size()));
  EXPECT_EQ(fs::last_write_time(wardrobe_ / both.outfits[0].file), tunic_time);
}

TEST_F(Pipeline, NamesWhatStandsInTheWay) {
  tagBoth();
  const std::vector<std::byte> before = manifestBytes();
  EXPECT_INPUT_ERROR(addOutfits(wardrobe_, {folder_ / "tunic.glb"}, {}),
                     (folder_ / "tunic.glb").string() +
                         ": the wardrobe has an outfit 'tunic' already; remove that first "
                         "(`ensemble remove`), or rename the file");
  EXPECT_INPUT_ERROR(removeOutfits(wardrobe_, {"tunik"}),
                     wardrobe_.string() + ": the wardrobe has no outfit 'tunik'; did you mean 'tunic'?");
  EXPECT_INPUT_ERROR(
      removeOutfits(folder_ / "nowhere", {"tunic"}),
      (folder_ / "nowhere").string() +
          ": there is no wardrobe here (no wardrobe.json); give a folder made by `ensemble tag`");
  fs::create_directory(folder_ / "copies");
  fs::copy_file(folder_ / "tunic.glb", folder_ / "copies" / "tunic.glb");
  EXPECT_INPUT_ERROR(tagWardrobe(folder_ / "template.glb",
                                 {folder_ / "tunic.glb", folder_ / "copies" / "tunic.glb"}, wardrobe_, {}),
                     (folder_ / "copies" / "tunic.glb").string() +
                         ": two outfits are named 'tunic'; rename one of the files");
  EXPECT_EQ(manifestBytes(), before);
}

TEST_F(Pipeline, ReplacesAWardrobeByAnotherTemplate) {
  tagBoth();
  RawAsset other = testing::tubeTemplate();
  other.meshes[0].primitives[0].vertices[0].position.y -= 0.001f;
  writeFileAtomically(folder_ / "other.glb", writeGlb(other));
  const Manifest replaced = tagWardrobe(folder_ / "other.glb", {}, wardrobe_, {});
  EXPECT_THAT(replaced.body.file, ::testing::MatchesRegex("template\\.[0-9a-f]{12}\\.glb"));
  EXPECT_FALSE(fs::exists(wardrobe_ / "template.glb")) << "the old template was not cleared";
  EXPECT_EQ(outfitFileCount(), 0u);
  EXPECT_EQ(loadWardrobe(wardrobe_).items.size(), 0u);
}

TEST_F(Pipeline, ClearsWhatKilledWritersLeftAndNothingElse) {
  tagBoth();
  std::ofstream(wardrobe_ / "outfits" / ".x.123.tmp") << "half";
  std::ofstream(wardrobe_ / "outfits" / "old.0123456789ab.glb") << "old";
  std::ofstream(wardrobe_ / "notes.txt") << "mine";
  removeOutfits(wardrobe_, {"bare"});
  EXPECT_EQ(outfitFileCount(), 1u);
  EXPECT_TRUE(fs::exists(wardrobe_ / "notes.txt"));
}

TEST_F(Pipeline, LoadingTellsDamage) {
  const Manifest manifest = tagBoth();
  const fs::path outfit = wardrobe_ / manifest.outfits[0].file;
  std::vector<std::byte> bytes = readFile(outfit);
  bytes[bytes.size() / 2] ^= std::byte{1};
  writeFileAtomically(outfit, bytes);
  EXPECT_INPUT_ERROR(loadWardrobe(wardrobe_),
                     outfit.string() +
                         ": this file is damaged: its SHA-256 is not the one in wardrobe.json; copy the "
                         "whole folder again, or make it with `ensemble tag`");
  fs::remove(outfit);
  EXPECT_INPUT_ERROR(loadWardrobe(wardrobe_),
                     outfit.string() +
                         ": this file of the wardrobe is missing; copy the whole folder again, or make it "
                         "with `ensemble tag`");
}

TEST_F(Pipeline, ReportBytesAreOfWhatIsDrawn) {
  tagBoth();
  const Report report = makeReport(loadWardrobe(wardrobe_));
  EXPECT_EQ(report.faces[Technique::kNaive], 192u + 2 * 80u);
  EXPECT_EQ(report.faces[Technique::kPrefitted], 96u + 128u + 2 * 80u);
  EXPECT_EQ(report.faces[Technique::kTagged], 192u + 2 * 80u + 32u);
  // Tagged holds what naive holds and 6 bytes for each dedicated face.
  EXPECT_EQ(report.bytes[0], report.lower_bound_bytes);
  EXPECT_EQ(report.bytes[2], report.lower_bound_bytes + 32u * 6u);
}

TEST_F(Pipeline, AddsClipsOfTheSameSkeleton) {
  RawAsset moves = testing::tubeTemplate();
  moves.clips[0].name = "mixamo.com";
  // Blender turns bone axes: the same motion in other local frames.
  const Quat turn = glm::angleAxis(0.5f, Vec3(0, 1, 0));
  moves.skeleton.bones[1].rest.rotation = turn;
  moves.skeleton.joints[1].joint_from_model =
      Mat4(glm::mat4_cast(glm::inverse(turn))) * moves.skeleton.joints[1].joint_from_model;
  for (Vec4& value : moves.clips[0].channels[0].values) {
    const Quat turned = Quat(value.w, value.x, value.y, value.z) * turn;
    value = Vec4(turned.x, turned.y, turned.z, turned.w);
  }
  writeFileAtomically(folder_ / "dance.glb", writeGlb(moves));
  PipelineOptions options;
  options.clips = {folder_ / "dance.glb"};
  tagBoth(options);
  const TemplateBody body = loadWardrobe(wardrobe_).body;
  ASSERT_EQ(body.clips.size(), 2u);
  EXPECT_EQ(body.clips[1].name, "dance") << "a file's name, where a tool named the clip";
  for (std::uint32_t key = 0; key < body.clips[0].key_count; ++key) {
    const std::vector<Mat4> own = skinningMatrices(body.skeleton, body.clips[0].key(key));
    const std::vector<Mat4> other = skinningMatrices(body.skeleton, body.clips[1].key(key));
    for (std::size_t j = 0; j < own.size(); ++j) {
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(glm::distance(own[j][c], other[j][c]), 0.0f, 1e-4f);
    }
  }
}

}  // namespace
}  // namespace ensemble
