// A small glTF in the making, for tests: sound by default, to be broken at one place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ensemble::testing {

/// JSON and binary data of a GLB. Tests edit `json` freely.
class TestGlb {
 public:
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
  std::vector<std::byte> bin;

  /// Appends values as a bufferView (4-byte aligned) and returns its index.
  template <class T>
  int addView(const std::vector<T>& values) {
    while (bin.size() % 4 != 0) bin.push_back(std::byte{0});
    const std::size_t offset = bin.size();
    bin.resize(offset + values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(bin.data() + offset, values.data(), values.size() * sizeof(T));
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", values.size() * sizeof(T)}});
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  /// Appends an accessor with a view of its own and returns its index.
  template <class T>
  int addAccessor(const std::vector<T>& values, const std::string& type) {
    const int view = addView(values);
    json["accessors"].push_back({{"bufferView", view},
                                 {"componentType", componentType<T>()},
                                 {"count", values.size() / componentCount(type)},
                                 {"type", type}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  int add(const std::string& array, nlohmann::json entry) {
    json[array].push_back(std::move(entry));
    return static_cast<int>(json[array].size()) - 1;
  }

  /// The GLB. `buffers` is made to fit unless the test has set it.
  std::vector<std::byte> bytes() const {
    nlohmann::json document = json;
    std::vector<std::byte> padded = bin;
    while (padded.size() % 4 != 0) padded.push_back(std::byte{0});
    if (!document.contains("buffers") && !bin.empty()) document["buffers"] = {{{"byteLength", bin.size()}}};
    return fromText(document.dump(), padded);
  }

  /// A GLB of any text, well-formed or not.
  static std::vector<std::byte> fromText(std::string text, const std::vector<std::byte>& bin = {}) {
    while (text.size() % 4 != 0) text += ' ';
    std::vector<std::byte> file;
    const auto append = [&file](const void* data, std::size_t size) {
      const auto* first = static_cast<const std::byte*>(data);
      file.insert(file.end(), first, first + size);
    };
    const auto append_word = [&append](std::size_t value) {
      const auto word = static_cast<std::uint32_t>(value);
      append(&word, 4);
    };
    append("glTF", 4);
    append_word(2);
    append_word(20 + text.size() + (bin.empty() ? 0 : 8 + bin.size()));
    append_word(text.size());
    append("JSON", 4);
    append(text.data(), text.size());
    if (bin.empty()) return file;
    append_word(bin.size());
    append("BIN\0", 4);
    append(bin.data(), bin.size());
    return file;
  }

 private:
  template <class T>
  static int componentType() {
    if constexpr (std::is_same_v<T, std::int8_t>) return 5120;
    if constexpr (std::is_same_v<T, std::uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, std::int16_t>) return 5122;
    if constexpr (std::is_same_v<T, std::uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, std::uint32_t>) return 5125;
    return 5126;
  }
  static std::size_t componentCount(const std::string& type) {
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4") return 4;
    if (type == "MAT4") return 16;
    return 1;
  }
};

/// One triangle in the plane z = 0, normals +Z: node 0, mesh 0, accessors 0 POSITION, 1 NORMAL, 2 indices.
inline TestGlb triangleGlb() {
  TestGlb glb;
  const int position = glb.addAccessor<float>({0, 0, 0, 1, 0, 0, 0, 2, 0}, "VEC3");
  const int normal = glb.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int indices = glb.addAccessor<std::uint16_t>({0, 1, 2}, "SCALAR");
  glb.add("meshes",
          {{"primitives",
            {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}, {"indices", indices}}}}});
  glb.add("nodes", {{"name", "Tri"}, {"mesh", 0}});
  glb.json["scenes"] = {{{"nodes", {0}}}};
  return glb;
}

inline std::vector<float> translationMatrix(float x, float y, float z) {
  return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
}

/// The triangle bound to two joints: node 1 "hip" at (0, 1, 0), its child node 2 "knee" 1 m below;
/// accessors 3 JOINTS_0, 4 WEIGHTS_0, 5 inverse bind matrices. Bound at rest.
inline TestGlb skinnedGlb() {
  TestGlb glb = triangleGlb();
  auto& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = glb.addAccessor<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
  attributes["WEIGHTS_0"] = glb.addAccessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.75f, 0.25f, 0, 0}, "VEC4");
  std::vector<float> matrices = translationMatrix(0, -1, 0);
  const std::vector<float> second = translationMatrix(0, 0, 0);
  matrices.insert(matrices.end(), second.begin(), second.end());
  const int inverse_binds = glb.addAccessor<float>(matrices, "MAT4");
  glb.add("nodes", {{"name", "hip"}, {"translation", {0, 1, 0}}, {"children", {2}}});
  glb.add("nodes", {{"name", "knee"}, {"translation", {0, -1, 0}}});
  glb.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", inverse_binds}});
  glb.json["nodes"][0]["skin"] = 0;
  glb.json["scenes"] = {{{"nodes", {0, 1}}}};
  return glb;
}

/// Adds a clip "turn" with one rotation channel on a node: a quarter turn about Z in one second.
inline void addTurn(TestGlb& glb, int node, const std::string& interpolation = "LINEAR") {
  const float half = 0.70710678f;
  const int input = glb.addAccessor<float>({0, 1}, "SCALAR");
  const int output = glb.addAccessor<float>({0, 0, 0, 1, 0, 0, half, half}, "VEC4");
  nlohmann::json channel = {{"sampler", 0}, {"target", {{"node", node}, {"path", "rotation"}}}};
  nlohmann::json sampler = {{"input", input}, {"output", output}, {"interpolation", interpolation}};
  glb.add("animations", {{"name", "turn"},
                         {"channels", nlohmann::json::array({channel})},
                         {"samplers", nlohmann::json::array({sampler})}});
}

}  // namespace ensemble::testing
