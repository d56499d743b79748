// Items worn over one another (design 4), looked at from all sides while people move: recipes of ours on the
// people of ../shared/people, with what --auto-occlusion hides.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>

#include "assetpipe/author_outfit.h"
#include "assetpipe/find_layers.h"
#include "assetpipe/pipeline.h"
#include "assetpipe/ray_scene.h"
#include "assetpipe/segment.h"
#include "core/atomic_file.h"
#include "core/clip.h"
#include "core/gltf_file.h"
#include "core/layers.h"
#include "renderer/renderer.h"
#include "tests/pictures/all_sides.h"
#include "tests/support/garment_pixels.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

namespace fs = std::filesystem;

const fs::path kPeople = "../shared/people";  // tests run in the project's folder
constexpr std::uint32_t kSize = 256;
/// An outer item covers a face of an inner one if at rest it lies before the face's middle, or under it
/// within the tolerance. Such a face shows through where, were the inner item not worn, the outer one would
/// be seen at most so far behind, metres. A leg that steps out of a coat counts; trousers that hang over
/// boots, or a sleeve before a waistcoat, are not covered.
constexpr float kPokeDepth = 0.1f;

using Names = std::vector<std::string>;

/// What people wear; `scripts/test.sh --full` tries more.
std::vector<Names> combinations() {
  std::vector<Names> all = {{"trousers", "tshirt", "jacket", "hair_bob", "cap"},
                            {"trousers", "shirt", "coat", "boots", "hair_bob"},
                            {"skirt", "hoodie", "boots", "hair_bob", "cap"}};
  if (!testing::isFull()) return all;
  all.push_back({"jeans", "shirt", "jacket", "shoes", "hair_long", "hat"});
  all.push_back({"jeans", "jumper", "coat", "boots", "hair_short", "cap"});
  all.push_back({"leggings", "tshirt", "hivis_vest", "boots", "hair_ponytail", "hat"});
  all.push_back({"dress", "jacket", "shoes", "hair_long", "cap"});
  all.push_back({"suit", "coat", "shoes", "hair_short", "hat"});
  return all;
}

/// Counts of pixels over many pictures.
struct Tally {
  std::size_t people = 0;  ///< that show somebody
  std::size_t pokes = 0;   ///< in which an inner item shows through an outer one that covers it
  std::size_t before = 0;  ///< the same where items hide nothing of one another
  std::size_t hidden = 0;  ///< in which naive shows a garment's face that is hidden
  std::size_t holes = 0;   ///< of these: what shows instead is nothing, or lies deeper than the tolerance

  void add(const Tally& other) {
    people += other.people, pokes += other.pokes, before += other.before;
    hidden += other.hidden, holes += other.holes;
  }
  double percent(std::size_t count) const {
    return 100.0 * static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(people, 1));
  }
};

