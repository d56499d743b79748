#include "core/gltf_uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace ensemble {
namespace {

constexpr const char* kPutBeside = "put the file beside the glTF file and name it by a relative path";

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

int base64Digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  if (c == '/') return 63;
  return -1;
}

// Undoes %XX once. What decodes to a separator or a control character was escaped to deceive.
std::string percentDecode(const JsonRef& ref) {
  const std::string& uri = ref.string();
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    char c = uri[i];
    if (c == '%') {
      const int high = i + 2 < uri.size() ? hexDigit(uri[i + 1]) : -1;
      const int low = high >= 0 ? hexDigit(uri[i + 2]) : -1;
      if (low < 0) ref.fail(fmt::format("'{}' has a '%' that no two hex digits follow", uri), kPutBeside);
      c = static_cast<char>(high * 16 + low);
      if (c == '/') ref.fail(fmt::format("'{}' hides a '/'", uri), kPutBeside);
      i += 2;
    }
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      ref.fail(fmt::format("'{}' has a control character", uri), kPutBeside);
    }
    if (c == '\\') ref.fail(fmt::format("'{}' has a backslash", uri), kPutBeside);
    path += c;
  }
  return path;
}

bool isBelow(const std::filesystem::path& file, const std::filesystem::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

}  // namespace

std::optional<std::vector<std::byte>> decodeDataUri(const JsonRef& ref, std::uint64_t max_bytes) {
  const std::string& uri = ref.string();
  if (!uri.starts_with("data:")) return std::nullopt;
  const std::size_t comma = uri.find(',');
  if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64")) {
    ref.fail("the data URI is not base64");
  }
  std::string_view text = std::string_view(uri).substr(comma + 1);
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() / 4 * 3 > max_bytes)
    ref.fail(fmt::format("the data URI has more than {} bytes", max_bytes));
  if (text.size() % 4 == 1) ref.fail("the data URI ends inside a base64 group");
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    const int digit = base64Digit(c);
    if (digit < 0) ref.fail("the data URI has a character that is not base64");
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    bit_count += 6;
    if (bit_count >= 8) {
      bit_count -= 8;
      bytes.push_back(static_cast<std::byte>(bits >> bit_count & 0xffu));
    }
  }
  return bytes;
}

std::filesystem::path resolveUri(const JsonRef& ref, const std::filesystem::path& folder) {
  const std::string& uri = ref.string();
  const std::string shown = uri.substr(0, 200);
  if (uri.find(':') < uri.find('/')) ref.fail(fmt::format("'{}' is not a relative path", shown), kPutBeside);
  const std::filesystem::path relative = percentDecode(ref);
  if (relative.empty()) ref.fail("the URI is empty", kPutBeside);
  if (relative.is_absolute()) ref.fail(fmt::format("'{}' is an absolute path", shown), kPutBeside);
  for (const auto& part : relative) {
    if (part == "..") ref.fail(fmt::format("'{}' leads out of the file's folder", shown), kPutBeside);
  }
  // Follow symbolic links in both, so that a link inside the folder can't lead out of it.
  std::error_code error;
  const auto base = std::filesystem::canonical(folder.empty() ? "." : folder, error);
  const auto file = std::filesystem::canonical(base / relative, error);
  if (error) ref.fail(fmt::format("'{}' can't be found", shown), kPutBeside);
  if (!isBelow(file, base)) ref.fail(fmt::format("'{}' leads out of the file's folder", shown), kPutBeside);
  if (!std::filesystem::is_regular_file(file, error)) {
    ref.fail(fmt::format("'{}' is not a regular file", shown), kPutBeside);
  }
  return file;
}

}  // namespace ensemble
