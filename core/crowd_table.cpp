#include "core/crowd_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>

#include "core/atomic_file.h"
#include "core/check.h"
#include "core/csv_file.h"
#include "core/input_error.h"
#include "core/nearest_name.h"
#include "core/yaml_reader.h"

namespace ensemble {
namespace {

// As for a scene's people, but for places and headings, where a dumped crowd may go beyond: two million
// people in a file 1 km apart, a heading within 180 degrees of another.
constexpr NumberRange kPositionRange{-1e10, 1e10, false, false, "metres"};
constexpr NumberRange kHeadingRange{-3600.0, 3600.0, false, false, "degrees"};
constexpr NumberRange kPhaseRange{0.0, 1.0};
constexpr NumberRange kSpeedRange{0.0, 100.0};
constexpr NumberRange kScaleRange{0.01, 100.0};

constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180.0;

/// In double, where a float of degrees would reach only some of the floats of radians.
float radiansOf(double heading_degrees) { return static_cast<float>(heading_degrees * kRadiansPerDegree); }

std::string_view nameOf(CrowdColumn column) { return kCrowdColumns[static_cast<std::size_t>(column)]; }

/// A decimal number and nothing else; NaN and infinity are none.
template <class Number>
std::optional<Number> parseNumber(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(number)) return std::nullopt;
  }
  return number;
}

class CrowdTableReader {
 public:
  CrowdTableReader(std::string_view text, const std::string& file, const CrowdTableLimits& limits)
      : csv_(text, file, {.max_field_bytes = limits.max_field_bytes}), file_(file), limits_(limits) {}

