#include "cli/html_page.h"

#include <fmt/format.h>

namespace ensemble::cli {
namespace {

// Colours have one meaning each: three for the techniques, three for what is stored, three for the
// rasterisers. Techniques differ in the shape of their marks too, so that the plots read without colour.
constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --page: #fff; --ink: #1c2430; --faint: #667080; --grid: #dde2e9;
  --naive: #c2501c; --prefitted: #12815f; --tagged: #2463c8;
  --template: #5f6b7a; --garments: #a9b8cc; --fitted: #b8327f;
  --pipeline: #7a5c12; --compute: #6a3fc4; --auto: #197f9c; }
@media (prefers-color-scheme: dark) {
  :root { --page: #14181f; --ink: #e6eaf0; --faint: #98a3b3; --grid: #323a46;
    --naive: #f0926a; --prefitted: #45c79d; --tagged: #74a8f7;
    --template: #8a97a8; --garments: #55647a; --fitted: #ea72b3;
    --pipeline: #d3ae55; --compute: #b195f2; --auto: #5cc3df; } }
body { margin: 2rem auto; max-width: 56rem; padding: 0 1rem; background: var(--page); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.6rem; line-height: 1.2; } h2 { font-size: 1.2rem; margin-top: 2.2rem; }
figure { margin: 1rem 0; } svg { display: block; width: 100%; height: auto; }
figcaption, caption { color: var(--faint); font-size: .875rem; text-align: left; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .875rem; font-variant-numeric: tabular-nums; margin: 1rem 0; }
caption { padding-bottom: .3rem; }
th, td { padding: .2rem .7rem; border-bottom: 1px solid var(--grid); text-align: right; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
svg text { fill: var(--ink); font: 13px system-ui, sans-serif; }
svg .faint { fill: var(--faint); font-size: 12px; } svg .title { font-weight: 600; font-size: 15px; }
svg .grid { stroke: var(--grid); } svg .axis, svg .reference { stroke: var(--faint); }
svg .reference { stroke-dasharray: 2 4; }
svg .line { fill: none; stroke-width: 2; } svg .beyond { stroke-dasharray: 6 4; }
svg .spread { stroke-width: 1.5; } svg .bar { stroke: var(--page); stroke-width: 1; }
)";

constexpr const char* kColors[] = {"naive",  "prefitted", "tagged",  "template", "garments",
                                   "fitted", "pipeline",  "compute", "auto"};

std::string style() {
  std::string text = kStyle;
  for (const char* name : kColors) {
    text += fmt::format("svg .fill-{0} {{ fill: var(--{0}); }} svg .stroke-{0} {{ stroke: var(--{0}); }}\n",
                        name);
  }
  return text;
}

}  // namespace

std::string escapeXml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    }
  }
  return escaped;
}

std::string groupDigits(std::uint64_t value) {
  std::string text = std::to_string(value);
  for (std::size_t place = text.size(); place > 3;) text.insert(place -= 3, ",");
  return text;
}

HtmlPage::HtmlPage(std::string_view title) : title_(escapeXml(title)) {}

void HtmlPage::addHeading(std::string_view text) { body_ += "<h2>" + escapeXml(text) + "</h2>\n"; }

void HtmlPage::addParagraph(std::string_view text) { body_ += "<p>" + escapeXml(text) + "</p>\n"; }

void HtmlPage::addFigure(const std::string& svg, std::string_view caption) {
  body_ += "<figure>\n" + svg + "<figcaption>" + escapeXml(caption) + "</figcaption>\n</figure>\n";
}

void HtmlPage::addTable(std::string_view caption, const std::vector<std::string>& header,
                        const std::vector<std::vector<std::string>>& rows) {
  body_ += "<div class=\"scroll\"><table>\n<caption>" + escapeXml(caption) + "</caption>\n<thead><tr>";
  for (const std::string& cell : header) body_ += "<th scope=\"col\">" + escapeXml(cell) + "</th>";
  body_ += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : rows) {
    body_ += "<tr>";
    for (const std::string& cell : row) body_ += "<td>" + escapeXml(cell) + "</td>";
    body_ += "</tr>\n";
  }
  body_ += "</tbody>\n</table></div>\n";
}

std::string HtmlPage::text() const {
  return "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n"
         "<meta charset=\"utf-8\"/>\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
         "<title>" +
         title_ + "</title>\n<style>" + style() + "</style>\n</head>\n<body>\n<h1>" + title_ + "</h1>\n" +
         body_ + "</body>\n</html>\n";
}

}  // namespace ensemble::cli
