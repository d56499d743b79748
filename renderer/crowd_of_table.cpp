#include "renderer/crowd_of_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/input_error.h"
#include "core/nearest_name.h"

namespace ensemble {

CrowdOfTable::CrowdOfTable(const Scene& scene, std::span<const Wardrobe> wardrobes)
    : scene_(scene),
      names_(scene, wardrobes, scene.crowd.placement.file.value),
      table_(loadCrowdTable(scene.crowd.placement.file.value)),
      is_used_(wardrobes.size(), false) {
  refuseKeys();
  takeCount(scene.crowd.count);
  if (tellsOutfits() && !tellsWardrobes() && wardrobes.size() > 1) {
    throw InputError(
        {scene.crowd.placement.file.value.string(), "1:1",
         fmt::format("the table tells outfits, but not of which of {} wardrobes", wardrobes.size()),
         "add a column 'wardrobe'"});
  }
  for (const CrowdTableRow& row : table_.rows) {
    const std::uint32_t wardrobe = tellsWardrobes() ? wardrobeOf(row) : 0;
    if (tellsWardrobes()) wardrobes_.push_back(wardrobe);
    is_used_[wardrobe] = true;
    if (tellsOutfits()) outfits_.push_back(wornOf(wardrobe, row.outfit));
  }
}

/// A key that chooses what a column tells would be without effect.
void CrowdOfTable::refuseKeys() const {
  const SceneCrowd& crowd = scene_.crowd;
  const auto refuse = [&](CrowdColumn column, const char* key, const SourceMark* mark) {
    if (mark == nullptr || !table_.has(column)) return;
    throw InputError(
        {scene_.file.string(), mark->toString(),
         fmt::format("{} chooses what a column of {} tells", key, crowd.placement.file.value.string()),
         fmt::format("remove it, or the column '{}'", kCrowdColumns[static_cast<std::size_t>(column)])});
  };
  const auto firstOf = [](const std::vector<WeightedName>& weights) {
    return weights.empty() ? nullptr : &weights.front().mark;
  };
  const ScenePlacement& placement = crowd.placement;
  refuse(CrowdColumn::kWardrobe, "crowd.wardrobes", firstOf(crowd.wardrobes));
  refuse(CrowdColumn::kOutfit, "crowd.outfits", firstOf(crowd.outfits));
  refuse(CrowdColumn::kOutfit, "crowd.wear", crowd.wear.empty() ? nullptr : &crowd.wear.front().mark);
  refuse(CrowdColumn::kClip, "crowd.clips", firstOf(crowd.clips));
  refuse(CrowdColumn::kScale, "crowd.scale", crowd.scale_mark.key_path.empty() ? nullptr : &crowd.scale_mark);
  refuse(CrowdColumn::kHeading, "crowd.placement.heading",
         placement.heading ? &placement.heading_mark : nullptr);
}

void CrowdOfTable::takeCount(const std::optional<std::uint32_t>& count) {
  if (!count) return;
  if (*count > table_.rows.size()) {
    throw InputError({scene_.file.string(), "crowd.count",
                      fmt::format("{} people, but {} has {}", *count,
                                  scene_.crowd.placement.file.value.string(), table_.rows.size()),
                      "lower crowd.count, or leave it out to have all"});
  }
  table_.rows.resize(*count);
}

std::uint32_t CrowdOfTable::wardrobeOf(const CrowdTableRow& row) const {
  return names_.wardrobeOrOnly({table_.names[row.wardrobe.name], row.wardrobe.mark()}, "the row", "write");
}

std::uint32_t CrowdOfTable::wornOf(std::uint32_t wardrobe, const CrowdTableName& outfit) {
  const auto [entry, is_new] =
      worn_of_name_.try_emplace({wardrobe, outfit.name}, static_cast<std::uint32_t>(worn_.size()));
  if (is_new) {
    worn_.push_back({wardrobe, names_.combinationOf(wardrobe, table_.names[outfit.name], outfit.mark())});
  }
  return entry->second;
}

std::uint32_t CrowdOfTable::clipOf(std::uint32_t wardrobe, const CrowdTableName& clip) {
  if (clip.name == 0) return 0;
  const auto [entry, is_new] = clip_of_name_.try_emplace({wardrobe, clip.name}, 0u);
  if (is_new) entry->second = names_.clipOf(wardrobe, table_.names[clip.name], clip.mark());
  return entry->second;
}

void CrowdOfTable::tell(std::uint32_t person, Character& character) {
  const CrowdTableRow& row = table_.rows[person];
  if (table_.has(CrowdColumn::kClip)) character.clip = clipOf(character.wardrobe, row.clip);
  if (table_.has(CrowdColumn::kPhase)) character.phase = row.phase;
  if (table_.has(CrowdColumn::kSpeed)) character.speed = row.speed;
  character.position += row.position;
  if (table_.has(CrowdColumn::kHeading)) character.heading = row.heading;
  if (table_.has(CrowdColumn::kScale)) character.scale = row.scale;
  if (row.tint) character.tint_seed = *row.tint;
}

namespace {

class CrowdDumper {
 public:
  CrowdDumper(const Scene& scene, std::span<const Wardrobe> wardrobes, const Crowd& crowd)
      : scene_(scene), wardrobes_(wardrobes), crowd_(crowd), names_(scene, wardrobes) {}

