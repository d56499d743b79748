// A crowd as a table (CSV): who stands where in what. `render --dump-crowd` writes one, a scene's
// `placement: {kind: file}` reads one.
//
//   number,wardrobe,outfit,clip,phase,speed,x,y,z,heading,scale,tint
//   0,women,casual01,walk,0.25,1,-2.5,0,0.75,90,1.02,12345
//
// The first row names the columns, in any order; only x and z must be there. One person a row. A field
// that is empty means what a key left out means for a scene's `people`.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"
#include "core/source_mark.h"

namespace ensemble {

enum class CrowdColumn : std::uint8_t {
  kNumber,
  kWardrobe,
  kOutfit,
  kClip,
  kPhase,
  kSpeed,
  kX,
  kY,
  kZ,
  kHeading,
  kScale,
  kTint
};
/// Their names, in the order in which they are written.
inline constexpr std::array<std::string_view, 12> kCrowdColumns = {
    "number", "wardrobe", "outfit", "clip", "phase", "speed", "x", "y", "z", "heading", "scale", "tint"};

/// A name in a row, and where it stands in its file.
struct CrowdTableName {
  std::uint32_t name = 0;              ///< index into CrowdTable::names
  std::uint32_t line = 0, column = 0;  ///< 0 where the table comes from no file

  SourceMark mark() const { return {static_cast<int>(line), static_cast<int>(column), ""}; }
};

/// Somebody. What the table has no column for is as here.
struct CrowdTableRow {
  std::uint32_t number = 0;               ///< from 0; the character AOV holds one more
  CrowdTableName wardrobe, outfit, clip;  ///< empty: the only wardrobe, the bare body, the first clip
  float phase = 0.0f;                     ///< 0 .. 1
  float speed = 1.0f;
  Vec3 position{0.0f};   ///< metres
  float heading = 0.0f;  ///< radians; degrees in the file
  float scale = 1.0f;
  std::optional<std::uint32_t> tint;
};

struct CrowdTable {
  std::bitset<kCrowdColumns.size()> columns;
  std::vector<std::string> names{""};  ///< distinct; the first is empty
  std::vector<CrowdTableRow> rows;

  bool has(CrowdColumn column) const { return columns[static_cast<std::size_t>(column)]; }
};

/// What a file may cost and claim.
struct CrowdTableLimits {
  std::uint64_t max_bytes = 1ull << 29;
  std::size_t max_rows = 2'000'000;
  std::size_t max_names = 100'000;  ///< distinct ones
  std::size_t max_field_bytes = 4096;
};

/// Whether a placement's file is a crowd table: its name ends in .csv, in any case.
bool isCrowdTable(const std::filesystem::path& file);

/// @throws InputError FILE: LINE:COLUMN: ... for whatever is no such table or beyond `limits`,
/// SystemError if it can't be read. Whether names exist, CrowdOfTable finds out.
CrowdTable loadCrowdTable(const std::filesystem::path& file, const CrowdTableLimits& limits = {});

/// The same for text; `file` stands for it in messages.
CrowdTable parseCrowdTable(std::string_view text, const std::string& file,
                           const CrowdTableLimits& limits = {});

/// The table as a file has it. Numbers are the shortest that are read back as the same floats; a heading
/// is the shortest number of degrees that gives the same radians. @pre numbers are finite
std::string crowdTableText(const CrowdTable& table);

}  // namespace ensemble
