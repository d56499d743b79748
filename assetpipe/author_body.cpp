#include "assetpipe/author_body.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include "assetpipe/segment.h"
#include "core/check.h"

namespace ensemble {
namespace {

constexpr float kSmoothCell = 0.010f;  // metres on a body 1.75 m tall
constexpr float kZoneCell = 0.012f;
constexpr float kReferenceHeight = 1.75f;
constexpr float kFar = 1.0e3f;
constexpr int kCoarse = 8;          // nodes
constexpr float kFarCells = 18.0f;  // more than half a coarse cell's diagonal by ten cells
constexpr float kRoom = 0.35f;      // metres around the body where fields are asked for

BodyZone zoneOfName(const std::string& part) {
  constexpr std::array<const char*, kBodyZoneCount> kNames = {"head", "hands", "feet",
                                                              "arms", "torso", "legs"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (part == kNames[i]) return static_cast<BodyZone>(i);
  }
  return BodyZone::kTorso;
}

/// By joint: what its name or an ancestor's speaks of.
std::vector<BodyZone> zonesOfJoints(const RawSkeleton& skeleton) {
  std::vector<std::string> parts(skeleton.bones.size());
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
    parts[b] = bodyPartOfJoint(skeleton.bones[b].name);
    const std::int32_t parent = skeleton.bones[b].parent;
    if (parts[b].empty() && parent >= 0) parts[b] = parts[static_cast<std::size_t>(parent)];
  }
  std::vector<BodyZone> zones;
  for (const RawJoint& joint : skeleton.joints) zones.push_back(zoneOfName(parts[joint.bone]));
  return zones;
}

BodyZone zoneOfFace(const TemplateBody& body, const Triangle& face, const std::vector<BodyZone>& zones) {
  std::array<float, kBodyZoneCount> sums{};
  for (const std::uint32_t corner : face) {
    const SkinBinding& skin = body.vertices[VertexId(corner)].skin;
    for (std::size_t i = 0; i < 4; ++i) {
      if (skin.weights[i] > 0.0f) sums[static_cast<std::size_t>(zones[skin.joints[i]])] += skin.weights[i];
    }
  }
  return static_cast<BodyZone>(std::max_element(sums.begin(), sums.end()) - sums.begin());
}

std::array<float, 4> splineWeights(float t) {
  const float s = 1.0f - t;
  return {s * s * s / 6.0f, (3.0f * t * t * t - 6.0f * t * t + 4.0f) / 6.0f,
          (3.0f * s * s * s - 6.0f * s * s + 4.0f) / 6.0f, t * t * t / 6.0f};
}

}  // namespace

SmoothGrid::SmoothGrid(Field exact, const Vec3& low, const Vec3& high, float cell)
    : exact_(std::move(exact)), low_(low), cell_(cell) {
  std::size_t nodes = 1;
  for (int axis = 0; axis < 3; ++axis) {
    count_[static_cast<std::size_t>(axis)] = static_cast<int>(std::ceil((high[axis] - low[axis]) / cell)) + 4;
    nodes *= static_cast<std::size_t>(count_[static_cast<std::size_t>(axis)]);
  }
  values_.assign(nodes, std::numeric_limits<float>::quiet_NaN());
}

float SmoothGrid::node(int x, int y, int z) const {
  float& value = values_[(static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[1]) +
                          static_cast<std::size_t>(y)) *
                             static_cast<std::size_t>(count_[0]) +
                         static_cast<std::size_t>(x)];
  if (std::isnan(value)) {
    value = exact_(
        low_ + cell_ * Vec3(static_cast<float>(x - 1), static_cast<float>(y - 1), static_cast<float>(z - 1)));
  }
  return value;
}

float SmoothGrid::at(const Vec3& position) const {
  // Far away nobody needs it smooth: one node in kCoarse stands for those around it.
  std::array<int, 3> coarse{};
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t a = static_cast<std::size_t>(axis);
    const int node_number = static_cast<int>(std::lround((position[axis] - low_[axis]) / (cell_ * kCoarse)));
    coarse[a] = std::clamp(node_number * kCoarse + 1, 0, count_[a] - 1);
  }
  const float around = node(coarse[0], coarse[1], coarse[2]);
  if (std::abs(around) > kFarCells * cell_) return around;
  std::array<int, 3> first{};
  std::array<std::array<float, 4>, 3> weights{};
  float outside = 0.0f;  // beyond the grid the distance grows as fast as the way there
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t a = static_cast<std::size_t>(axis);
    const float most = static_cast<float>(count_[a] - 4);
    const float free = (position[axis] - low_[axis]) / cell_;
    const float along = std::clamp(free, 0.0f, most);
    outside += std::abs(free - along) * cell_;
    first[a] = std::min(static_cast<int>(along), count_[a] - 4);
    weights[a] = splineWeights(along - static_cast<float>(first[a]));
  }
  float sum = 0.0f;
  for (int z = 0; z < 4; ++z) {
    for (int y = 0; y < 4; ++y) {
      const float share = weights[2][static_cast<std::size_t>(z)] * weights[1][static_cast<std::size_t>(y)];
      for (int x = 0; x < 4; ++x) {
        sum +=
            share * weights[0][static_cast<std::size_t>(x)] * node(first[0] + x, first[1] + y, first[2] + z);
      }
    }
  }
  return sum + outside;
}

