#include "core/gltf_weld.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>

namespace ensemble {
namespace {

// The same bits for values that are equal: -0 counts as 0.
std::uint64_t bitsOf(float value) { return std::bit_cast<std::uint32_t>(value + 0.0f); }

std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15ull;
  return hash ^ (hash >> 32);
}

struct PositionHash {
  std::size_t operator()(const Vec3& p) const {
    return mix(mix(mix(0x243f6a8885a308d3ull, bitsOf(p.x)), bitsOf(p.y)), bitsOf(p.z));
  }
};

std::size_t hashVertex(const RawVertex& v) {
  std::uint64_t hash = PositionHash()(v.position);
  for (int i = 0; i < 3; ++i) hash = mix(hash, bitsOf(v.normal[i]));
  for (int i = 0; i < 2; ++i) hash = mix(hash, bitsOf(v.uv[i]));
  for (std::size_t i = 0; i < 4; ++i) hash = mix(hash, bitsOf(v.skin.weights[i]) << 16 | v.skin.joints[i]);
  return hash;
}

float largestDifference(const SkinBinding& a, const SkinBinding& b) {
  float largest = 0.0f;
  for (const auto* from : {&a, &b}) {
    const SkinBinding& other = from == &a ? b : a;
    for (std::size_t i = 0; i < 4; ++i) {
      float weight = 0.0f;
      for (std::size_t k = 0; k < 4; ++k) {
        if (other.joints[k] == from->joints[i]) weight += other.weights[k];
      }
      float own = 0.0f;
      for (std::size_t k = 0; k < 4; ++k) {
        if (from->joints[k] == from->joints[i]) own += from->weights[k];
      }
      largest = std::max(largest, std::abs(own - weight));
    }
  }
  return largest;
}

// Whether the sum is as near to 1 as the Khronos validator asks (2e-7 for each influence).
bool isNormalized(const std::array<float, 4>& weights, std::size_t count) {
  double sum = 0.0;
  for (const float weight : weights) sum += static_cast<double>(weight);
  return std::abs(sum - 1.0) <= 1e-7 * static_cast<double>(count);
}

}  // namespace

SkinBinding settleBinding(std::span<const std::pair<std::uint32_t, float>> influences) {
  std::vector<std::pair<std::uint32_t, float>> merged;
  for (const auto& [joint, weight] : influences) {
    if (weight <= 0.0f) continue;
    const auto same = std::find_if(merged.begin(), merged.end(),
                                   [joint = joint](const auto& entry) { return entry.first == joint; });
    if (same == merged.end()) {
      merged.emplace_back(joint, weight);
    } else {
      same->second += weight;
    }
  }
  std::stable_sort(merged.begin(), merged.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  if (merged.size() > 4) merged.resize(4);
  SkinBinding binding;
  double sum = 0.0;
  for (std::size_t i = 0; i < merged.size(); ++i) {
    binding.joints[i] = static_cast<std::uint16_t>(merged[i].first);
    binding.weights[i] = merged[i].second;
    sum += static_cast<double>(merged[i].second);
  }
  if (merged.empty() || isNormalized(binding.weights, merged.size())) return binding;
  double rest = 1.0;
  for (std::size_t i = merged.size(); i-- > 1;) {
    binding.weights[i] = static_cast<float>(static_cast<double>(binding.weights[i]) / sum);
    rest -= static_cast<double>(binding.weights[i]);
  }
  binding.weights[0] = static_cast<float>(rest);  // the largest takes up what rounding left
  return binding;
}

void settleNormals(RawMeshNode& mesh) {
  bool any_missing = false;
  for (RawPrimitive& primitive : mesh.primitives) {
    for (RawVertex& vertex : primitive.vertices) {
      const float length = glm::length(vertex.normal);
      if (length < 1e-6f || !std::isfinite(length)) {
        vertex.normal = Vec3(0.0f);
        any_missing = true;
      } else if (std::abs(length - 1.0f) > 1e-3f) {
        vertex.normal /= length;
      }
    }
  }
  if (!any_missing) return;
  std::unordered_map<Vec3, glm::dvec3, PositionHash> sums;
  for (const RawPrimitive& primitive : mesh.primitives) {
    for (const Triangle& face : primitive.faces) {
      const glm::dvec3 a(primitive.vertices[face[0]].position);
      const glm::dvec3 b(primitive.vertices[face[1]].position);
      const glm::dvec3 c(primitive.vertices[face[2]].position);
      const glm::dvec3 twice_area = glm::cross(b - a, c - a);
      for (const std::uint32_t corner : face) sums[primitive.vertices[corner].position] += twice_area;
    }
  }
  for (RawPrimitive& primitive : mesh.primitives) {
    for (RawVertex& vertex : primitive.vertices) {
      if (vertex.normal != Vec3(0.0f)) continue;
      const auto sum = sums.find(vertex.position);
      const double length = sum == sums.end() ? 0.0 : glm::length(sum->second);
      vertex.normal = length > 0.0 ? Vec3(sum->second / length) : Vec3(0.0f, 1.0f, 0.0f);
    }
  }
}

std::size_t unifyWedges(RawMeshNode& mesh) {
  std::size_t different = 0;
  std::unordered_map<Vec3, SkinBinding, PositionHash> first_of;
  for (RawPrimitive& primitive : mesh.primitives) {
    for (RawVertex& vertex : primitive.vertices) {
      const auto [entry, is_new] = first_of.emplace(vertex.position, vertex.skin);
      if (is_new || entry->second == vertex.skin) continue;
      if (largestDifference(entry->second, vertex.skin) > 1e-3f) ++different;
      vertex.skin = entry->second;
    }
  }
  return different;
}

void weld(RawPrimitive& primitive) {
  constexpr std::uint32_t kUnused = 0xffffffffu;
  const std::vector<RawVertex>& vertices = primitive.vertices;
  const std::vector<std::uint32_t>& numbers = primitive.template_vertices;
  const std::vector<float>& hide = primitive.hide;
  const auto hash = [&](std::uint32_t i) {
    return mix(hashVertex(vertices[i]), numbers.empty() ? 0 : numbers[i]);
  };
  const auto equal = [&](std::uint32_t a, std::uint32_t b) {
    return vertices[a] == vertices[b] && (numbers.empty() || numbers[a] == numbers[b]) &&
           (hide.empty() || hide[a] == hide[b]);
  };
  std::vector<bool> used(vertices.size(), false);
  for (const Triangle& face : primitive.faces) {
    for (const std::uint32_t corner : face) used[corner] = true;
  }
  std::unordered_set<std::uint32_t, decltype(hash), decltype(equal)> distinct(vertices.size(), hash, equal);
  std::vector<std::uint32_t> first_of(vertices.size(), kUnused);
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    if (used[i]) first_of[i] = *distinct.insert(i).first;
  }
  std::vector<std::uint32_t> new_number(vertices.size(), kUnused);
  RawPrimitive welded{primitive.material, {}, std::move(primitive.faces), {}, {}, {}};
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    if (first_of[i] == kUnused) continue;
    if (first_of[i] == i) {
      new_number[i] = static_cast<std::uint32_t>(welded.vertices.size());
      welded.vertices.push_back(vertices[i]);
      if (!numbers.empty()) welded.template_vertices.push_back(numbers[i]);
      if (!hide.empty()) welded.hide.push_back(hide[i]);
    } else {
      new_number[i] = new_number[first_of[i]];
    }
  }
  for (Triangle& face : welded.faces) {
    for (std::uint32_t& corner : face) corner = new_number[corner];
  }
  primitive = std::move(welded);
}

}  // namespace ensemble
