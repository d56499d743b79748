#include "core/gltf_json.h"

#include <fmt/format.h>

#include <cmath>

#include "core/input_error.h"
#include "core/json_limits.h"

namespace ensemble {
namespace {

// "1.5", or the kind of the value where it is no number.
std::string describe(const nlohmann::json& value) {
  return value.is_number() ? value.dump() : std::string(value.type_name());
}

}  // namespace

nlohmann::json parseGltfJson(std::string_view text, const std::string& file, const GltfReadOptions& options) {
  if (text.size() > options.max_json_bytes) {
    throw InputError(
        {file, "",
         fmt::format("{} bytes of JSON are more than the {} allowed", text.size(), options.max_json_bytes),
         "split the file"});
  }
  checkJsonLimits(text, file, {options.max_json_depth, options.max_json_values}, "remove the nested extras");
  try {
    nlohmann::json document = nlohmann::json::parse(text);
    if (!document.is_object()) throw InputError({file, "", "the JSON is not an object", kExportAgain});
    return document;
  } catch (const nlohmann::json::parse_error& error) {
    throw InputError({file, fmt::format("byte {}", error.byte), "the JSON is malformed", kExportAgain});
  } catch (const nlohmann::json::exception&) {  // out_of_range: 1e999
    throw InputError({file, "", "the JSON has a number that is out of range", kExportAgain});
  }
}

std::optional<JsonRef> JsonRef::find(std::string_view key) const {
  if (!value_->is_object()) fail(fmt::format("expected an object, found {}", describe(*value_)));
  const auto member = value_->find(key);
  if (member == value_->end()) return std::nullopt;
  std::string pointer = pointer_ + "/";
  for (const char c : key) {  // RFC 6901
    if (c == '~') {
      pointer += "~0";
    } else if (c == '/') {
      pointer += "~1";
    } else {
      pointer += c;
    }
  }
  return JsonRef(*member, std::move(pointer), *file_);
}

JsonRef JsonRef::require(std::string_view key) const {
  if (auto member = find(key)) return *std::move(member);
  fail(fmt::format("'{}' is missing", key));
}

std::size_t JsonRef::size() const {
  if (!value_->is_array()) fail(fmt::format("expected an array, found {}", describe(*value_)));
  return value_->size();
}

JsonRef JsonRef::operator[](std::size_t index) const {
  return JsonRef((*value_)[index], fmt::format("{}/{}", pointer_, index), *file_);
}

bool JsonRef::boolean() const {
  if (!value_->is_boolean()) fail(fmt::format("expected true or false, found {}", describe(*value_)));
  return value_->get<bool>();
}

double JsonRef::number() const {
  if (!value_->is_number()) fail(fmt::format("expected a number, found {}", describe(*value_)));
  const double number = value_->get<double>();
  if (!std::isfinite(number)) fail("the number is not finite");
  return number;
}

const std::string& JsonRef::string() const {
  if (!value_->is_string()) fail(fmt::format("expected a string, found {}", describe(*value_)));
  return value_->get_ref<const std::string&>();
}

std::uint64_t JsonRef::wholeNumber(std::uint64_t max) const {
  std::uint64_t whole = 0;
  bool is_whole = false;
  if (value_->is_number_unsigned()) {
    whole = value_->get<std::uint64_t>();
    is_whole = true;
  } else if (value_->is_number_float()) {
    const double number = value_->get<double>();
    is_whole = number >= 0.0 && number <= 9007199254740992.0 && std::floor(number) == number;
    if (is_whole) whole = static_cast<std::uint64_t>(number);
  }
  if (!is_whole) fail(fmt::format("expected a whole number, found {}", describe(*value_)));
  if (whole > max) fail(fmt::format("{} is more than {}", whole, max));
  return whole;
}

std::vector<double> JsonRef::numbers(std::size_t count) const {
  if (size() != count) fail(fmt::format("expected {} numbers, found {}", count, size()));
  std::vector<double> result(count);
  for (std::size_t i = 0; i < count; ++i) result[i] = (*this)[i].number();
  return result;
}

bool JsonRef::booleanOr(std::string_view key, bool fallback) const {
  const auto member = find(key);
  return member ? member->boolean() : fallback;
}

double JsonRef::numberOr(std::string_view key, double fallback) const {
  const auto member = find(key);
  return member ? member->number() : fallback;
}

std::string JsonRef::stringOr(std::string_view key, const std::string& fallback) const {
  const auto member = find(key);
  return member ? member->string() : fallback;
}

std::uint64_t JsonRef::wholeNumberOr(std::string_view key, std::uint64_t fallback, std::uint64_t max) const {
  const auto member = find(key);
  return member ? member->wholeNumber(max) : fallback;
}

void JsonRef::fail(const std::string& what, const std::string& mend) const {
  constexpr std::size_t kMostShown = 400;  // a hostile name may have millions of characters
  const bool fits = what.size() <= kMostShown;
  throw InputError({*file_, pointer_, fits ? what : what.substr(0, kMostShown) + " ...", mend});
}

}  // namespace ensemble
