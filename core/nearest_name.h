// "Did you mean ...": the known names nearest to one that is unknown.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ensemble {

/// Edit distance: inserted, deleted, replaced characters and swapped neighbours count 1 each, a
/// change of case (ASCII) counts 0. Only the first 64 bytes of each are looked at.
std::size_t editDistance(std::string_view a, std::string_view b);

/// The `max_count` known names nearest to `name`, nearest first, equals in the order given. Beyond
/// the first, only names as near as half the length of `name` are listed. Empty if `known` is.
std::vector<std::string> nearestNames(std::string_view name, std::span<const std::string> known,
                                      std::size_t max_count = 1);

/// A name in quotes for a message, cut after 64 bytes: 'casual01'.
std::string quotedName(std::string_view name);

/// Names in quotes with a last word: "'a'", "'a' or 'b'", "'a', 'b' or 'c'". Empty for no names.
std::string quotedList(std::span<const std::string> names, std::string_view last_word = "or");

}  // namespace ensemble
