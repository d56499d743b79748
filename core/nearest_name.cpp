#include "core/nearest_name.h"

#include <algorithm>
#include <array>

namespace ensemble {
namespace {

constexpr std::size_t kMaxLength = 64;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

}  // namespace

// Optimal string alignment: Levenshtein's distance with swaps of neighbours, three rows at a time.
std::size_t editDistance(std::string_view a, std::string_view b) {
  a = a.substr(0, kMaxLength);
  b = b.substr(0, kMaxLength);
  std::array<std::array<std::size_t, kMaxLength + 1>, 3> rows{};
  for (std::size_t j = 0; j <= b.size(); ++j) rows[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    const auto& before_last = rows[(i + 1) % 3];
    const auto& last = rows[(i - 1) % 3];
    auto& row = rows[i % 3];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      const bool swapped =
          i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return rows[a.size() % 3][b.size()];
}

std::vector<std::string> nearestNames(std::string_view name, std::span<const std::string> known,
                                      std::size_t max_count) {
  struct Candidate {
    std::size_t distance, index;
  };
  std::vector<Candidate> candidates;
  candidates.reserve(known.size());
  for (std::size_t i = 0; i < known.size(); ++i) candidates.push_back({editDistance(name, known[i]), i});
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });

  const std::size_t near = std::min(name.size(), kMaxLength) / 2;
  std::vector<std::string> nearest;
  for (const Candidate& candidate : candidates) {
    if (nearest.size() == max_count || (!nearest.empty() && candidate.distance > near)) break;
    nearest.push_back(known[candidate.index]);
  }
  return nearest;
}

std::string quotedName(std::string_view name) {
  std::string text = "'";
  text += name.substr(0, kMaxLength);
  if (name.size() > kMaxLength) text += "...";
  return text + "'";
}

std::string quotedList(std::span<const std::string> names, std::string_view last_word) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0 && i + 1 == names.size()) {
      text += ' ';
      text += last_word;
      text += ' ';
    } else if (i > 0) {
      text += ", ";
    }
    text += quotedName(names[i]);
  }
  return text;
}

}  // namespace ensemble
