// yaml-cpp's parser called for its events alone: its node graph accepts duplicate keys and cyclic
// aliases, and has no limit.
#include "core/yaml_tree.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <sstream>
#include <string_view>

#include "core/nearest_name.h"

namespace ensemble {
namespace {

[[noreturn]] void refuse(const YAML::Mark& mark, std::string what, std::string mend) {
  const bool placed = !mark.is_null();
  throw YamlSyntaxError{placed ? mark.line + 1 : 0, placed ? mark.column + 1 : 0, std::move(what),
                        std::move(mend)};
}

class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(const YamlLimits& limits) : limits_(limits) {}

  YamlNode takeRoot() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++document_count_ > 1) {
      refuse(mark, "a second YAML document begins here", "remove the line '---' and what follows it");
    }
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(makeNode(YamlKind::kNull, mark, "", anchor));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { refuseAnchor(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    YamlNode node = makeNode(YamlKind::kScalar, mark, tag, anchor);
    node.is_quoted = tag == "!";
    node.scalar = value;
    add(std::move(node));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(makeNode(YamlKind::kSequence, mark, tag, anchor));
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(makeNode(YamlKind::kMap, mark, tag, anchor));
  }
  void OnMapEnd() override {
    refuseDuplicates(open_.back().node);
    close();
  }

 private:
  /// A list or map that is being read. In a map, keys and values take turns.
  struct Open {
    YamlNode node;
    bool awaits_value = false;
  };

  [[noreturn]] static void refuseAnchor(const YAML::Mark& mark) {
    refuse(mark, "anchors (&) and aliases (*) are not accepted", "write the value out");
  }

  YamlNode makeNode(YamlKind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    if (anchor != 0) refuseAnchor(mark);
    // "?" and "!" are what yaml-cpp says for plain and quoted values without a tag.
    if (!tag.empty() && tag != "?" && tag != "!") {
      refuse(mark, fmt::format("the tag {} is not accepted", quotedName(tag)), "remove it");
    }
    if (++node_count_ > limits_.max_nodes) {
      refuse(mark, fmt::format("more than {} values", limits_.max_nodes), "keep data per person out of YAML");
    }
    YamlNode node;
    node.kind = kind;
    node.line = mark.line + 1;
    node.column = mark.column + 1;
    return node;
  }

  void open(YamlNode node) {
    if (open_.size() == limits_.max_depth) {
      throw YamlSyntaxError{node.line, node.column,
                            fmt::format("lists and maps are nested more than {} deep", limits_.max_depth),
                            "nest them less"};
    }
    open_.push_back({std::move(node), false});
  }

  void close() {
    YamlNode node = std::move(open_.back().node);
    open_.pop_back();
    add(std::move(node));
  }

  void add(YamlNode node) {
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& parent = open_.back();
    if (parent.node.kind == YamlKind::kSequence) {
      parent.node.items.push_back(std::move(node));
    } else if (parent.awaits_value) {
      YamlEntry& entry = parent.node.entries.back();
      if (node.kind == YamlKind::kNull) {  // yaml-cpp places a missing value at what follows it
        node.line = entry.line;
        node.column = entry.column;
      }
      entry.value = std::move(node);
      parent.awaits_value = false;
    } else {
      if (node.kind != YamlKind::kScalar || node.scalar.empty()) {
        throw YamlSyntaxError{node.line, node.column, "a key must be a text", "write 'key: value'"};
      }
      parent.node.entries.push_back({std::move(node.scalar), node.line, node.column, -1, {}});
      parent.awaits_value = true;
    }
  }

  static void refuseDuplicates(const YamlNode& map) {
    std::vector<const YamlEntry*> sorted;
    sorted.reserve(map.entries.size());
    for (const YamlEntry& entry : map.entries) sorted.push_back(&entry);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const YamlEntry* a, const YamlEntry* b) { return a->key < b->key; });
    const auto twin =
        std::adjacent_find(sorted.begin(), sorted.end(),
                           [](const YamlEntry* a, const YamlEntry* b) { return a->key == b->key; });
    if (twin == sorted.end()) return;
    const YamlEntry &first = **twin, &second = **(twin + 1);
    throw YamlSyntaxError{second.line, second.column,
                          fmt::format("the key {} is here a second time (first at {}:{})",
                                      quotedName(second.key), first.line, first.column),
                          "remove one of them"};
  }

  const YamlLimits& limits_;
  std::size_t node_count_ = 0;
  int document_count_ = 0;
  YamlNode root_;
  std::vector<Open> open_;
};

/// Bytes of the UTF-8 character that begins at `at`; 0 where none does (RFC 3629, table of section 4).
std::size_t utf8Length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(at);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || at + length > text.size()) return 0;
  for (std::size_t i = at + 1; i < at + length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  const unsigned char second = byte(at + 1);
  const bool is_overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool is_surrogate = first == 0xed && second > 0x9f;
  const bool is_too_high = first == 0xf4 && second > 0x8f;
  return is_overlong || is_surrogate || is_too_high ? 0 : length;
}

/// yaml-cpp takes the byte 4 for the end of the input, and passes on what is no UTF-8, which would
/// break the JSON that names end up in.
void refuseStrangeBytes(std::string_view text) {
  int line = 1, column = 1;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    const auto byte = static_cast<unsigned char>(c);
    const bool is_control = (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7f;
    const std::size_t length = is_control ? 0 : utf8Length(text, at);
    if (length == 0) {
      throw YamlSyntaxError{line, column,
                            is_control ? fmt::format("a control character (byte {})", byte)
                                       : fmt::format("byte {} is not UTF-8 here", byte),
                            "save the file as plain UTF-8 text"};
    }
    column = c == '\n' ? 1 : column + 1;
    line += c == '\n' ? 1 : 0;
    at += length;
  }
}

}  // namespace

YamlNode readYamlTree(const std::string& text, const YamlLimits& limits) {
  if (text.size() > limits.max_bytes) {
    throw YamlSyntaxError{0, 0, fmt::format("the file has more than {} MiB", limits.max_bytes >> 20),
                          "keep data per person out of YAML"};
  }
  refuseStrangeBytes(text);
  TreeBuilder builder(limits);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& error) {
    refuse(error.mark, "not valid YAML: " + error.msg,
           "look at the indentation, colons, quotes and brackets here");
  }
  return builder.takeRoot();
}

}  // namespace ensemble
