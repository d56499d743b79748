#include "renderer/view_people.h"

#include <algorithm>

#include "renderer/raster_people.h"

namespace ensemble {
namespace {

// `auto`: for fewer people the passes over the picture cost more than is gained. On lavapipe, two cores, 8
// people took as long by either, 32 people a quarter less by compute.
constexpr std::size_t kLeastPeople = 16;
// What a leg that is bent to hold its foot may lengthen an edge by, for somebody 1.7 m tall. Skirts hang
// between both legs.
constexpr float kBentLegs = 0.6f;  // metres

/// The longest edge of somebody in the pose that it is shown in.
float longestEdge(const PeopleAtTime& people, std::uint32_t p, bool is_exact) {
  const GpuCharacter& character = people.characters[p];
  const bool holds_feet = is_exact && (character.feet[0].w > 0.0f || character.feet[1].w > 0.0f);
  return people.longest_edges[p] + (holds_feet ? kBentLegs * people.heights[p] / 1.7f : 0.0f);
}

}  // namespace

bool ViewPeople::mayCompute(const View& view, std::size_t people, std::size_t most) {
  if (most == 0 || view.raster == RasterKind::kPipeline) return false;
  return view.raster != RasterKind::kAuto || people >= kLeastPeople;
}

void ViewPeople::choose(const View& view, const ShadowFit& fit, const KeyFrames& frames,
                        const PeopleAtTime& people, std::span<const std::uint32_t> seen,
                        std::span<const std::uint32_t> casters, std::size_t most) {
  const std::size_t count = people.characters.size();
  keys_.assign(count, kExact);
  is_computed_.assign(count, 0);
  casts_computed_.assign(count, 0);
  const bool computes = mayCompute(view, count, most);
  const SmallPeople small_people = smallPeopleOf(view);
  const auto set_key = [&](std::uint32_t p) {
    const vec4(&rows)[3] = people.characters[p].world_from_model;
    if (small_people.hold(Vec3(rows[0].w, rows[1].w, rows[2].w), people.heights[p]))
      keys_[p] = nearestKey(frames, people.characters[p]);
  };
  std::size_t computed = 0, cast = 0;
  for (const std::uint32_t p : seen) {
    set_key(p);
    is_computed_[p] = computes && computed < most &&
                      fitsCamera(view, people.bounds[p], longestEdge(people, p, keys_[p] == kExact));
    computed += is_computed_[p];
  }
  for (const std::uint32_t p : casters) {
    set_key(p);
    casts_computed_[p] = computes && cast < most && fitsSun(fit, longestEdge(people, p, keys_[p] == kExact));
    cast += casts_computed_[p];
  }
  if (view.raster != RasterKind::kAuto) return;
  if (computed < kLeastPeople) std::fill(is_computed_.begin(), is_computed_.end(), std::uint8_t{0});
  if (cast < kLeastPeople) std::fill(casts_computed_.begin(), casts_computed_.end(), std::uint8_t{0});
}

}  // namespace ensemble
