// What `ensemble bench` measured, as JSON, a table and CSV.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "cli/bench_contest.h"

namespace ensemble::cli {

/// Appends the rows of one contest to figures["rows"], and to figures["ratios"] those of every other
/// technique to naive (where it takes part, else to the first), and of tagged to pre-fitted. The ratio
/// of times is that of the medians, and beside it the median and quartiles of the rounds' own ratios.
/// @pre each row has the same number of rounds, one at least
void addContest(std::span<const ContestRow> rows, nlohmann::ordered_json& figures);

std::string benchTable(const nlohmann::ordered_json& figures);  ///< for people
/// A line for each row, with its ratios of frame times, empty where there is none.
std::string benchCsv(const nlohmann::ordered_json& figures);

}  // namespace ensemble::cli
