// `ensemble bench --html`: the measurements as a web page.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ensemble::cli {

/// The page of a bench's figures ("ensemble.bench/1"), with what each plot shows as a table too.
std::string benchPage(const nlohmann::ordered_json& figures);

}  // namespace ensemble::cli
