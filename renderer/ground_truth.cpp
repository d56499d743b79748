#include "renderer/ground_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/box.h"
#include "core/check.h"
#include "core/clip.h"
#include "renderer/animation.h"
#include "renderer/posed_joints.h"
#include "renderer/view_setup.h"

namespace ensemble {
namespace {

/// The pixels of one person.
struct Pixels {
  std::uint32_t left = 0, right = 0, top = 0, bottom = 0, count = 0;

  void add(std::uint32_t x, std::uint32_t y) {
    left = count == 0 ? x : std::min(left, x);
    right = count == 0 ? x : std::max(right, x);
    top = count == 0 ? y : top;  // rows come from the top
    bottom = y;
    ++count;
  }
  PixelBox box() const {
    return {double{static_cast<double>(left)}, double{static_cast<double>(top)}, 1.0 + right - left,
            1.0 + bottom - top};
  }
};

std::vector<Pixels> collectPixels(const Picture& picture, const View& view, std::size_t people) {
  std::vector<Pixels> pixels(people);
  const std::uint32_t* character = picture.character.data();
  for (std::uint32_t y = 0; y < view.height; ++y) {
    for (std::uint32_t x = 0; x < view.width; ++x, ++character) {
      if (*character != 0) pixels[*character - 1].add(x, y);
    }
  }
  return pixels;
}

/// Calls take(position in model space) for the vertices of a dressed body: all of it, also what its clothes
/// hide, so that no technique moves a box.
template <class Take>
void forEachPosition(const Wardrobe& wardrobe, const Combination& items, std::span<const Mat4> matrices,
                     const Take& take) {
  const auto pose = [&](const RawVertex& vertex) { take(skinPosition(vertex, matrices)); };
  for (const RawVertex& vertex : wardrobe.body.vertices) pose(vertex);
  for (const ItemId id : items) forEachVertex(wardrobe.items[id], pose);
}

struct PictureExtent {
  glm::dvec2 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
  bool reaches_behind = false;

  void add(const std::optional<glm::dvec2>& place, bool is_near) {
    reaches_behind = reaches_behind || is_near || !place;
    if (reaches_behind) return;
    low = glm::min(low, *place);
    high = glm::max(high, *place);
  }
  std::optional<PixelBox> box() const {
    if (reaches_behind) return std::nullopt;
    return PixelBox{low.x, low.y, high.x - low.x, high.y - low.y};
  }
};

void fillBoxes(const Wardrobe& wardrobe, const Combination& items, const CharacterPose& pose,
               std::span<const Mat4> matrices, const PinholeCamera& camera, const View& view,
               PersonTruth& truth) {
  const CameraFrame frame = cameraFrame(view.camera);
  Box model;
  PictureExtent seen;
  forEachPosition(wardrobe, items, matrices, [&](Vec3 position) {
    model.add(position);
    const Vec3 world(pose.world_from_model * Vec4(position, 1.0f));
    const bool is_near = glm::dot(frame.forward, world - view.camera.position) < view.camera.near_plane;
    seen.add(camera.project(world), is_near);
  });
  truth.whole_box = seen.box();
  truth.center = Vec3(pose.world_from_model * Vec4(model.center(), 1.0f));
  truth.size = model.extent() * glm::length(Vec3(pose.world_from_model[0]));
}

PictureJoint jointInPicture(Vec3 joint, const PinholeCamera& camera, const View& view, const Picture& picture,
                            std::uint32_t number) {
  PictureJoint result{.place = camera.project(joint), .shows = false};
  if (!result.place) return result;
  const glm::dvec2 pixel = glm::floor(*result.place);
  if (pixel.x < 0.0 || pixel.y < 0.0 || pixel.x >= view.width || pixel.y >= view.height) return result;
  const auto x = static_cast<std::size_t>(pixel.x), y = static_cast<std::size_t>(pixel.y);
  result.shows = picture.character[y * view.width + x] == 1 + number;
  return result;
}

}  // namespace

std::optional<glm::dvec2> PinholeCamera::project(Vec3 world) const {
  glm::dvec3 place(0.0);
  for (int row = 0; row < 3; ++row) {
    const std::array<double, 4>& r = camera_from_world[static_cast<std::size_t>(row)];
    place[row] = r[0] * world.x + r[1] * world.y + r[2] * world.z + r[3];
  }
  if (!(place.z > 0.0)) return std::nullopt;
  return glm::dvec2(intrinsics[0][0] * place.x / place.z + intrinsics[0][2],
                    intrinsics[1][1] * place.y / place.z + intrinsics[1][2]);
}

PinholeCamera pinholeOf(const View& view) {
  const CameraFrame frame = cameraFrame(view.camera);
  const glm::dvec3 eye(view.camera.position);
  const double focal = 0.5 * view.height / std::tan(0.5 * double{view.camera.fov_y});
  PinholeCamera camera;
  camera.intrinsics = {{{focal, 0.0, 0.5 * view.width}, {0.0, focal, 0.5 * view.height}, {0.0, 0.0, 1.0}}};
  const std::array<glm::dvec3, 3> axes = {glm::dvec3(frame.right), -glm::dvec3(frame.up),
                                          glm::dvec3(frame.forward)};
  for (std::size_t row = 0; row < 3; ++row) {
    camera.camera_from_world[row] = {axes[row].x, axes[row].y, axes[row].z, -glm::dot(axes[row], eye)};
  }
  camera.camera_from_world[3] = {0.0, 0.0, 0.0, 1.0};
  return camera;
}

std::vector<PersonTruth> truthOf(const Crowd& crowd, std::span<const Wardrobe> wardrobes, const View& view,
                                 const Picture& picture, double seconds) {
  const std::size_t people = crowd.characters.size();
  ENSEMBLE_CHECK(picture.coverage.size() == people);
  ENSEMBLE_CHECK(picture.character.size() == std::size_t{view.width} * view.height);
  const std::vector<Pixels> pixels = collectPixels(picture, view, people);
  const PinholeCamera camera = pinholeOf(view);
  std::vector<float> heights;
  for (const Wardrobe& wardrobe : wardrobes) heights.push_back(bodyHeight(wardrobe));
  const SmallPeople small_people = smallPeopleOf(view);
  std::vector<PersonTruth> truths;
  for (std::uint32_t i = 0; i < people; ++i) {
    if (pixels[i].count == 0) continue;
    const Character& person = crowd.characters[i];
    const Wardrobe& wardrobe = wardrobes[person.wardrobe];
    const std::vector<Clip>& clips = wardrobe.body.clips;
    CharacterPose pose = poseAt(crowd, person, clips.empty() ? 0.0f : clips[person.clip].seconds, seconds);
    if (small_people.hold(Vec3(pose.world_from_model[3]), heights[person.wardrobe] * person.scale))
      pose = atNearestKey(wardrobe.body, pose);
    const std::vector<Mat4> matrices = posedMatrices(wardrobe.body, pose);
    PersonTruth& truth = truths.emplace_back();
    truth.number = i;
    truth.box = pixels[i].box();
    truth.visible_pixels = pixels[i].count;
    truth.pixels_alone = picture.coverage[i];
    truth.heading = pose.heading;
    truth.clip = pose.idle_weight > 0.5f ? pose.idle_clip : pose.clip;
    fillBoxes(wardrobe, crowd.combinations[person.combination].items, pose, matrices, camera, view, truth);
    truth.joints = jointPositions(wardrobe.body, pose, matrices);
    for (const Vec3& joint : truth.joints) {
      truth.picture_joints.push_back(jointInPicture(joint, camera, view, picture, i));
    }
  }
  return truths;
}

}  // namespace ensemble
