#include "core/yaml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "core/check.h"
#include "core/input_error.h"
#include "core/nearest_name.h"
#include "core/yaml_tree.h"

namespace ensemble {
namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// What a decimal number looks like: [-+] digits [. digits] [e [-+] digits], no leading zeros.
bool isDecimal(std::string_view text) {
  std::size_t at = 0;
  const auto skipDigits = [&] {
    const std::size_t first = at;
    while (at < text.size() && isDigit(text[at])) ++at;
    return at - first;
  };
  if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
  const bool begins_with_zero = at < text.size() && text[at] == '0';
  const std::size_t whole = skipDigits();
  if (begins_with_zero && whole > 1) return false;
  std::size_t fraction = 0;
  if (at < text.size() && text[at] == '.') {
    ++at;
    fraction = skipDigits();
  }
  if (whole + fraction == 0) return false;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    ++at;
    if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
    if (skipDigits() == 0) return false;
  }
  return at == text.size();
}

std::optional<double> parseDecimal(std::string_view text) {
  if (!isDecimal(text)) return std::nullopt;
  if (text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string joinPath(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : path + '.' + std::string(key);
}

void markAsOverride(YamlNode& node, int override_index) {
  node.line = node.column = 0;
  node.override_index = override_index;
  for (YamlNode& item : node.items) markAsOverride(item, override_index);
  for (YamlEntry& entry : node.entries) {
    entry.line = entry.column = 0;
    entry.override_index = override_index;
    markAsOverride(entry.value, override_index);
  }
}

/// Finds the place that a --set names, making maps on the way.
class OverridePath {
 public:
  OverridePath(std::string text, int override_index) : text_(std::move(text)), index_(override_index) {}

  YamlNode& resolve(YamlNode& root, std::string_view key_path) const {
    YamlNode* node = &root;
    std::string done;
    while (true) {
      if (node->kind == YamlKind::kNull) node->kind = YamlKind::kMap;
      // A key may hold dots itself: the whole rest of the path is tried first.
      YamlEntry* const whole = node->kind == YamlKind::kMap ? findEntry(*node, key_path) : nullptr;
      if (whole != nullptr) return whole->value;
      const std::size_t dot = key_path.find('.');
      const std::string_view key = key_path.substr(0, dot);
      if (key.empty()) fail("a part of the key is empty", "write --set KEY.KEY=VALUE");
      node = &child(*node, key, done);
      if (dot == std::string_view::npos) return *node;
      done = joinPath(done, key);
      key_path.remove_prefix(dot + 1);
    }
  }

  [[noreturn]] void fail(const std::string& what, const std::string& mend) const {
    throw UsageError({"", text_, what, mend});
  }

 private:
  static YamlEntry* findEntry(YamlNode& map, std::string_view key) {
    const auto entry = std::find_if(map.entries.begin(), map.entries.end(),
                                    [&](const YamlEntry& candidate) { return candidate.key == key; });
    return entry == map.entries.end() ? nullptr : &*entry;
  }

  YamlNode& child(YamlNode& parent, std::string_view key, const std::string& path) const {
    if (parent.kind == YamlKind::kMap) {
      if (YamlEntry* const entry = findEntry(parent, key)) return entry->value;
      parent.entries.push_back({std::string(key), 0, 0, index_, {}});
      parent.entries.back().value.override_index = index_;
      return parent.entries.back().value;
    }
    if (parent.kind == YamlKind::kScalar) {
      fail(fmt::format("{} is a single value, without keys", path.empty() ? "the file" : path),
           "set it as a whole");
    }
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), number);
    const bool is_number = error == std::errc() && end == key.data() + key.size();
    if (!is_number || number >= parent.items.size()) {
      fail(fmt::format("{} is a list, in which there is no {}", path, quotedName(key)),
           parent.items.empty() ? "set it as a whole"
                                : fmt::format("give a number from 0 to {}", parent.items.size() - 1));
    }
    return parent.items[number];
  }

  std::string text_;
  int index_;
};

}  // namespace

std::string NumberRange::toString() const {
  std::string text = "a number ";
  text += is_open_min ? fmt::format("greater than {}", min) : fmt::format("from {}", min);
  if (is_open_max) {
    text += fmt::format(" {} less than {}", is_open_min ? "and" : "up to but", max);
  } else {
    text += fmt::format(" {} {}", is_open_min ? "and at most" : "to", max);
  }
  if (*unit != '\0') text += fmt::format(" ({})", unit);
  return text;
}

void YamlValue::fail(const std::string& what, const std::string& mend) const {
  if (node_->override_index >= 0) {
    throw UsageError({"", document_->overrideText(node_->override_index), what, mend});
  }
  const bool placed = node_->line > 0;
  throw InputError({document_->file().string(),
                    placed ? fmt::format("{}:{}", node_->line, node_->column) : std::string(), what, mend});
}

std::string YamlValue::description() const {
  const std::string name = path_.empty() ? "the file" : path_;
  switch (node_->kind) {
    case YamlKind::kNull:
      return name + " has no value";
    case YamlKind::kSequence:
      return name + " is a list";
    case YamlKind::kMap:
      return name + " is a map";
    case YamlKind::kScalar:
      break;
  }
  return name + (node_->is_quoted ? " is the text " : " is ") + quotedName(node_->scalar);
}

SourceMark YamlValue::mark() const { return {node_->line, node_->column, path_}; }

bool YamlValue::isWord(std::string_view word) const {
  return isScalar() && !node_->is_quoted && node_->scalar == word;
}

bool YamlValue::isText(std::string_view text) const { return isScalar() && node_->scalar == text; }

