// Fuzzes parseCrowdTable: hostile text is refused with a UserError or read; what was read is sound, and
// is read back from what is written of it.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/crowd_table.h"
#include "core/input_error.h"

namespace {

using ensemble::CrowdTable;
using ensemble::CrowdTableRow;

bool isSound(const CrowdTable& table, const CrowdTableRow& row) {
  for (int k = 0; k < 3; ++k) {
    if (!(std::abs(row.position[k]) <= 1e10f)) return false;
  }
  const std::size_t names = table.names.size();
  return row.wardrobe.name < names && row.outfit.name < names && row.clip.name < names && row.phase >= 0.0f &&
         row.phase <= 1.0f && row.speed >= 0.0f && row.speed <= 100.0f && row.scale >= 0.0099f &&
         row.scale <= 100.0f && std::abs(row.heading) <= 63.0f;
}

bool areSame(const CrowdTable& a, const CrowdTable& b) {
  if (a.columns != b.columns || a.names.size() != b.names.size() || a.rows.size() != b.rows.size())
    return false;
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    const CrowdTableRow &x = a.rows[i], &y = b.rows[i];
    if (x.number != y.number || a.names[x.wardrobe.name] != b.names[y.wardrobe.name] ||
        a.names[x.outfit.name] != b.names[y.outfit.name] || a.names[x.clip.name] != b.names[y.clip.name] ||
        x.phase != y.phase || x.speed != y.speed || x.position != y.position || x.heading != y.heading ||
        x.scale != y.scale || x.tint != y.tint) {
      return false;
    }
  }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ensemble::CrowdTableLimits limits;
  limits.max_rows = 1u << 10;
  limits.max_names = 1u << 8;
  CrowdTable table;
  try {
    table = ensemble::parseCrowdTable({reinterpret_cast<const char*>(data), size}, "fuzz.csv", limits);
  } catch (const ensemble::UserError&) {
    return -1;
  }
  if (table.rows.size() > limits.max_rows || table.names.size() > limits.max_names + 1) std::abort();
  for (const CrowdTableRow& row : table.rows) {
    if (!isSound(table, row)) std::abort();
  }
  // What can be read can be written and read again, whatever stands in names.
  if (!areSame(table, ensemble::parseCrowdTable(ensemble::crowdTableText(table), "again.csv", limits))) {
    std::abort();
  }
  return 0;
}
