// A web page in one file: text, tables and SVG figures, readable without JavaScript, in light and
// dark, and well-formed XML as well, so that other programs can read it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ensemble::cli {

/// Text for XML: markup escaped, and `?` for control characters, which XML can't hold.
std::string escapeXml(std::string_view text);

/// "1234567" as "1,234,567".
std::string groupDigits(std::uint64_t value);

class HtmlPage {
 public:
  /// All texts are plain: the page escapes them.
  explicit HtmlPage(std::string_view title);

  void addHeading(std::string_view text);
  void addParagraph(std::string_view text);
  void addFigure(const std::string& svg, std::string_view caption);  ///< `svg` as svg_plot.h makes it
  /// The first column holds names, the others numbers.
  void addTable(std::string_view caption, const std::vector<std::string>& header,
                const std::vector<std::vector<std::string>>& rows);

  std::string text() const;  ///< the whole file

 private:
  std::string title_, body_;
};

}  // namespace ensemble::cli
