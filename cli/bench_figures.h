// What `ensemble bench` measured, as JSON, a table and CSV.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "cli/bench_contest.h"

namespace ensemble::cli {

/// Appends the rows of one contest to figures["rows"], and to figures["ratios"]
/// - for each rasteriser, those of every other technique to naive (where it takes part, else to the first),
/// and of
///   tagged to pre-fitted;
/// - for each technique, those of each rasteriser to those that come after it.
/// The ratio of times is that of the medians, and beside it the median and quartiles of the rounds' own
/// ratios. A row's counts are those of the middle one of its rounds; how far pictures are apart goes to
/// figures["picture_errors"].
/// @pre each row has the same number of rounds, one at least
void addContest(std::span<const ContestRow> rows, std::span<const ContestError> errors,
                nlohmann::ordered_json& figures);

/// What a ratio is of: "tagged / naive by compute", "tagged by pipeline / compute".
std::string nameOfRatio(const nlohmann::ordered_json& ratios);

std::string benchTable(const nlohmann::ordered_json& figures);  ///< for people
/// A line for each row, with its ratios of frame times and how far its pictures are from others', empty where
/// there is none.
std::string benchCsv(const nlohmann::ordered_json& figures);

}  // namespace ensemble::cli
