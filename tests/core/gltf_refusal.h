// The line with which the reader refuses a GLB.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/gltf_file.h"
#include "core/input_error.h"
#include "tests/core/glb_builder.h"

namespace ensemble::testing {

/// What readGlb says of the file "x.glb", or "accepted".
inline std::string refusal(const std::vector<std::byte>& bytes, const GltfReadOptions& options = {}) {
  try {
    readGlb(bytes, "x.glb", options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}
inline std::string refusal(const TestGlb& glb, const GltfReadOptions& options = {}) {
  return refusal(glb.bytes(), options);
}

}  // namespace ensemble::testing
