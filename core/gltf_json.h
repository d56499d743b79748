// A checked look into a glTF document's JSON: every read says what it expects, and every error
// names the place by its JSON pointer. Private to gltf_file.h's implementation.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/gltf_file.h"

namespace ensemble {

/// What most damaged files need.
inline constexpr const char* kExportAgain = "export the file again";

/// Parses JSON text of a hostile origin: its size and depth are checked before the parser sees it, so
/// that neither parsing nor walking nor destroying it can exhaust the stack.
/// @throws InputError at "byte N" for malformed text, numbers beyond a double's range, invalid UTF-8.
nlohmann::json parseGltfJson(std::string_view text, const std::string& file, const GltfReadOptions& options);

/// A value of the document and where it stands. Borrows both the document and the file's name.
class JsonRef {
 public:
  JsonRef(const nlohmann::json& value, std::string pointer, const std::string& file)
      : value_(&value), pointer_(std::move(pointer)), file_(&file) {}

  const std::string& pointer() const { return pointer_; }
  const nlohmann::json& json() const { return *value_; }

  /// A member of this object, or nothing. @throws InputError if this is no object.
  std::optional<JsonRef> find(std::string_view key) const;
  JsonRef require(std::string_view key) const;  ///< @throws InputError if it is missing
  bool has(std::string_view key) const { return find(key).has_value(); }

  /// Elements of this array. @throws InputError if this is no array.
  std::size_t size() const;
  JsonRef operator[](std::size_t index) const;  ///< @pre index < size()

  bool boolean() const;
  double number() const;
  const std::string& string() const;
  /// A whole number from 0 to `max` (1.0 counts as whole; -1, 0.5 and 4e19 do not).
  std::uint64_t wholeNumber(std::uint64_t max) const;
  /// `count` numbers, e.g. a matrix.
  std::vector<double> numbers(std::size_t count) const;

  bool booleanOr(std::string_view key, bool fallback) const;
  double numberOr(std::string_view key, double fallback) const;
  std::string stringOr(std::string_view key, const std::string& fallback) const;
  std::uint64_t wholeNumberOr(std::string_view key, std::uint64_t fallback, std::uint64_t max) const;

  [[noreturn]] void fail(const std::string& what, const std::string& mend = kExportAgain) const;
  const std::string& file() const { return *file_; }

 private:
  const nlohmann::json* value_;
  std::string pointer_;
  const std::string* file_;
};

}  // namespace ensemble
