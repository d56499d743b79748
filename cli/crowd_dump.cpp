#include "cli/crowd_dump.h"

#include <cstdio>

#include "core/atomic_file.h"
#include "core/crowd_table.h"
#include "core/input_error.h"
#include "core/log.h"
#include "renderer/crowd_of_table.h"

namespace ensemble::cli {

void checkCrowdDump(const std::string& file, const std::string& json_file) {
  if (file.empty()) return;
  if (file == "-" && json_file == "-") {
    throw UsageError(
        {"", "--dump-crowd -", "--json writes to standard output, too", "give one of them a file's name"});
  }
  if (file == "-" || isCrowdTable(file)) return;
  throw UsageError({"", "--dump-crowd " + file, "a crowd table's name ends in .csv: a scene knows it by that",
                    "write --dump-crowd crowd.csv"});
}

void dumpCrowd(const std::string& file, const Scene& scene, std::span<const Wardrobe> wardrobes,
               const Crowd& crowd) {
  const DumpedCrowd dumped = tableOfCrowd(scene, wardrobes, crowd);
  for (const std::string& warning : dumped.warnings) logWarning("--dump-crowd: " + warning);
  const std::string text = crowdTableText(dumped.table);
  if (file == "-") {
    std::fwrite(text.data(), 1, text.size(), stdout);
  } else {
    writeFileAtomically(file, std::string_view(text));
  }
}

}  // namespace ensemble::cli
