// `ensemble report --html`: the report as a web page.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ensemble::cli {

/// The page of a report's figures ("ensemble.report/1"), with what each plot shows as a table too; they have
/// the wardrobe's name besides ("wardrobe").
std::string reportPage(const nlohmann::ordered_json& figures);

/// The page of a scene's report ("ensemble.scene_report/1").
std::string sceneReportPage(const nlohmann::ordered_json& figures);

}  // namespace ensemble::cli
