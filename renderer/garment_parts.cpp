#include "renderer/garment_parts.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>

namespace ensemble {
namespace {

/// Union-find with path halving.
class Components {
 public:
  explicit Components(std::size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), 0u);
  }
  std::uint32_t find(std::uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parents_;
};

struct Heights {
  float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
  std::uint32_t component = 0;
};

bool areOnePart(const Heights& a, const Heights& b) {
  const float shared = std::min(a.high, b.high) - std::max(a.low, b.low);
  return shared >= 0.5f * std::min(a.high - a.low, b.high - b.low);
}

}  // namespace

std::vector<std::uint8_t> garmentParts(std::span<const GpuVertex> vertices,
                                       std::span<const std::uint32_t> indices) {
  Components components(vertices.size());
  std::map<std::array<float, 3>, std::uint32_t> first_at;
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const float* p = vertices[i].position;
    components.join(i, first_at.try_emplace({p[0], p[1], p[2]}, i).first->second);
  }
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    components.join(indices[i], indices[i + 1]);
    components.join(indices[i], indices[i + 2]);
  }
  std::map<std::uint32_t, Heights> heights;
  for (const std::uint32_t index : indices) {
    Heights& of_component = heights[components.find(index)];
    of_component.low = std::min(of_component.low, vertices[index].position[1]);
    of_component.high = std::max(of_component.high, vertices[index].position[1]);
  }
  // Tallest first, so that small pieces join what they sit on and not one another.
  std::vector<Heights> tallest;
  for (auto& [component, of_component] : heights) {
    of_component.component = component;
    tallest.push_back(of_component);
  }
  std::stable_sort(tallest.begin(), tallest.end(),
                   [](const Heights& a, const Heights& b) { return a.high - a.low > b.high - b.low; });
  std::vector<std::vector<Heights>> parts;
  for (const Heights& piece : tallest) {
    const auto found = std::find_if(parts.begin(), parts.end(), [&](const std::vector<Heights>& part) {
      return areOnePart(part.front(), piece);
    });
    if (found != parts.end()) {
      found->push_back(piece);
    } else {
      parts.push_back({piece});
    }
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return a.front().high > b.front().high; });
  std::map<std::uint32_t, std::uint8_t> part_of;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const auto number = static_cast<std::uint8_t>(std::min<std::size_t>(part, kMostGarmentParts - 1));
    for (const Heights& piece : parts[part]) part_of[piece.component] = number;
  }
  std::vector<std::uint8_t> result(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const auto found = part_of.find(components.find(i));
    result[i] = found != part_of.end() ? found->second : std::uint8_t{0};
  }
  return result;
}

}  // namespace ensemble