AuthorBody::AuthorBody(const TemplateBody& body) : body_(body) {
  std::vector<Vec3> positions;
  for (const RawVertex& vertex : body.vertices) positions.push_back(vertex.position);
  surface_ = std::make_unique<BodySurface>(positions, body.faces.raw());
  poses_ = poseInClips(body, *surface_);
  low_ = high_ = surface_->positions().front();
  for (const Vec3& p : surface_->positions()) {
    low_ = glm::min(low_, p);
    high_ = glm::max(high_, p);
  }
  scale_ = (high_.y - low_.y) / kReferenceHeight;
  const std::vector<BodyZone> joint_zones = zonesOfJoints(body.skeleton);
  std::array<std::vector<Triangle>, kBodyZoneCount> faces;
  for (const Triangle& face : body.faces) {
    zones_.push_back(zoneOfFace(body, face, joint_zones));
    faces[static_cast<std::size_t>(zones_.back())].push_back(face);
  }
  const Vec3 low = low_ - kRoom * scale_, high = high_ + kRoom * scale_;
  smooth_ = std::make_unique<SmoothGrid>([this](const Vec3& p) { return surface_->signedDistance(p); }, low,
                                         high, kSmoothCell * scale_);
  for (std::size_t z = 0; z < kBodyZoneCount; ++z) {
    if (faces[z].empty()) continue;
    zone_surfaces_[z] = std::make_unique<BodySurface>(positions, faces[z]);
    zone_grids_[z] = std::make_unique<SmoothGrid>(
        [surface = zone_surfaces_[z].get()](const Vec3& p) { return surface->nearest(p).distance; }, low,
        high, kZoneCell * scale_);
  }
}

float AuthorBody::distanceTo(BodyZone zone, const Vec3& p) const {
  if (p != asked_point_) {
    asked_point_ = p;
    asked_distances_.fill(std::numeric_limits<float>::quiet_NaN());
  }
  float& distance = asked_distances_[static_cast<std::size_t>(zone)];
  if (std::isnan(distance)) {
    const auto& grid = zone_grids_[static_cast<std::size_t>(zone)];
    distance = grid ? grid->at(p) : kFar;
  }
  return distance;
}

float AuthorBody::border(std::initializer_list<BodyZone> zones, const Vec3& p) const {
  float to_these = kFar, to_others = kFar;
  for (std::size_t z = 0; z < kBodyZoneCount; ++z) {
    const auto zone = static_cast<BodyZone>(z);
    float& nearest = std::find(zones.begin(), zones.end(), zone) != zones.end() ? to_these : to_others;
    nearest = std::min(nearest, distanceTo(zone, p));
  }
  return std::clamp(0.5f * (to_these - to_others), -1.0f, 1.0f);
}

float AuthorBody::regionBorder(RegionId region, const Vec3& p) const {
  auto& [inside, outside] = regions_[region];
  if (!inside && !outside) {
    std::vector<Vec3> positions;
    for (const RawVertex& vertex : body_.vertices) positions.push_back(vertex.position);
    std::vector<Triangle> own, others;
    for (std::size_t f = 0; f < body_.faces.size(); ++f) {
      (body_.region_of_face[FaceId(f)] == region ? own : others).push_back(body_.faces[FaceId(f)]);
    }
    inside = std::make_unique<BodySurface>(positions, own);
    if (!others.empty()) outside = std::make_unique<BodySurface>(positions, others);
  }
  return outside ? 0.5f * (inside->nearest(p).distance - outside->nearest(p).distance) : -1.0f;
}

const std::array<const char*, kLandmarkCount>& landmarkNames() {
  static constexpr std::array<const char*, kLandmarkCount> kNames = {
      "pelvis", "neck", "head", "shoulder", "elbow", "wrist", "hip", "knee", "ankle", "ball"};
  return kNames;
}

