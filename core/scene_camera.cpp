// Where the camera of a scene is at a time.
#include <algorithm>
#include <cmath>

#include "core/scene.h"

namespace ensemble {
namespace {

Vec3 hermite(float u, float step, Vec3 from, Vec3 from_slope, Vec3 to, Vec3 to_slope) {
  const float a = u * u * (3.0f - 2.0f * u), b = u * (1.0f - u) * (1.0f - u), c = u * u * (u - 1.0f);
  return glm::mix(from, to, a) + step * (b * from_slope + c * to_slope);
}

}  // namespace

SceneCamera SceneCamera::at(double time_seconds) const {
  SceneCamera now = *this;
  now.keys.clear();
  now.orbit.reset();
  if (orbit) {
    const double turns = time_seconds / double{orbit->seconds};
    const auto angle = static_cast<float>(2.0 * double{kPi} * (turns - std::floor(turns)));
    const Vec3 arm = position - target;
    const float sine = std::sin(angle), cosine = std::cos(angle);
    now.position = target + Vec3(cosine * arm.x + sine * arm.z, arm.y, cosine * arm.z - sine * arm.x);
  }
  if (keys.empty()) return now;
  const auto take = [&](const SceneCameraKey& key) {
    now.position = key.position;
    now.target = key.target;
    now.fov_y = key.fov_y;
  };
  const auto seconds = static_cast<float>(time_seconds);
  if (seconds <= keys.front().seconds) take(keys.front());
  if (seconds >= keys.back().seconds) take(keys.back());
  if (seconds <= keys.front().seconds || seconds >= keys.back().seconds) return now;
  const auto next = static_cast<std::size_t>(
      std::upper_bound(keys.begin(), keys.end(), seconds,
                       [](float s, const SceneCameraKey& key) { return s < key.seconds; }) -
      keys.begin());
  const SceneCameraKey &from = keys[next - 1], &to = keys[next];
  const float step = to.seconds - from.seconds, u = (seconds - from.seconds) / step;
  const auto between = [&](auto value) {
    // The slope at a key is that of the line between its neighbours; at the ends the camera rests.
    const auto slope = [&](std::size_t i) {
      if (i == 0 || i + 1 == keys.size()) return Vec3(0.0f);
      return (value(keys[i + 1]) - value(keys[i - 1])) / (keys[i + 1].seconds - keys[i - 1].seconds);
    };
    if (!smooth) return glm::mix(value(from), value(to), u);
    return hermite(u, step, value(from), slope(next - 1), value(to), slope(next));
  };
  now.position = between([](const SceneCameraKey& key) { return key.position; });
  now.target = between([](const SceneCameraKey& key) { return key.target; });
  // A field of view must not swing beyond its keys.
  const float eased = smooth ? u * u * (3.0f - 2.0f * u) : u;
  now.fov_y = glm::mix(from.fov_y, to.fov_y, eased);
  return now;
}

}  // namespace ensemble
