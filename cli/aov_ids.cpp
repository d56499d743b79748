#include "cli/aov_ids.h"

#include <algorithm>

#include "renderer/scene_names.h"

namespace ensemble::cli {
namespace {

using Json = nlohmann::ordered_json;

Json describeOutfits(const std::string& key, const Wardrobe& wardrobe, std::uint32_t w,
                     const AovNumbers& numbers) {
  Json outfits = Json::array();
  for (std::size_t i = 0; i < wardrobe.items.size(); ++i) {
    const Item& item = wardrobe.items[ItemId(i)];
    Json garments = Json::array();
    for (const Garment& garment : item.garments) {
      for (std::size_t g = 0; g < numbers.garments.size(); ++g) {
        if (numbers.garment_wardrobes[g] == w && numbers.garments[g] == garment.name) {
          garments.push_back(numbers.first_garment + g);
        }
      }
    }
    outfits.push_back({{"wardrobe", key},
                       {"name", item.name},
                       {"file", wardrobe.item_files[ItemId(i)]},
                       {"garments", std::move(garments)}});
  }
  return outfits;
}

}  // namespace

std::string wardrobeName(const SceneWardrobe& wardrobe) {
  return wardrobe.key.empty() ? wardrobe.folder.string() : wardrobe.key;
}

Json describeCharacters(const Scene& scene, std::span<const Wardrobe> wardrobes, const Crowd& crowd) {
  Json characters = Json::array();
  for (std::size_t i = 0; i < crowd.characters.size(); ++i) {
    const Character& person = crowd.characters[i];
    const Wardrobe& wardrobe = wardrobes[person.wardrobe];
    const std::vector<Clip>& clips = wardrobe.body.clips;
    characters.push_back({{"id", i + 1},
                          {"number", i},
                          {"wardrobe", wardrobeName(scene.wardrobes[person.wardrobe])},
                          {"outfit", outfitName(wardrobe, crowd.combinations[person.combination].items)},
                          {"clip", clips.empty() ? "" : clips[person.clip].name},
                          {"tint_seed", person.tint_seed}});
  }
  return characters;
}

nlohmann::ordered_json aovIds(const Scene& scene, std::span<const Wardrobe> wardrobes, const Crowd& crowd,
                              const AovNumbers& numbers) {
  Json ids = {{"schema", "ensemble.ids/1"},
              {"characters", describeCharacters(scene, wardrobes, crowd)},
              {"regions", Json::array()},
              {"garments", Json::array()},
              {"outfits", Json::array()}};
  for (std::uint32_t w = 0; w < wardrobes.size(); ++w) {
    const std::string key = wardrobeName(scene.wardrobes[w]);
    for (std::size_t r = 0; r < wardrobes[w].body.regions.size(); ++r) {
      ids["regions"].push_back(
          {{"id", r + 1}, {"wardrobe", key}, {"name", wardrobes[w].body.regions[RegionId(r)].name}});
    }
    for (Json& outfit : describeOutfits(key, wardrobes[w], w, numbers))
      ids["outfits"].push_back(std::move(outfit));
  }
  for (std::size_t g = 0; g < numbers.garments.size(); ++g) {
    ids["garments"].push_back({{"id", numbers.first_garment + g},
                               {"wardrobe", wardrobeName(scene.wardrobes[numbers.garment_wardrobes[g]])},
                               {"name", numbers.garments[g]}});
  }
  ids["faces"] =
      "where region is an id in regions: 1 + the face's number in the wardrobe's template.glb, its "
      "regions counted on in order, and after them 1 + the faces of the body that only the outfit has; "
      "where it is an id in garments: 1 + the face's number in the garment, its parts counted on in "
      "order; 0: nobody";
  ids["depth"] = "metres along the view axis; 0: nothing there";
  ids["normal"] = "unit vector in the world; 0, 0, 0: nothing there";
  return ids;
}

}  // namespace ensemble::cli