class LayerPictures : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!fs::exists(kPeople)) {
      GTEST_SKIP() << "LOUD: ../shared/people is absent, so no layers of clothes were looked at";
    }
    tagWardrobe(kPeople / GetParam() / "template.glb", authorAll(), folder_ / "w", autoOcclusion());
    plain_.push_back(loadWardrobe(folder_ / "w"));
    layered_ = plain_;
    std::vector<Combination> worn;
    for (const Names& names : combinations()) {
      Combination& items = worn.emplace_back();
      for (const std::string& name : names) items.push_back(itemOf(name));
    }
    const std::vector<ItemPair> pairs = layerPairs(layered_[0], worn);
    std::printf("%s: %zu pairs of %zu items\n", GetParam().c_str(), pairs.size(), layered_[0].items.size());
    findLayers(layered_[0], pairs);
  }

  static PipelineOptions autoOcclusion() {
    PipelineOptions options;
    options.tag.occlusion = Occlusion::kAuto;
    return options;
  }

  /// The recipes that are worn, on this person.
  std::vector<fs::path> authorAll() const {
    std::vector<std::string> names;
    for (const Names& worn : combinations()) names.insert(names.end(), worn.begin(), worn.end());
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    const RawAsset asset = readGltf(kPeople / GetParam() / "template.glb");
    std::vector<std::string> warnings;
    const TemplateBody body = segmentTemplate(asset, {}, "template.glb", warnings);
    const AuthorBody measured(body);
    std::vector<fs::path> files;
    for (const std::string& name : names) {
      files.push_back(folder_ / (name + ".glb"));
      const Recipe recipe = loadRecipe("outfits/" + name + ".yaml");
      writeFileAtomically(files.back(), writeGlb(authorOutfit(recipe, asset, measured).asset));
    }
    return files;
  }

  ItemId itemOf(const std::string& name) const {
    for (std::size_t i = 0; i < plain_[0].items.size(); ++i) {
      if (plain_[0].items[ItemId(i)].name == name) return ItemId(i);
    }
    ADD_FAILURE() << "no item " << name;
    return {};
  }

  bool isOver(ItemId outer, ItemId inner) const {
    const Item &out = plain_[0].items[outer], &in = plain_[0].items[inner];
    return isWornOver({out.slot, out.layer}, {in.slot, in.layer});
  }

  struct Shots {
    std::vector<Picture> pictures;
    std::vector<std::vector<std::optional<testing::GarmentPixel>>> garments;  ///< per picture and pixel
  };
  /// A time of a clip.
  struct Moment {
    std::string clip;
    double seconds = 0.0;
  };
  Shots draw(const std::vector<Wardrobe>& wardrobe, const Names& worn, const Moment& moment,
             Technique technique) {
    std::string outfit;
    for (const std::string& name : worn) outfit += (outfit.empty() ? "" : "+") + name;
    const Scene scene = testing::sceneOfOne(outfit, moment.clip, technique, kSize);
    renderer_.load(scene, wardrobe);
    const std::vector<View> sides = testing::viewsFromAllSides(scene);
    Shots shots;
    shots.pictures.resize(sides.size());
    renderer_.render(sides, moment.seconds, shots.pictures);
    for (const Picture& picture : shots.pictures) {
      auto& garments = shots.garments.emplace_back();
      for (std::size_t p = 0; p < picture.character.size(); ++p) {
        garments.push_back(testing::garmentAt(picture, p, renderer_, wardrobe));
      }
    }
    return shots;
  }

  /// Per face of an inner item, whether an outer one covers it.
  const std::vector<bool>& coveredFaces(ItemId inner, ItemId outer) {
    std::vector<bool>& covered = covered_[{inner, outer}];
    if (!covered.empty()) return covered;
    const RayDevice device;
    const RawSkeleton& skeleton = plain_[0].body.skeleton;
    const std::vector<Mat4> rest = skinningMatrices(skeleton, restPose(skeleton));
    const Item* around = &plain_[0].items[outer];
    const ViewedSurface surface = surfaceOf(plain_[0].items[inner]);
    const RayScene outer_alone(device, surfaceOf(*around), {}, rest),
        both(device, surface, {.body = nullptr, .items = std::span(&around, 1)}, rest);
    for (const Triangle& face : surface.faces) {
      std::array<Vec3, 3> at;
      for (std::size_t k = 0; k < 3; ++k) at[k] = skinPosition(surface.vertices[face[k]], rest);
      const Vec3 doubled = glm::cross(at[1] - at[0], at[2] - at[0]), middle = (at[0] + at[1] + at[2]) / 3.0f;
      const Vec3 normal = doubled / std::max(glm::length(doubled), 1.0e-12f);
      covered.push_back(!outer_alone.isSeen(middle, normal, 0xffffffffu) ||
                        both.hasClothUnder(middle, normal, HiddenFaceOptions().tolerance));
    }
    return covered;
  }

  /// Pixels of an inner item that show through an outer one.
  std::size_t countPokes(const Shots& shots, ItemId inner, const Shots& without) {
    std::size_t pokes = 0;
    for (std::size_t v = 0; v < shots.pictures.size(); ++v) {
      for (std::size_t p = 0; p < shots.garments[v].size(); ++p) {
        const auto &shown = shots.garments[v][p], &behind = without.garments[v][p];
        if (!shown || shown->item != inner || !behind || !isOver(behind->item, inner)) continue;
        const float depth = without.pictures[v].depth[p] - shots.pictures[v].depth[p];
        pokes += coveredFaces(inner, behind->item)[shown->face] && depth <= kPokeDepth ? 1 : 0;
      }
    }
    return pokes;
  }

  void countHoles(const Combination& worn, const Shots& naive, const Shots& tagged, Tally& tally) const {
    std::map<ItemId, HiddenGarmentFaces> hidden;
    for (const ItemId item : worn) hidden[item] = hiddenInCombination(layered_[0], worn, item);
    for (std::size_t v = 0; v < naive.pictures.size(); ++v) {
      for (std::size_t p = 0; p < naive.garments[v].size(); ++p) {
        const auto& shown = naive.garments[v][p];
        if (!shown || hidden[shown->item].empty() || hidden[shown->item][shown->face] == 0) continue;
        if (tagged.garments[v][p] && tagged.garments[v][p]->item == shown->item &&
            tagged.garments[v][p]->face == shown->face) {
          continue;  // of a piece that is drawn
        }
        ++tally.hidden;
        const bool is_empty = tagged.pictures[v].character[p] == 0;
        const float depth = tagged.pictures[v].depth[p] - naive.pictures[v].depth[p];
        tally.holes += is_empty || depth > HiddenFaceOptions().tolerance ? 1 : 0;
      }
    }
  }

  Tally look(const Names& names, const Moment& moment) {
    Combination worn;
    for (const std::string& name : names) worn.push_back(itemOf(name));
    std::sort(worn.begin(), worn.end());
    const Shots tagged = draw(layered_, names, moment, Technique::kTagged),
                naive = draw(layered_, names, moment, Technique::kNaive),
                before = draw(plain_, names, moment, Technique::kTagged);
    Tally tally;
    for (const Picture& picture : tagged.pictures) {
      tally.people += picture.character.size() - static_cast<std::size_t>(std::count(
                                                     picture.character.begin(), picture.character.end(), 0u));
    }
    countHoles(worn, naive, tagged, tally);
    for (const std::string& name : names) {
      const ItemId inner = itemOf(name);
      const bool is_inner = std::any_of(worn.begin(), worn.end(), [&](ItemId o) { return isOver(o, inner); });
      if (!is_inner) continue;
      Names others = names;
      std::erase(others, name);
      // A naive person may wear anything, also half of what dresses one.
      const Shots without = draw(plain_, others, moment, Technique::kNaive);
      tally.pokes += countPokes(tagged, inner, without);
      tally.before += countPokes(before, inner, without);
    }
    return tally;
  }

  testing::TemporaryFolder folder_;
  std::vector<Wardrobe> plain_, layered_;  ///< the same, without and with what items hide of one another
  std::map<ItemPair, std::vector<bool>> covered_;
  Renderer renderer_;
};

