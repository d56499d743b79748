// A crowd from a table, and a table from a crowd (core/crowd_table.h).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/crowd_table.h"
#include "core/scene.h"
#include "core/wardrobe.h"
#include "renderer/crowd.h"
#include "renderer/scene_names.h"

namespace ensemble {

/// What the table of a scene's placement says of its people. What it has no column for is left to the
/// scene's weights.
class CrowdOfTable {
 public:
  /// Reads the table. Scene and wardrobes must outlive this.
  /// @throws InputError as loadCrowdTable; for a name that no wardrobe has, at its place in the table; for
  /// a key of the scene that a column of the table leaves nothing to; for fewer rows than crowd.count
  CrowdOfTable(const Scene& scene, std::span<const Wardrobe> wardrobes);

  std::uint32_t count() const { return static_cast<std::uint32_t>(table_.rows.size()); }
  bool tellsWardrobes() const { return table_.has(CrowdColumn::kWardrobe); }
  /// Somebody's, and whether anybody has it. @pre tellsWardrobes()
  std::uint32_t wardrobe(std::uint32_t person) const { return wardrobes_[person]; }
  bool uses(std::uint32_t wardrobe) const { return is_used_[wardrobe]; }
  bool tellsOutfits() const { return table_.has(CrowdColumn::kOutfit); }
  /// What somebody wears: an index into worn(). @pre tellsOutfits()
  std::uint32_t outfit(std::uint32_t person) const { return outfits_[person]; }
  /// What its people wear.
  const std::vector<WornCombination>& worn() const { return worn_; }

  /// Replaces in `character`, whose wardrobe and clothes are known, what else the table tells of somebody;
  /// the place is added to its position.
  void tell(std::uint32_t person, Character& character);

 private:
  void refuseKeys() const;
  void takeCount(const std::optional<std::uint32_t>& count);
  std::uint32_t wardrobeOf(const CrowdTableRow& row) const;
  std::uint32_t wornOf(std::uint32_t wardrobe, const CrowdTableName& outfit);
  std::uint32_t clipOf(std::uint32_t wardrobe, const CrowdTableName& clip);

  const Scene& scene_;
  SceneNames names_;  ///< places are in the table
  CrowdTable table_;
  std::vector<bool> is_used_;
  std::vector<WornCombination> worn_;
  std::vector<std::uint32_t> wardrobes_, outfits_;  ///< per row, where the table tells them
  /// By wardrobe and number of the name: indices into worn_, and clips.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> worn_of_name_, clip_of_name_;
};

struct DumpedCrowd {
  CrowdTable table;
  std::vector<std::string> warnings;  ///< for the log: what is not in the table
};

/// Everybody at time 0, in the order of their numbers, in every column. Who walks along a path or
/// trajectory is there as standing or walking on the spot; who is not there at time 0 is left out.
/// @throws InputError for names that a table can't tell from others
DumpedCrowd tableOfCrowd(const Scene& scene, std::span<const Wardrobe> wardrobes, const Crowd& crowd);

}  // namespace ensemble