namespace {

/// Names of a landmark's joint without its side, lower case letters and digits only.
constexpr std::array<std::array<const char*, 5>, kLandmarkCount> kJointNames = {{
    {"pelvis", "hips", "hip", "spine", "root"},
    {"neck01", "neck", "neck1", "necklower", "spine004"},
    {"head", "head01", "spine006", "skull", "head1"},
    {"upperarm", "arm", "shldr", "shldrbend", "uparm"},
    {"lowerarm", "forearm", "forearmbend", "elbow", "lowarm"},
    {"hand", "wrist", "hand01", "palm", "hand1"},
    {"thigh", "upleg", "thighbend", "upperleg", "legupper"},
    {"calf", "leg", "shin", "lowerleg", "knee"},
    {"foot", "ankle", "foot01", "foot1", "legfoot"},
    {"ball", "toebase", "toe", "toes", "metatarsals"},
}};

bool isPaired(std::size_t landmark) { return landmark >= static_cast<std::size_t>(Landmark::kShoulder); }

struct SidedName {
  std::string name;
  int side = -1;  // 0 left, 1 right, -1 neither
};

/// "LeftForeArm", "lowerarm_l", "mixamorig:LeftArm", "forearm.L", "lShldr" -> name and side.
SidedName splitSide(std::string text) {
  if (const std::size_t colon = text.rfind(':'); colon != std::string::npos) text = text.substr(colon + 1);
  const bool has_small_side =
      text.size() > 1 && (text[0] == 'l' || text[0] == 'r') && std::isupper(text[1]) != 0;
  SidedName split;
  if (has_small_side) {
    split.side = text[0] == 'l' ? 0 : 1;
    text = text.substr(1);
  }
  std::vector<std::string> words;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) {
      words.emplace_back();
      continue;
    }
    if (words.empty()) words.emplace_back();
    words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  for (std::string& word : words) {
    for (const auto& [mark, side] : {std::pair("left", 0), std::pair("right", 1)}) {
      if (split.side < 0 && word.starts_with(mark)) {
        split.side = side;
        word = word.substr(std::string(mark).size());
      }
    }
    if (split.side < 0 && words.size() > 1 && (word == "l" || word == "r")) {
      split.side = word == "l" ? 0 : 1;
      word.clear();
    }
    if (word != "def" && word != "org") split.name += word;
  }
  return split;
}

Vec3 bindPosition(const RawJoint& joint) { return Vec3(glm::inverse(joint.joint_from_model)[3]); }

}  // namespace

std::optional<std::uint16_t> findJoint(const RawSkeleton& skeleton, const std::string& name) {
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    if (skeleton.bones[skeleton.joints[j].bone].name == name) return static_cast<std::uint16_t>(j);
  }
  return std::nullopt;
}

Landmarks::Landmarks(const RawSkeleton& skeleton, const std::map<std::string, std::string>& names) {
  std::vector<SidedName> split;
  for (const RawJoint& joint : skeleton.joints) split.push_back(splitSide(skeleton.bones[joint.bone].name));
  for (std::size_t mark = 0; mark < kLandmarkCount; ++mark) {
    std::vector<std::string> wanted(kJointNames[mark].begin(), kJointNames[mark].end());
    const auto named = names.find(landmarkNames()[mark]);
    if (named != names.end()) wanted = {splitSide(named->second).name};
    for (std::size_t side = 0; side < 2; ++side) {
      for (const std::string& name : wanted) {
        for (std::size_t j = 0; j < split.size() && !joints_[mark][side]; ++j) {
          const bool fits_side = isPaired(mark) ? split[j].side == static_cast<int>(side) : split[j].side < 0;
          if (fits_side && split[j].name == name) joints_[mark][side] = static_cast<std::uint16_t>(j);
        }
      }
      if (joints_[mark][side]) positions_[mark][side] = bindPosition(skeleton.joints[*joints_[mark][side]]);
    }
  }
}

bool Landmarks::has(Landmark landmark) const {
  const auto& joints = joints_[static_cast<std::size_t>(landmark)];
  return joints[0] && joints[1];
}

Vec3 Landmarks::at(Landmark landmark, std::size_t side) const {
  ENSEMBLE_CHECK(has(landmark));
  return positions_[static_cast<std::size_t>(landmark)][side];
}

std::uint16_t Landmarks::joint(Landmark landmark, std::size_t side) const {
  ENSEMBLE_CHECK(has(landmark));
  return *joints_[static_cast<std::size_t>(landmark)][side];
}

const char* Landmarks::usualName(Landmark landmark) {
  constexpr std::array<const char*, kLandmarkCount> kUsual = {
      "pelvis", "neck_01", "head",   "upperarm_l", "lowerarm_l",
      "hand_l", "thigh_l", "calf_l", "foot_l",     "ball_l"};
  return kUsual[static_cast<std::size_t>(landmark)];
}

}  // namespace ensemble
