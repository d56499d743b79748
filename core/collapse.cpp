#include "core/collapse.h"

#include <algorithm>

namespace ensemble {

std::uint32_t levelCount(std::span<const VertexCollapse> collapses) {
  std::uint32_t last = 0;
  for (const VertexCollapse& collapse : collapses) last = std::max<std::uint32_t>(last, collapse.level);
  return last + 1;
}

std::vector<std::uint32_t> verticesAtLevel(std::span<const VertexCollapse> collapses, std::uint32_t level) {
  std::vector<std::uint32_t> shown(collapses.size());
  for (std::uint32_t vertex = 0; vertex < shown.size(); ++vertex) {
    std::uint32_t at = vertex;
    while (!isShownAt(collapses[at], level) && collapses[at].target != at) at = collapses[at].target;
    shown[vertex] = isShownAt(collapses[at], level) ? at : kGone;
  }
  return shown;
}

bool areValid(std::span<const VertexCollapse> collapses) {
  for (std::size_t vertex = 0; vertex < collapses.size(); ++vertex) {
    const VertexCollapse& collapse = collapses[vertex];
    if (collapse.target >= collapses.size()) return false;
    if (collapse.level == 0 && collapse.target != vertex) return false;
    if (collapse.target != vertex && !isShownAt(collapses[collapse.target], collapse.level)) return false;
  }
  return true;
}

}  // namespace ensemble