TEST_P(LayerPictures, InnerItemsHardlyShowThroughOuterOnes) {
  Tally all;
  double worst = 0.0;
  for (const Names& names : combinations()) {
    Tally one;
    for (const Clip& clip : plain_[0].body.clips) {
      const int steps = testing::isFull() ? static_cast<int>(clip.key_count - 1) / 8 : 3;
      for (int step = 0; step < steps; ++step) {  // between key frames, too
        one.add(look(names, {clip.name, (step + 0.3) / steps * double{clip.seconds}}));
      }
    }
    std::string list;
    for (const std::string& name : names) list += " " + name;
    std::printf(
        "%s%s: inner items show in %.3f %% of the pixels, before in %.3f %%; hidden faces in %.3f %%, "
        "%.4f %% are holes\n",
        GetParam().c_str(), list.c_str(), one.percent(one.pokes), one.percent(one.before),
        one.percent(one.hidden), one.percent(one.holes));
    worst = std::max(worst, one.percent(one.pokes));
    all.add(one);
  }
  std::printf("%s: %.3f %% (before %.3f %%) on average, %.3f %% at worst; %zu of %zu pixels are holes\n",
              GetParam().c_str(), all.percent(all.pokes), all.percent(all.before), worst, all.holes,
              all.people);
  ASSERT_GT(all.people, 100000u);
  EXPECT_GT(all.before, 100u) << "nothing poked through, so the comparison proves nothing";
  EXPECT_LT(all.pokes, all.before);
  EXPECT_LT(worst, 0.5);
  EXPECT_LT(all.percent(all.holes), 0.3) << "as for the body";
}

INSTANTIATE_TEST_SUITE_P(BothSexes, LayerPictures, ::testing::Values("female", "male"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace ensemble
