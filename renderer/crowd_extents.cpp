#include "renderer/crowd_extents.h"

#include <algorithm>

#include "renderer/key_frames.h"
#include "renderer/posed_extents.h"

namespace ensemble {
namespace {

/// Of what a combination shows, over all clips.
float longestEdge(const SubMeshLists& lists, std::uint32_t combination, const PosedExtents& extents) {
  float longest = 0.0f;
  for (const SubMeshId id : lists.shown[combination]) {
    const std::size_t mesh = lists.index_lists[lists.sub_meshes[id].list].mesh.value;
    for (std::size_t clip = 0; clip < extents.clip_count; ++clip)
      longest = std::max(longest, extents.longest_edges[mesh * extents.clip_count + clip]);
  }
  return longest;
}

/// How far kept vertices lie from where skinning puts them, at most: a step of the coarsest clip's box.
float roundingOf(const Animation& animation, std::uint32_t wardrobe) {
  const std::size_t end = wardrobe + 1 < animation.first_clip.size() ? animation.first_clip[wardrobe + 1]
                                                                     : animation.clips.size();
  float most = 0.0f;
  for (std::size_t clip = animation.first_clip[wardrobe]; clip < end; ++clip)
    most = std::max(most, keptBoxAround(animation.bounds[clip]).step);
  return most;
}

}  // namespace

CrowdExtents extentsOfCrowd(const Crowd& crowd, std::span<const SubMeshLists> lists,
                            std::span<const std::pair<std::uint32_t, std::uint32_t>> combinations,
                            const Animation& animation, std::uint32_t triangles_per_run) {
  CrowdExtents crowd_extents;
  std::vector<PosedExtents> of_wardrobes;
  for (std::uint32_t w = 0; w < lists.size(); ++w) {
    of_wardrobes.push_back(posedExtents(lists[w], animation, w, triangles_per_run));
    std::vector<std::uint32_t>& first_box = crowd_extents.first_box.emplace_back();
    const Vec3 rounding(roundingOf(animation, w));
    for (const std::vector<Box>& boxes : of_wardrobes.back().run_boxes) {
      first_box.push_back(static_cast<std::uint32_t>(crowd_extents.boxes.size()));
      for (const Box& box : boxes)
        crowd_extents.boxes.push_back({vec4(box.low - rounding, 0.0f), vec4(box.high + rounding, 0.0f)});
    }
  }
  std::vector<float> of_combinations;
  for (const auto& [w, combination] : combinations)
    of_combinations.push_back(longestEdge(lists[w], combination, of_wardrobes[w]));
  for (const Character& person : crowd.characters)
    crowd_extents.longest_edges.push_back(of_combinations[person.combination] * person.scale);
  return crowd_extents;
}

}  // namespace ensemble
