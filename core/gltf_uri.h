// Where a glTF file may point: into its own folder, or into itself. Private to gltf_file.h's
// implementation.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/gltf_json.h"

namespace ensemble {

/// The bytes of a `data:` URI, or nothing if it is another kind of URI.
/// @throws InputError if it is not base64 or decodes to more than `max_bytes`.
std::optional<std::vector<std::byte>> decodeDataUri(const JsonRef& uri, std::uint64_t max_bytes);

/// The file that a relative URI names, symbolic links resolved. @throws InputError for absolute
/// paths and URIs with a scheme, `..`, backslashes, escaped separators, a missing file, and whatever
/// lies outside `folder` once links are followed.
std::filesystem::path resolveUri(const JsonRef& uri, const std::filesystem::path& folder);

}  // namespace ensemble
