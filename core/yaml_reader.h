// Strict YAML: a small tree with positions, read through cursors that know their key path.
//
// yaml-cpp 0.7 only delivers the events; it never builds its own nodes, so that the limits hold
// while a file is being read. Refused: anchors, aliases, tags, several documents, duplicate keys,
// keys that are not plain text, control characters, whatever exceeds YamlLimits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math.h"
#include "core/source_mark.h"

namespace ensemble {

/// What a file may cost.
struct YamlLimits {
  std::size_t max_bytes = 4u << 20;
  std::size_t max_nodes = 500'000;  ///< keys, values, lists and maps
  std::size_t max_depth = 32;       ///< of lists and maps inside each other
};

enum class YamlKind : std::uint8_t { kNull, kScalar, kSequence, kMap };

struct YamlEntry;

/// A value of the tree. `override_index` says which --set it came from, -1: the file itself.
struct YamlNode {
  YamlKind kind = YamlKind::kNull;
  bool is_quoted = false;  ///< kScalar: written in quotes or as a block, so not a number
  int line = 0, column = 0;
  int override_index = -1;
  std::string scalar;
  std::vector<YamlNode> items;     ///< kSequence
  std::vector<YamlEntry> entries;  ///< kMap, in file order, keys distinct
};

struct YamlEntry {
  std::string key;
  int line = 0, column = 0;
  int override_index = -1;
  YamlNode value;
};

class YamlDocument;

/// Numbers that a key takes; ends included unless they are open.
struct NumberRange {
  double min = 0.0, max = 0.0;
  bool is_open_min = false, is_open_max = false;
  const char* unit = "";  ///< "metres", named in messages

  std::string toString() const;  ///< "a number from 0 to 1 (metres)"
};

/// A value and how one gets to it. Cheap to copy; the document must outlive it. Each reading
/// function throws (`fail`) unless the value is exactly of its kind and in range.
class YamlValue {
 public:
  YamlValue(const YamlDocument& document, const YamlNode& node, std::string path)
      : document_(&document), node_(&node), path_(std::move(path)) {}

  YamlKind kind() const { return node_->kind; }
  bool isScalar() const { return node_->kind == YamlKind::kScalar; }
  bool isSequence() const { return node_->kind == YamlKind::kSequence; }
  bool isMap() const { return node_->kind == YamlKind::kMap; }
  /// The bare word `word`, not in quotes.
  bool isWord(std::string_view word) const;
  /// The text `text`, bare or in quotes.
  bool isText(std::string_view text) const;
  const std::string& path() const { return path_; }
  SourceMark mark() const;

  /// Numbers are decimal: `-1.5e3`, `.5`, but not `010`, `0x10`, `1_000`, `.nan` or `"5"`.
  double number(const NumberRange& range) const;
  float numberFloat(const NumberRange& range) const { return static_cast<float>(number(range)); }
  /// Digits only.
  std::uint64_t wholeNumber(std::uint64_t min, std::uint64_t max) const;
  bool boolean() const;                         ///< true | false
  std::string text(const char* what) const;     ///< not empty; `what` for the message: "a folder"
  Vec3 vector(const NumberRange& range) const;  ///< [x, y, z]
  /// Index of the word in `words`; an unknown one is an error that names the nearest.
  std::size_t word(std::span<const std::string_view> words) const;
  std::size_t word(std::initializer_list<std::string_view> words) const {
    return word(std::span(words.begin(), words.size()));
  }

  /// Entries of a list. @throws unless it is one; `what` for the message: "a list of people".
  std::vector<YamlValue> items(const char* what) const;
  /// Entries of a map with free keys; key() is each one's own.
  std::vector<YamlValue> members(const char* what) const;
  std::string key() const { return key_; }

  /// Checks that this is a map with no other keys than `known`.
  void expectKeys(std::span<const std::string_view> known) const;
  void expectKeys(std::initializer_list<std::string_view> known) const {
    expectKeys(std::span(known.begin(), known.size()));
  }
  /// The value of a key, if it is there. @throws where the key has no value. @pre isMap()
  std::optional<YamlValue> find(std::string_view key) const;

  /// @throws InputError with line:column, or UsageError where the value came from --set.
  [[noreturn]] void fail(const std::string& what, const std::string& mend) const;
  /// "crowd.count is 'many'", or "is a list", for messages.
  std::string description() const;

 private:
  const YamlDocument* document_;
  const YamlNode* node_;
  std::string path_;
  std::string key_;
};

/// A file's one document and the overrides applied to it.
class YamlDocument {
 public:
  /// @param file stands for the text in messages. @throws InputError FILE: LINE:COLUMN: ...
  static YamlDocument parse(const std::string& text, const std::filesystem::path& file,
                            const YamlLimits& limits = {});

  /// Sets the value at `key_path` ("people.0.phase") to `value`, YAML itself; missing maps on the
  /// way are made, list entries exist already. @throws UsageError "--set KEY=VALUE: ...".
  void set(const std::string& key_path, const std::string& value);

  YamlValue root() const { return YamlValue(*this, root_, ""); }
  const std::filesystem::path& file() const { return file_; }
  /// "--set KEY=VALUE" of an override.
  const std::string& overrideText(int index) const { return overrides_[static_cast<std::size_t>(index)]; }

 private:
  YamlDocument() = default;

  std::filesystem::path file_;
  YamlLimits limits_;
  YamlNode root_;
  std::vector<std::string> overrides_;
};

}  // namespace ensemble
