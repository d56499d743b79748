#include "assetpipe/outfit_properties.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "core/input_error.h"
#include "core/nearest_name.h"
#include "core/slots.h"

namespace ensemble {
namespace {

using Json = nlohmann::json;

class PropertyReader {
 public:
  PropertyReader(const RawAsset& outfit, const TemplateBody& body, const std::string& file)
      : body_(body), file_(file) {
    const Json extras = Json::parse(outfit.scene_extras_json, nullptr, false);
    own_ = extras.is_object() ? extras.value("ensemble", Json()) : Json();
    if (!own_.is_object()) own_ = Json::object();
  }

  OutfitProperties read(Occlusion occlusion) const {
    OutfitProperties properties;
    properties.occlusion = occlusion;
    readSlot(properties);
    readOcclusion(properties);
    properties.keep = readRegions("keep");
    properties.hide = readRegions("hide");
    for (const RegionId id : properties.keep) {
      const auto& hide = properties.hide;
      if (std::find(hide.begin(), hide.end(), id) == hide.end()) continue;
      fail("the custom properties 'keep' and 'hide' both name the region " +
               quotedName(body_.regions[id].name),
           "take it out of one of them");
    }
    return properties;
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& mend) const {
    throw InputError({file_, "/scenes", what, mend});
  }

  void readSlot(OutfitProperties& properties) const {
    const Json slot = own_.value("slot", Json()), layer = own_.value("layer", Json());
    if (!slot.is_null()) {
      const std::optional<Slot> known = parseSlot(slot.is_string() ? slot.get<std::string>() : "");
      if (!known) {
        fail(slot.is_string() ? "the custom property 'slot' is " + quotedName(slot.get<std::string>())
                              : "the custom property 'slot' is no text",
             "set " + slotNames());
      }
      properties.slot = *known;
    }
    if (!layer.is_null()) {
      if (!layer.is_number_integer() || layer < -1000 || layer > 1000) {
        fail("the custom property 'layer' is no whole number from -1000 to 1000", "set a number");
      }
      properties.layer = layer;
    }
  }

  void readOcclusion(OutfitProperties& properties) const {
    const Json kind = own_.value("occlusion", Json());
    if (kind.is_null()) return;
    if (kind == "authored") {
      properties.occlusion = Occlusion::kAuthored;
    } else if (kind == "auto") {
      properties.occlusion = Occlusion::kAuto;
    } else if (kind == "both") {
      properties.occlusion = Occlusion::kBoth;
    } else {
      fail("the custom property 'occlusion' is no kind of occlusion", "set authored, auto or both");
    }
  }

  /// Names with commas between them (Blender's custom properties hold no lists of texts), or a list.
  std::vector<RegionId> readRegions(const std::string& key) const {
    const Json value = own_.value(key, Json());
    std::vector<std::string> names, known;
    if (value.is_string()) {
      std::istringstream text(value.get<std::string>());
      for (std::string name; std::getline(text >> std::ws, name, ',');) names.push_back(name);
    } else if (value.is_array()) {
      for (const Json& name : value) names.push_back(name.is_string() ? name.get<std::string>() : "");
    } else if (!value.is_null()) {
      fail("the custom property '" + key + "' is no list of regions", "set names, such as hands,feet");
    }
    for (const Region& region : body_.regions) known.push_back(region.name);
    std::vector<RegionId> regions;
    for (const std::string& name : names) {
      const auto found = std::find(known.begin(), known.end(), name);
      if (found == known.end()) {
        fail("the custom property '" + key + "' names " + quotedName(name) +
                 ", which is no region of the template",
             "write " + quotedList(nearestNames(name, known)));
      }
      regions.emplace_back(static_cast<std::size_t>(found - known.begin()));
    }
    return regions;
  }

  const TemplateBody& body_;
  const std::string& file_;
  Json own_;
};

}  // namespace

OutfitProperties readOutfitProperties(const RawAsset& outfit, const TemplateBody& body, Occlusion occlusion,
                                      const std::string& file) {
  return PropertyReader(outfit, body, file).read(occlusion);
}

}  // namespace ensemble
