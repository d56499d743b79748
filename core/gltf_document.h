// A glTF document as container: JSON, buffers and buffer views, all ranges checked. Private to
// gltf_file.h's implementation.
//
// Why not tinygltf: it reads an image's bytes from unchecked ranges before anyone can look, refuses
// Draco primitives unless it decompresses them itself (without limits), takes fractional indices for
// missing ones, and names no place in its errors. All that would have to be checked on the JSON
// before; what is left is reading the JSON. tinygltf serves as the oracle in
// tests/core/gltf_oracle_test.cpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/gltf_json.h"

namespace ensemble {

/// Bytes of a buffer view, inside its buffer.
struct GltfBufferView {
  std::span<const std::byte> bytes;
  std::uint32_t stride = 0;  ///< 0: elements follow each other without gaps
};

/// A parsed document. Its parts borrow from it and from the bytes it was made of.
class GltfDocument {
 public:
  /// A GLB. `bytes` must outlive the document. External files are looked up in `folder`; where there
  /// is none, they are refused. @throws InputError
  static GltfDocument fromGlb(std::span<const std::byte> bytes, const std::string& name,
                              const std::optional<std::filesystem::path>& folder,
                              const GltfReadOptions& options);

  /// A .gltf's text. @throws InputError
  static GltfDocument fromText(std::string_view text, const std::string& name,
                               const std::filesystem::path& folder, const GltfReadOptions& options);

  GltfDocument(GltfDocument&&) = delete;

  JsonRef root() const { return JsonRef(json_, "", file_); }
  const std::string& file() const { return file_; }
  const GltfReadOptions& options() const { return options_; }

  /// Entries of a top-level array ("nodes"), 0 if there is none.
  std::size_t count(std::string_view array) const;
  JsonRef item(std::string_view array, std::size_t index) const;  ///< @pre index < count(array)

  /// The index that a value is, into a top-level array. @throws InputError if it is out of range.
  std::uint32_t index(const JsonRef& value, std::string_view array) const;
  /// The same for a member; nothing if it is missing.
  std::optional<std::uint32_t> findIndex(const JsonRef& owner, std::string_view key,
                                         std::string_view array) const;

  const GltfBufferView& view(std::uint32_t index) const { return views_[index]; }

  /// A copy of a view's bytes, counted like what URIs name, since many images may share a view.
  std::vector<std::byte> copyView(const JsonRef& owner, std::uint32_t index) const;

  /// The bytes behind a `uri` (data or file). The sum of all that a document loads is limited.
  std::vector<std::byte> loadUri(const JsonRef& uri) const;

 private:
  GltfDocument(std::string name, std::optional<std::filesystem::path> folder, const GltfReadOptions& options,
               std::string_view text, std::span<const std::byte> bin);
  void checkVersion() const;
  void checkExtensions() const;
  void loadBuffers(std::span<const std::byte> bin);
  void checkViews();

  std::string file_;
  std::optional<std::filesystem::path> folder_;
  GltfReadOptions options_;
  nlohmann::json json_;
  std::vector<std::vector<std::byte>> loaded_;       ///< what URIs named
  std::vector<std::span<const std::byte>> buffers_;  ///< byteLength bytes each
  std::vector<GltfBufferView> views_;
  mutable std::uint64_t loaded_bytes_ = 0;
};

}  // namespace ensemble