  CrowdTable read() {
    std::vector<CsvField> fields;
    if (!csv_.readRecord(fields)) {
      throw InputError({file_, "", "the crowd table is empty", "begin with a row of column names: x,z"});
    }
    readHeader(fields);
    while (csv_.readRecord(fields)) readRow(fields);
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(const CsvField& field, const std::string& what, const std::string& mend) const {
    csv_.fail(field.mark(), what, mend);
  }

  void readHeader(const std::vector<CsvField>& fields) {
    refuseOtherFormats(fields);
    for (const CsvField& field : fields) {
      const auto found = std::find(kCrowdColumns.begin(), kCrowdColumns.end(), field.text);
      if (found == kCrowdColumns.end()) {
        const std::vector<std::string> known(kCrowdColumns.begin(), kCrowdColumns.end());
        fail(field, fmt::format("unknown column {}", quotedName(field.text)),
             fmt::format("write {} (known: {})", quotedName(nearestNames(field.text, known).front()),
                         fmt::join(known, ", ")));
      }
      const auto index = static_cast<std::size_t>(found - kCrowdColumns.begin());
      if (table_.columns[index]) {
        fail(field, fmt::format("the column {} is here a second time", quotedName(field.text)),
             "remove one of them");
      }
      table_.columns.set(index);
      order_.push_back(static_cast<CrowdColumn>(index));
    }
    for (const CrowdColumn column : {CrowdColumn::kX, CrowdColumn::kZ}) {
      if (table_.has(column)) continue;
      fail(fields.front(), fmt::format("there is no column '{}'", nameOf(column)),
           "add it: x and z are where people stand, in metres");
    }
  }

  /// Messages for what spreadsheets and mistakes make of a table.
  void refuseOtherFormats(const std::vector<CsvField>& fields) const {
    const CsvField& first = fields.front();
    const std::size_t other = fields.size() == 1 ? first.text.find_first_of(";\t") : std::string::npos;
    if (other != std::string::npos) {
      fail(first, fmt::format("fields are parted by {} here", first.text[other] == ';' ? "';'" : "tabs"),
           "part them by commas, and write 0.5, not 0,5");
    }
    if (parseNumber<double>(first.text)) {
      fail(first, "the table begins with a number", "begin with a row of column names: x,z");
    }
  }

  void readRow(const std::vector<CsvField>& fields) {
    if (fields.size() != order_.size()) {
      fail(fields[std::min(fields.size() - 1, order_.size())],
           fmt::format("the row has {} fields, the first row names {} columns", fields.size(), order_.size()),
           "write a field for each column; it may be empty");
    }
    if (table_.rows.size() == limits_.max_rows) {
      fail(fields.front(), fmt::format("there are more than {} rows", limits_.max_rows), "split the file");
    }
    CrowdTableRow& row = table_.rows.emplace_back();
    row.number = static_cast<std::uint32_t>(table_.rows.size() - 1);
    for (std::size_t i = 0; i < fields.size(); ++i) readField(fields[i], order_[i], row);
  }

  void readField(const CsvField& field, CrowdColumn column, CrowdTableRow& row) {
    switch (column) {
      case CrowdColumn::kNumber:
        row.number = wholeNumber(field, column).value_or(row.number);
        break;
      case CrowdColumn::kWardrobe:
        row.wardrobe = name(field);
        break;
      case CrowdColumn::kOutfit:
        row.outfit = name(field);
        break;
      case CrowdColumn::kClip:
        row.clip = name(field);
        break;
      case CrowdColumn::kPhase:
        row.phase = number(field, column, kPhaseRange).value_or(row.phase);
        break;
      case CrowdColumn::kSpeed:
        row.speed = number(field, column, kSpeedRange).value_or(row.speed);
        break;
      case CrowdColumn::kX:
        row.position.x = coordinate(field, column);
        break;
      case CrowdColumn::kY:
        row.position.y = number(field, column, kPositionRange).value_or(0.0f);
        break;
      case CrowdColumn::kZ:
        row.position.z = coordinate(field, column);
        break;
      case CrowdColumn::kHeading:
        if (!field.text.empty()) row.heading = radiansOf(checkedNumber(field, column, kHeadingRange));
        break;
      case CrowdColumn::kScale:
        row.scale = number(field, column, kScaleRange).value_or(row.scale);
        break;
      case CrowdColumn::kTint:
        row.tint = wholeNumber(field, column);
        break;
    }
  }

  CrowdTableName name(const CsvField& field) {
    if (field.text.empty()) return {0, field.line, field.column};
    const auto found = index_of_name_.find(field.text);
    if (found != index_of_name_.end()) return {found->second, field.line, field.column};
    if (table_.names.size() > limits_.max_names) {
      fail(field, fmt::format("there are more than {} different names", limits_.max_names), "split the file");
    }
    const auto index = static_cast<std::uint32_t>(table_.names.size());
    table_.names.push_back(field.text);
    index_of_name_.emplace(field.text, index);
    return {index, field.line, field.column};
  }

  std::string description(const CsvField& field, CrowdColumn column) const {
    if (field.text.empty()) return fmt::format("{} is empty", nameOf(column));
    return fmt::format("{} is {}", nameOf(column), quotedName(field.text));
  }

  double checkedNumber(const CsvField& field, CrowdColumn column, const NumberRange& range) const {
    const std::optional<double> number = parseNumber<double>(field.text);
    if (!number || *number < range.min || *number > range.max) {
      fail(field, description(field, column), "give " + range.toString());
    }
    return *number;
  }

  /// Read as a float at once: by way of a double it would be rounded twice.
  std::optional<float> number(const CsvField& field, CrowdColumn column, const NumberRange& range) const {
    if (field.text.empty()) return std::nullopt;
    const double checked = checkedNumber(field, column, range);
    return parseNumber<float>(field.text).value_or(static_cast<float>(checked));  // a float's range is less
  }

  float coordinate(const CsvField& field, CrowdColumn column) const {
    const std::optional<float> metres = number(field, column, kPositionRange);
    if (!metres) fail(field, description(field, column), "give " + kPositionRange.toString());
    return *metres;
  }

  std::optional<std::uint32_t> wholeNumber(const CsvField& field, CrowdColumn column) const {
    if (field.text.empty()) return std::nullopt;
    const std::optional<std::uint32_t> number = parseNumber<std::uint32_t>(field.text);
    if (!number) {
      fail(field, description(field, column), fmt::format("give a whole number from 0 to {}", UINT32_MAX));
    }
    return number;
  }

  CsvReader csv_;
  const std::string& file_;
  const CrowdTableLimits& limits_;
  std::vector<CrowdColumn> order_;
  std::map<std::string, std::uint32_t, std::less<>> index_of_name_;  // a hash could be attacked
  CrowdTable table_;
};

template <class Number>
void appendNumber(std::string& text, Number number) {
  char buffer[64];
  const auto [end, error] = std::to_chars(std::begin(buffer), std::end(buffer), number);
  ENSEMBLE_CHECK(error == std::errc());
  text.append(buffer, end);
}

void appendHeading(std::string& text, float heading) {
  ENSEMBLE_CHECK(std::isfinite(heading));
  constexpr int kMostDigits = 17;  // tell any double
  const double exact_degrees = double{heading} / kRadiansPerDegree;
  for (int digits = 1; digits <= kMostDigits; ++digits) {
    char buffer[64];
    const auto [end, error] = std::to_chars(std::begin(buffer), std::end(buffer), exact_degrees,
                                            std::chars_format::general, digits);
    ENSEMBLE_CHECK(error == std::errc());
    const double rounded =
        parseNumber<double>({buffer, static_cast<std::size_t>(end - buffer)}).value_or(0.0);
    if (radiansOf(rounded) == heading) return appendNumber(text, rounded);
  }
  ENSEMBLE_CHECK(!"17 digits tell every heading");
}

void appendField(std::string& text, const CrowdTable& table, const CrowdTableRow& row, CrowdColumn column) {
  switch (column) {
    case CrowdColumn::kNumber:
      return appendNumber(text, row.number);
    case CrowdColumn::kWardrobe:
      return appendCsvField(text, table.names[row.wardrobe.name]);
    case CrowdColumn::kOutfit:
      return appendCsvField(text, table.names[row.outfit.name]);
    case CrowdColumn::kClip:
      return appendCsvField(text, table.names[row.clip.name]);
    case CrowdColumn::kPhase:
      return appendNumber(text, row.phase);
    case CrowdColumn::kSpeed:
      return appendNumber(text, row.speed);
    case CrowdColumn::kX:
      return appendNumber(text, row.position.x);
    case CrowdColumn::kY:
      return appendNumber(text, row.position.y);
    case CrowdColumn::kZ:
      return appendNumber(text, row.position.z);
    case CrowdColumn::kHeading:
      return appendHeading(text, row.heading);
    case CrowdColumn::kScale:
      return appendNumber(text, row.scale);
    case CrowdColumn::kTint:
      if (row.tint) appendNumber(text, *row.tint);
      return;
  }
}

}  // namespace

bool isCrowdTable(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return ending == ".csv";
}

CrowdTable parseCrowdTable(std::string_view text, const std::string& file, const CrowdTableLimits& limits) {
  return CrowdTableReader(text, file, limits).read();
}

CrowdTable loadCrowdTable(const std::filesystem::path& file, const CrowdTableLimits& limits) {
  const std::vector<std::byte> bytes = readFile(file, limits.max_bytes);
  return parseCrowdTable({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string(), limits);
}

std::string crowdTableText(const CrowdTable& table) {
  std::string text;
  const auto appendRow = [&](const auto& append) {
    bool is_first = true;
    for (std::size_t i = 0; i < kCrowdColumns.size(); ++i) {
      if (!table.columns[i]) continue;
      if (!is_first) text += ',';
      is_first = false;
      append(i);
    }
    text += '\n';
  };
  appendRow([&](std::size_t i) { text += kCrowdColumns[i]; });
  for (const CrowdTableRow& row : table.rows) {
    appendRow([&](std::size_t i) { appendField(text, table, row, static_cast<CrowdColumn>(i)); });
  }
  return text;
}

}  // namespace ensemble
