// How a view shows its people: who is posed at a key frame, and who is drawn by which rasteriser. Decided by
// counts and sizes alone (design 8). No Vulkan.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene.h"
#include "renderer/key_frames.h"
#include "renderer/sphere.h"
#include "renderer/view_setup.h"

namespace ensemble {

/// What is known of the people of a crowd at a time, each array by number.
struct PeopleAtTime {
  std::span<const GpuCharacter> characters;
  std::span<const Sphere> bounds;
  std::span<const float> heights;        ///< metres, standing, scale included
  std::span<const float> longest_edges;  ///< metres, of their clothes and bodies, scale included
};

class ViewPeople {
 public:
  static constexpr std::uint32_t kExact = 0xffffffffu;

  /// Whether choose() may give anybody to the compute rasteriser. @param people of the crowd
  static bool mayCompute(const View& view, std::size_t people, std::size_t most);

  /// Decides for the people of a view.
  /// @param seen, casters numbers, ascending: those in the whole picture, those who may cast shadows into it
  /// @param most whom the compute rasteriser can draw at once; 0: nobody
  void choose(const View& view, const ShadowFit& fit, const KeyFrames& frames, const PeopleAtTime& people,
              std::span<const std::uint32_t> seen, std::span<const std::uint32_t> casters, std::size_t most);

  /// The key that somebody is posed at (KeyFrames), or kExact. @pre seen or a caster
  std::uint32_t key(std::uint32_t person) const { return keys_[person]; }
  bool isComputed(std::uint32_t person) const { return is_computed_[person] != 0; }
  /// Nobody is drawn by compute from now on; who casts shadows by it, and keys, stay.
  void computeNobody() { std::fill(is_computed_.begin(), is_computed_.end(), std::uint8_t{0}); }
  bool castsComputed(std::uint32_t person) const { return casts_computed_[person] != 0; }

 private:
  std::vector<std::uint32_t> keys_;
  std::vector<std::uint8_t> is_computed_, casts_computed_;
};

}  // namespace ensemble
