#include "cli/annotations.h"

#include <cmath>

#include "cli/aov_ids.h"
#include "core/hash.h"
#include "renderer/scene_names.h"
#include "renderer/view_setup.h"

namespace ensemble::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPerPixel = 100.0;    // hundredths of a pixel
constexpr double kPerMetre = 10000.0;  // tenths of a millimetre
constexpr double kDegrees = 180.0 / 3.14159265358979323846;

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

Json toJson(Vec3 v) { return {rounded(v.x, kPerMetre), rounded(v.y, kPerMetre), rounded(v.z, kPerMetre)}; }

Json toJson(const PixelBox& box) {
  return {rounded(box.x, kPerPixel), rounded(box.y, kPerPixel), rounded(box.width, kPerPixel),
          rounded(box.height, kPerPixel)};
}

/// COCO's key points: 2 shows, 1 does not; [0, 0, 0] where there is no place in the picture's plane.
Json toJson(const PictureJoint& joint) {
  if (!joint.place) return {0, 0, 0};
  return {rounded(joint.place->x, kPerPixel), rounded(joint.place->y, kPerPixel), joint.shows ? 2 : 1};
}

Json describeCamera(const View& view) {
  const PinholeCamera camera = pinholeOf(view);
  const Mat4 rows = glm::transpose(clipFromWorld(view));
  Json clip = Json::array();
  for (int row = 0; row < 4; ++row) clip.push_back({rows[row].x, rows[row].y, rows[row].z, rows[row].w});
  return {{"intrinsics", camera.intrinsics},
          {"camera_from_world", camera.camera_from_world},
          {"clip_from_world", std::move(clip)}};
}

Json describeJoints(const std::string& name, const RawSkeleton& skeleton) {
  std::vector<std::int32_t> joint_of_bone(skeleton.bones.size(), -1);
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    joint_of_bone[skeleton.joints[j].bone] = static_cast<std::int32_t>(j);
  }
  Json joints = Json::array(), parents = Json::array();
  for (const RawJoint& joint : skeleton.joints) {
    joints.push_back(skeleton.bones[joint.bone].name);
    std::int32_t bone = skeleton.bones[joint.bone].parent;
    while (bone >= 0 && joint_of_bone[static_cast<std::size_t>(bone)] < 0) {
      bone = skeleton.bones[static_cast<std::size_t>(bone)].parent;
    }
    parents.push_back(bone < 0 ? -1 : joint_of_bone[static_cast<std::size_t>(bone)]);
  }
  return {{"name", name}, {"joints", std::move(joints)}, {"parents", std::move(parents)}};
}

Json describePerson(const PersonTruth& truth, const std::string& wardrobe_name, const Wardrobe& wardrobe,
                    const Combination& items) {
  const std::vector<Clip>& clips = wardrobe.body.clips;
  Json joints = Json::array(), picture_joints = Json::array();
  for (const Vec3& joint : truth.joints) joints.push_back(toJson(joint));
  for (const PictureJoint& joint : truth.picture_joints) picture_joints.push_back(toJson(joint));
  return {{"number", truth.number},
          {"id", truth.number + 1},
          {"wardrobe", wardrobe_name},
          {"outfit", outfitName(wardrobe, items)},
          {"clip", clips.empty() ? "" : clips[truth.clip].name},
          {"bbox", toJson(truth.box)},
          {"bbox_whole", truth.whole_box ? toJson(*truth.whole_box) : Json(nullptr)},
          {"pixels", truth.visible_pixels},
          {"pixels_alone", truth.pixels_alone},
          {"visible", rounded(truth.visibleShare(), 10000.0)},
          {"bbox_3d",
           {{"center", toJson(truth.center)},
            {"size", toJson(truth.size)},
            {"heading", rounded(double{truth.heading} * kDegrees, 100.0)}}},
          {"joints_2d", std::move(picture_joints)},
          {"joints_3d", std::move(joints)}};
}

}  // namespace

Json annotationHeader(const Scene& scene, std::span<const Wardrobe> wardrobes, const Crowd& crowd) {
  const std::string people =
      describeCharacters(scene, wardrobes, crowd).dump(-1, ' ', false, Json::error_handler_t::replace);
  Json header = {{"schema", "ensemble.annotations/1"},
                 {"width", scene.output.width},
                 {"height", scene.output.height},
                 {"fps", scene.output.fps},
                 {"crowd_sha256", sha256Hex(std::as_bytes(std::span(people)))},
                 {"wardrobes", Json::array()}};
  for (std::size_t w = 0; w < wardrobes.size(); ++w) {
    header["wardrobes"].push_back(
        describeJoints(wardrobeName(scene.wardrobes[w]), wardrobes[w].body.skeleton));
  }
  return header;
}

Json annotateFrame(const Scene& scene, std::span<const Wardrobe> wardrobes, const Crowd& crowd,
                   const View& view, const Picture& picture, std::uint32_t frame, const std::string& file) {
  const double seconds = frame / double{scene.output.fps};
  Json people = Json::array();
  for (const PersonTruth& truth : truthOf(crowd, wardrobes, view, picture, seconds)) {
    const Character& person = crowd.characters[truth.number];
    people.push_back(describePerson(truth, wardrobeName(scene.wardrobes[person.wardrobe]),
                                    wardrobes[person.wardrobe],
                                    crowd.combinations[person.combination].items));
  }
  return {{"frame", frame},
          {"file", file},
          {"seconds", seconds},
          {"camera", describeCamera(view)},
          {"people", std::move(people)}};
}

}  // namespace ensemble::cli