  DumpedCrowd dump() {
    dumped_.table.columns.set();
    addNames();
    for (std::uint32_t i = 0; i < crowd_.characters.size(); ++i) addRow(i);
    warn();
    return std::move(dumped_);
  }

 private:
  void addNames() {
    for (const SceneWardrobe& wardrobe : scene_.wardrobes) wardrobe_names_.push_back(intern(wardrobe.key));
    for (const WornCombination& worn : crowd_.combinations) {
      const std::string name = outfitName(wardrobes_[worn.wardrobe], worn.items);
      if (!isTold(worn, name)) refuse("outfit", name, worn.wardrobe);
      outfit_names_.push_back(intern(name));
    }
    for (std::uint32_t w = 0; w < wardrobes_.size(); ++w) {
      first_clip_.push_back(static_cast<std::uint32_t>(clip_names_.size()));
      for (const Clip& clip : wardrobes_[w].body.clips) clip_names_.push_back(intern(clip.name));
      if (wardrobes_[w].body.clips.empty()) clip_names_.push_back(0);
    }
  }

  /// A wardrobe's names are distinct, those of several items with '+' between them need not be.
  bool isTold(const WornCombination& worn, const std::string& name) const {
    if (name.size() > kMostBytes) return false;
    if (worn.items.size() < 2) return true;
    const PerItem<Item>& items = wardrobes_[worn.wardrobe].items;
    return std::none_of(worn.items.begin(), worn.items.end(),
                        [&](ItemId item) { return items[item].name.find('+') != std::string::npos; }) &&
           std::none_of(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
  }

  std::uint32_t clipName(std::uint32_t wardrobe, std::uint32_t clip) const {
    const std::uint32_t name = clip_names_[first_clip_[wardrobe] + clip];
    const std::string& text = dumped_.table.names[name];
    if ((text.empty() && clip != 0) || text.size() > kMostBytes) refuse("clip", text, wardrobe);
    return name;
  }

  [[noreturn]] void refuse(const char* kind, const std::string& name, std::uint32_t wardrobe) const {
    names_.fail({0, 0, "--dump-crowd"},
                fmt::format("the {} {} of {} can't be told by its name in a table", kind, quotedName(name),
                            names_.describe(wardrobe)),
                "rename it, an outfit to a name without '+'");
  }

  void addRow(std::uint32_t i) {
    const Character& person = crowd_.characters[i];
    CrowdTableRow row{.number = i,
                      .wardrobe = {wardrobe_names_[person.wardrobe]},
                      .outfit = {outfit_names_[person.combination]},
                      .clip = {},
                      .phase = person.phase,
                      .speed = person.speed,
                      .position = person.position,
                      .heading = person.heading,
                      .scale = person.scale,
                      .tint = person.tint_seed};
    std::uint32_t clip = person.clip;
    if (person.walker) {
      const CharacterPose pose = poseAt(crowd_, person, 0.0f, 0.0);
      if (!pose.exists) {
        ++absent_;
        return;
      }
      ++walking_;
      // What is blended of two clips is told as the one that weighs more.
      const bool stands = pose.idle_weight > 0.5f;
      clip = stands ? pose.idle_clip : pose.clip;
      row.phase = stands ? pose.idle_phase : pose.phase;
      row.heading = std::remainder(pose.heading, 2.0f * kPi);  // a path may have turned often
    }
    row.clip.name = clipName(person.wardrobe, clip);
    dumped_.table.rows.push_back(row);
  }

  void warn() {
    if (walking_ > 0) {
      dumped_.warnings.push_back(
          fmt::format("{} of {} people walk along paths or trajectories; the table has where they are at "
                      "time 0, not their ways",
                      walking_, crowd_.characters.size()));
    }
    if (absent_ > 0) {
      dumped_.warnings.push_back(fmt::format("{} of {} people are not there at time 0 and left out", absent_,
                                             crowd_.characters.size()));
    }
    if (dumped_.table.rows.size() > CrowdTableLimits().max_rows) {
      dumped_.warnings.push_back(fmt::format("the table has {} rows, more than the {} that are read",
                                             dumped_.table.rows.size(), CrowdTableLimits().max_rows));
    }
  }

  std::uint32_t intern(const std::string& name) {
    if (name.empty()) return 0;
    const auto next = static_cast<std::uint32_t>(dumped_.table.names.size());
    const auto [entry, is_new] = index_of_name_.try_emplace(name, next);
    if (is_new) dumped_.table.names.push_back(name);
    return entry->second;
  }

  static constexpr std::size_t kMostBytes = CrowdTableLimits().max_field_bytes;

  const Scene& scene_;
  std::span<const Wardrobe> wardrobes_;
  const Crowd& crowd_;
  SceneNames names_;
  std::map<std::string, std::uint32_t> index_of_name_;
  /// Names by wardrobe, by combination, and of all wardrobes' clips.
  std::vector<std::uint32_t> wardrobe_names_, outfit_names_, clip_names_, first_clip_;
  std::size_t walking_ = 0, absent_ = 0;
  DumpedCrowd dumped_;
};

}  // namespace

DumpedCrowd tableOfCrowd(const Scene& scene, std::span<const Wardrobe> wardrobes, const Crowd& crowd) {
  return CrowdDumper(scene, wardrobes, crowd).dump();
}

}  // namespace ensemble