double YamlValue::number(const NumberRange& range) const {
  std::optional<double> value;
  if (isScalar() && !node_->is_quoted) value = parseDecimal(node_->scalar);
  // In the precision it is kept in: what rounds to an open end is outside.
  const bool fits =
      value &&
      (range.is_open_min ? static_cast<float>(*value) > static_cast<float>(range.min)
                         : *value >= range.min) &&
      (range.is_open_max ? static_cast<float>(*value) < static_cast<float>(range.max) : *value <= range.max);
  if (!fits) fail(description(), "give " + range.toString());
  return *value;
}

std::uint64_t YamlValue::wholeNumber(std::uint64_t min, std::uint64_t max) const {
  std::uint64_t value = 0;
  bool fits = false;
  if (isScalar() && !node_->is_quoted && isDecimal(node_->scalar)) {
    const std::string& text = node_->scalar;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    fits = error == std::errc() && end == text.data() + text.size() && value >= min && value <= max;
  }
  if (!fits) fail(description(), fmt::format("give a whole number from {} to {}", min, max));
  return value;
}

bool YamlValue::boolean() const {
  if (isWord("true")) return true;
  if (isWord("false")) return false;
  fail(description(), "give true or false");
}

std::string YamlValue::text(const char* what) const {
  const bool has_control = std::any_of(node_->scalar.begin(), node_->scalar.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
  });
  if (!isScalar() || node_->scalar.empty() || has_control) fail(description(), fmt::format("give {}", what));
  return node_->scalar;
}

Vec3 YamlValue::vector(const NumberRange& range) const {
  if (!isSequence() || node_->items.size() != 3) {
    fail(isSequence() ? fmt::format("{} is a list of {}", path_, node_->items.size()) : description(),
         fmt::format("give [x, y, z], each {}", range.toString()));
  }
  const std::vector<YamlValue> parts = items("");
  return {parts[0].numberFloat(range), parts[1].numberFloat(range), parts[2].numberFloat(range)};
}

std::size_t YamlValue::word(std::span<const std::string_view> words) const {
  const auto found = std::find(words.begin(), words.end(), std::string_view(node_->scalar));
  if (isScalar() && found != words.end()) return static_cast<std::size_t>(found - words.begin());
  const std::vector<std::string> names(words.begin(), words.end());
  std::string mend = "give " + quotedList(names);
  if (isScalar() && names.size() > 2) {
    mend += fmt::format("; the nearest is {}", quotedName(nearestNames(node_->scalar, names).front()));
  }
  fail(description(), mend);
}

std::vector<YamlValue> YamlValue::items(const char* what) const {
  if (!isSequence()) fail(description(), fmt::format("give {}", what));
  std::vector<YamlValue> values;
  values.reserve(node_->items.size());
  for (std::size_t i = 0; i < node_->items.size(); ++i) {
    values.emplace_back(*document_, node_->items[i], joinPath(path_, std::to_string(i)));
  }
  return values;
}

std::vector<YamlValue> YamlValue::members(const char* what) const {
  if (!isMap()) fail(description(), fmt::format("give {}", what));
  std::vector<YamlValue> values;
  values.reserve(node_->entries.size());
  for (const YamlEntry& entry : node_->entries) {
    values.emplace_back(*document_, entry.value, joinPath(path_, entry.key));
    values.back().key_ = entry.key;
  }
  return values;
}

void YamlValue::expectKeys(std::span<const std::string_view> known) const {
  const std::vector<std::string> names(known.begin(), known.end());
  const std::string list = fmt::format("{}", fmt::join(names, ", "));
  if (!isMap()) fail(description(), fmt::format("give a map of the keys {}", list));
  for (const YamlEntry& entry : node_->entries) {
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    // The complaint is about the key, so it stands where the key stands.
    YamlNode key;
    key.line = entry.line;
    key.column = entry.column;
    key.override_index = entry.override_index;
    const YamlValue place(*document_, key, joinPath(path_, entry.key));
    place.fail(fmt::format("unknown key {}{}", quotedName(entry.key), path_.empty() ? "" : " in " + path_),
               fmt::format("write {} (known: {})", quotedName(nearestNames(entry.key, names).front()), list));
  }
}

std::optional<YamlValue> YamlValue::find(std::string_view key) const {
  ENSEMBLE_CHECK(isMap());
  for (const YamlEntry& entry : node_->entries) {
    if (entry.key != key) continue;
    YamlValue value(*document_, entry.value, joinPath(path_, key));
    value.key_ = entry.key;
    if (value.kind() == YamlKind::kNull) value.fail(value.description(), "give one, or remove the key");
    return value;
  }
  return std::nullopt;
}

YamlDocument YamlDocument::parse(const std::string& text, const std::filesystem::path& file,
                                 const YamlLimits& limits) {
  YamlDocument document;
  document.file_ = file;
  document.limits_ = limits;
  try {
    document.root_ = readYamlTree(text, limits);
  } catch (const YamlSyntaxError& error) {
    throw InputError({file.string(), error.line > 0 ? fmt::format("{}:{}", error.line, error.column) : "",
                      error.what, error.mend});
  }
  return document;
}

void YamlDocument::set(const std::string& key_path, const std::string& value) {
  const int index = static_cast<int>(overrides_.size());
  overrides_.push_back(fmt::format("--set {}={}", key_path, value));
  const OverridePath path(overrides_.back(), index);
  YamlNode node;
  try {
    node = readYamlTree(value, limits_);
  } catch (const YamlSyntaxError& error) {
    path.fail(error.what, error.mend);
  }
  markAsOverride(node, index);
  path.resolve(root_, key_path) = std::move(node);
}

}  // namespace ensemble
