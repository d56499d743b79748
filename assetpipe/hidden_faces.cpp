#include "assetpipe/hidden_faces.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "assetpipe/ray_scene.h"
#include "core/clip.h"

namespace ensemble {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Generalised golden ratios (Roberts 2018): sequences that fill an interval and a square evenly.
constexpr double kGolden = 0.61803398874989485, kPlastic = 0.75487766624669276,
                 kPlastic2 = 0.56984029099805327;

double fraction(double x) { return x - std::floor(x); }

std::vector<Mat4> matricesAt(const TemplateBody& body, const ViewedPose& pose) {
  if (body.clips.empty()) return skinningMatrices(body.skeleton, restPose(body.skeleton));
  return skinningMatricesAt(body.skeleton, body.clips[pose.clip], pose.key);
}

std::vector<ViewedPose> choosePoses(const TemplateBody& body, std::uint32_t most) {
  std::vector<ViewedPose> poses;
  for (std::uint32_t c = 0; c < body.clips.size(); ++c) {
    const std::uint32_t steps = body.clips[c].key_count - 1;
    const std::uint32_t count = std::clamp(2 * steps, 1u, most);
    for (std::uint32_t i = 0; i < count; ++i) {
      poses.push_back({c, static_cast<float>(steps) * static_cast<float>(i) / static_cast<float>(count)});
    }
  }
  if (poses.empty()) poses.push_back({});
  return poses;
}

/// Looks at faces in one pose.
class Lookout {
 public:
  /// @param number of the pose: shifts points and directions, so that each pose tries others
  Lookout(const RayScene& scene, const HiddenFaceOptions& options, std::uint32_t number)
      : scene_(scene), options_(options), shift_(fraction(kPlastic * number)) {}

  bool sees(const Triangle& corners, std::uint32_t face, std::span<const std::uint8_t> gone) const {
    const Vec3 a = scene_.body()[corners[0]], b = scene_.body()[corners[1]], c = scene_.body()[corners[2]];
    const Vec3 area = glm::cross(b - a, c - a);
    const float length = glm::length(area);
    if (!(length > 0.0f)) return false;
    const Vec3 normal = area / length;
    const auto enough =
        static_cast<std::uint32_t>(options_.threshold * static_cast<float>(options_.samples)) + 1;
    std::uint32_t seen = 0;
    for (std::uint32_t s = 0; s < options_.samples; ++s) {
      double u = fraction(shift_ + kPlastic * (s + 1)), v = fraction(shift_ + kPlastic2 * (s + 1));
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      const Vec3 point = a + static_cast<float>(u) * (b - a) + static_cast<float>(v) * (c - a);
      if (!seesPoint(point, normal, face, s, gone)) continue;
      if (++seen == enough) return true;
    }
    return false;
  }

 private:
  bool seesPoint(Vec3 point, Vec3 normal, std::uint32_t face, std::uint32_t sample,
                 std::span<const std::uint8_t> gone) const {
    if (options_.tolerance > 0.0f &&
        scene_.depthOfCloth(point, normal, face, options_.tolerance) <= options_.tolerance)
      return false;
    const Vec3 helper = std::abs(normal.x) < 0.8f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 x = glm::normalize(glm::cross(helper, normal)), y = glm::cross(normal, x);
    const double turn = shift_ + kGolden * sample;
    for (std::uint32_t d = 0; d < options_.directions; ++d) {
      // Even over the hemisphere; the first rays go where most is seen.
      const double up = 1.0 - (d + fraction(turn + 0.5)) / options_.directions;
      const double angle = 2.0 * kPi * fraction(turn + kGolden * d), out = std::sqrt(1.0 - up * up);
      const Vec3 direction = static_cast<float>(out * std::cos(angle)) * x +
                             static_cast<float>(out * std::sin(angle)) * y + static_cast<float>(up) * normal;
      if (scene_.isSeen(point, direction, face, gone)) return true;
    }
    return false;
  }

  const RayScene& scene_;
  const HiddenFaceOptions& options_;
  double shift_;
};

/// Looks at all faces in all poses; what was seen in an earlier pose is not looked at again, which changes
/// nothing in what is found.
class Search {
 public:
  Search(const TemplateBody& body, std::span<const Item* const> items, const HiddenFaceOptions& options)
      : body_(body),
        items_(items),
        options_(options),
        poses_(choosePoses(body, options.poses)),
        first_(body.faces.size()) {
    for (std::atomic<std::uint32_t>& pose : first_) pose = FaceSightings::kNever;
  }

  FaceSightings find() {
    look({});
    std::vector<std::uint8_t> gone(first_.size());
    for (std::size_t f = 0; f < gone.size(); ++f) gone[f] = first_[f] == FaceSightings::kNever;
    look(gone);
    FaceSightings found;
    found.poses = poses_;
    for (const std::atomic<std::uint32_t>& pose : first_) found.first_pose.push(pose);
    return found;
  }

 private:
  void look(std::span<const std::uint8_t> gone) {
    std::atomic<std::uint32_t> next{0};
    const auto work = [&] {
      for (std::uint32_t p = next++; p < poses_.size(); p = next++) lookAt(p, gone);
    };
    const unsigned jobs =
        options_.jobs > 0 ? options_.jobs : std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::jthread> threads;
    for (unsigned t = 1; t < jobs; ++t) threads.emplace_back(work);
    work();
  }

  void lookAt(std::uint32_t pose, std::span<const std::uint8_t> gone) {
    const RayScene scene(device_, body_, items_, matricesAt(body_, poses_[pose]));
    const Lookout lookout(scene, options_, pose);
    for (std::uint32_t f = 0; f < first_.size(); ++f) {
      if (first_[f] <= pose || !lookout.sees(body_.faces[FaceId(f)], f, gone)) continue;
      std::uint32_t earlier = first_[f];
      while (pose < earlier && !first_[f].compare_exchange_weak(earlier, pose)) {
      }
    }
  }

  const TemplateBody& body_;
  std::span<const Item* const> items_;
  const HiddenFaceOptions& options_;
  RayDevice device_;
  std::vector<ViewedPose> poses_;
  std::vector<std::atomic<std::uint32_t>> first_;  // per face: the first pose that shows it
};

}  // namespace

FaceSightings findSightings(const TemplateBody& body, std::span<const Item* const> items,
                            const HiddenFaceOptions& options) {
  return Search(body, items, options).find();
}

}  // namespace ensemble
