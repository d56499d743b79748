// What `ensemble people` dresses its people in: the recipes, as `ensemble author` would make them.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "assetpipe/built_in_recipes.h"
#include "assetpipe/make_people.h"
#include "assetpipe/segment.h"
#include "core/atomic_file.h"
#include "core/gltf_file.h"
#include "tests/assetpipe/person_config.h"
#include "tests/assetpipe/poke_through.h"

namespace ensemble {
namespace {

using testing::configOf;

class EachWardrobe : public ::testing::TestWithParam<Sex> {};
INSTANTIATE_TEST_SUITE_P(People, EachWardrobe, ::testing::Values(Sex::kFemale, Sex::kMale),
                         [](const auto& sex) { return sex.param == Sex::kFemale ? "Woman" : "Man"; });

std::size_t faceCount(const RawMeshNode& node) {
  std::size_t count = 0;
  for (const RawPrimitive& primitive : node.primitives) count += primitive.faces.size();
  return count;
}

TEST(BuiltInRecipes, AreThoseOfTheFolder) {
  const std::vector<std::string> names = builtInRecipeNames();
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator("outfits")) {
    if (entry.path().extension() != ".yaml") continue;
    files.insert(entry.path().stem());
    const Recipe from_file = loadRecipe(entry.path()), built_in = builtInRecipe(entry.path().stem());
    EXPECT_EQ(built_in.name, from_file.name);
    EXPECT_EQ(built_in.file, entry.path());
  }
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()), files);
}

/// Garments of their own on the complete body, bit for bit.
void expectOutfitsAreSound(const MadePerson& made) {
  for (const auto& [recipe, outfit] : made.outfits) {
    SCOPED_TRACE(recipe.name);
    EXPECT_TRUE(outfit.warnings.empty());
    EXPECT_TRUE(outfit.asset.clips.empty());
    ASSERT_EQ(outfit.asset.meshes.size(), recipe.garments.size() + 1);
    EXPECT_EQ(outfit.asset.meshes[0].primitives, made.body.meshes[0].primitives);
    std::size_t faces = 0;
    for (std::size_t i = 0; i < recipe.garments.size(); ++i) {
      EXPECT_EQ(outfit.asset.meshes[i + 1].name, "garment." + recipe.garments[i].name);
      faces += faceCount(outfit.asset.meshes[i + 1]);
    }
    EXPECT_GE(faces, 300u);
    EXPECT_LE(faces, 1500u);
    for (const RawMaterial& material : outfit.asset.materials) {
      if (material.name.starts_with("hair.")) {
        EXPECT_EQ(Vec3(material.base_color), configOf(Sex::kMale).colors.hair);
      }
    }
  }
}

/// The command `author` makes the same of the template's file.
void expectAuthorMakesTheSame(const MadePerson& made, const MadeOutfit& outfit) {
  const RawAsset asset = readGlb(writeGlb(made.body), "template.glb");
  std::vector<std::string> warnings;
  const TemplateBody body = segmentTemplate(asset, {}, "template.glb", warnings);
  const AuthorBody measured(body);
  EXPECT_EQ(writeGlb(authorOutfit(outfit.recipe, asset, measured).asset), writeGlb(outfit.outfit.asset));
}

/// What lies under cloth at rest must not stand out of it by more than 2 mm, and hardly ever in motion.
void expectSkinDoesNotPokeThrough(const MadePerson& made) {
  for (const auto& [recipe, outfit] : made.outfits) {
    if (recipe.slot == Slot::kHair || recipe.slot == Slot::kHead) continue;
    const testing::PokeThrough poke = testing::countPokeThrough(made.body, outfit.asset);
    EXPECT_EQ(poke.at_rest, 0u) << recipe.name;
    EXPECT_GT(poke.looked_at, 100u) << recipe.name;
    EXPECT_LE(poke.poking * 100, poke.looked_at)
        << recipe.name << ": " << poke.poking << " of " << poke.looked_at;
    ::testing::Test::RecordProperty(recipe.name,
                                    std::to_string(poke.poking) + "/" + std::to_string(poke.looked_at));
  }
}

/// One test for all three, because making a person takes seconds.
TEST_P(EachWardrobe, OutfitsAreSound) {
  PersonConfig config = configOf(GetParam());
  config.outfits = {"tshirt", "jeans", "shoes", "skirt", "jacket", "hair_short", "cap"};
  const MadePerson made = makePerson(config);
  ASSERT_EQ(made.outfits.size(), 7u);
  expectOutfitsAreSound(made);
  expectAuthorMakesTheSame(made, made.outfits[2]);
  expectSkinDoesNotPokeThrough(made);
}

}  // namespace
}  // namespace ensemble
