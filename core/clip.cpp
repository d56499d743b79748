// glTF 2.0, section 3.11 and appendix C (interpolation); Lister, Laycock and Day, equation 1 (skinning).
#include "core/clip.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace ensemble {
namespace {

constexpr double kFallbackRate = 30.0;
constexpr double kEqualSpacing = 0.02;  // of a step

Vec4 toVec4(const Quat& q) { return Vec4(q.x, q.y, q.z, q.w); }
Quat toQuat(const Vec4& v) { return glm::normalize(Quat(v.w, v.x, v.y, v.z)); }

// Hermite interpolation between keys `k` and `k + 1`; tangents are per second.
Vec4 evaluateCubic(const RawChannel& channel, std::size_t k, float s) {
  const float duration = channel.times[k + 1] - channel.times[k];
  const Vec4& value = channel.values[3 * k + 1];
  const Vec4& out_tangent = channel.values[3 * k + 2];
  const Vec4& in_tangent = channel.values[3 * k + 3];
  const Vec4& next = channel.values[3 * k + 4];
  const float s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * value + duration * (s3 - 2 * s2 + s) * out_tangent +
         (-2 * s3 + 3 * s2) * next + duration * (s3 - s2) * in_tangent;
}

// glm::slerp takes the shorter arc and falls back to mixing where the ends are nearly equal.
Vec4 interpolateLinear(ChannelPath path, const Vec4& a, const Vec4& b, float s) {
  if (path != ChannelPath::kRotation) return glm::mix(a, b, s);
  return toVec4(glm::slerp(toQuat(a), toQuat(b), s));
}

Vec4 valueOfKey(const RawChannel& channel, std::size_t key) {
  return channel.interpolation == Interpolation::kCubicSpline ? channel.values[3 * key + 1]
                                                              : channel.values[key];
}

// A channel's value at a time; before its first and after its last key it stands still.
Vec4 evaluate(const RawChannel& channel, float time) {
  const auto after = std::upper_bound(channel.times.begin(), channel.times.end(), time);
  if (after == channel.times.begin()) return valueOfKey(channel, 0);
  if (after == channel.times.end()) return valueOfKey(channel, channel.times.size() - 1);
  const auto k = static_cast<std::size_t>(after - channel.times.begin()) - 1;
  const float s = (time - channel.times[k]) / (channel.times[k + 1] - channel.times[k]);
  if (s == 0.0f || channel.interpolation == Interpolation::kStep) return valueOfKey(channel, k);
  if (channel.interpolation == Interpolation::kCubicSpline) return evaluateCubic(channel, k, s);
  return interpolateLinear(channel.path, channel.values[k], channel.values[k + 1], s);
}

void applyValue(ChannelPath path, const Vec4& value, Transform& transform) {
  switch (path) {
    case ChannelPath::kTranslation:
      transform.translation = Vec3(value);
      return;
    case ChannelPath::kRotation:
      transform.rotation = toQuat(value);
      return;
    case ChannelPath::kScale:
      transform.scale = Vec3(value);
      return;
  }
}

void checkChannel(const RawSkeleton& skeleton, const RawChannel& channel) {
  ENSEMBLE_CHECK(channel.bone < skeleton.bones.size());
  ENSEMBLE_CHECK(!channel.times.empty());
  const std::size_t values_a_key = channel.interpolation == Interpolation::kCubicSpline ? 3 : 1;
  ENSEMBLE_CHECK(channel.values.size() == channel.times.size() * values_a_key);
}

/// At which times a clip is sampled.
struct Sampling {
  double start = 0.0, seconds = 0.0;
  std::uint32_t key_count = 1;
  double timeOf(std::uint32_t key) const {
    return key_count < 2 ? start : start + seconds * key / (key_count - 1);
  }
};

// The keys of `times` are equally spaced over the whole clip, within 2 % of a step.
bool isEqualSpacing(const std::vector<float>& times, const Sampling& sampling) {
  if (times.size() < 2) return false;
  const double step = sampling.seconds / static_cast<double>(times.size() - 1);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double expected = sampling.start + step * static_cast<double>(i);
    if (std::abs(static_cast<double>(times[i]) - expected) > kEqualSpacing * step) return false;
  }
  return true;
}

// Whether every key of `times` falls on a sample.
bool fallsOnSamples(const std::vector<float>& times, const Sampling& sampling) {
  const double step = sampling.seconds / (sampling.key_count - 1);
  return std::all_of(times.begin(), times.end(), [&](float time) {
    const double position = (static_cast<double>(time) - sampling.start) / step;
    return std::abs(position - std::round(position)) <= kEqualSpacing;
  });
}

// The file's own keys, where the densest channel's are equally spaced and the others fall on them
// (exporters thin out channels that rest); else 30 Hz, or a little more so that the clip's end is a key.
Sampling chooseSampling(const RawClip& clip) {
  Sampling sampling;
  const std::vector<float>* densest = nullptr;
  double end = 0.0;
  sampling.start = INFINITY;
  for (const RawChannel& channel : clip.channels) {
    sampling.start = std::min(sampling.start, static_cast<double>(channel.times.front()));
    end = std::max(end, static_cast<double>(channel.times.back()));
    if (densest == nullptr || channel.times.size() > densest->size()) densest = &channel.times;
  }
  if (densest == nullptr) return {};
  sampling.seconds = end - sampling.start;
  if (!(sampling.seconds > 0.0)) return sampling;
  // A curve between few keys is not a straight line, so cubic channels are always resampled.
  const bool straight = std::none_of(
      clip.channels.begin(), clip.channels.end(),
      [](const RawChannel& channel) { return channel.interpolation == Interpolation::kCubicSpline; });
  if (isEqualSpacing(*densest, sampling)) {
    sampling.key_count = static_cast<std::uint32_t>(densest->size());
    const double rate = (sampling.key_count - 1) / sampling.seconds;
    const bool all_fall_on =
        std::all_of(clip.channels.begin(), clip.channels.end(),
                    [&](const RawChannel& c) { return fallsOnSamples(c.times, sampling); });
    if (all_fall_on && (straight || rate >= 0.98 * kFallbackRate)) return sampling;
  }
  sampling.key_count = static_cast<std::uint32_t>(std::ceil(sampling.seconds * kFallbackRate - 1e-3)) + 1;
  sampling.key_count = std::max(sampling.key_count, 2u);
  return sampling;
}

bool differs(const Vec3& a, const Vec3& b) { return a != b; }
bool differs(const Quat& a, const Quat& b) { return a != b && a != -b; }

Vec4 toValue(const Vec3& v) { return Vec4(v, 0.0f); }
Vec4 toValue(const Quat& q) { return toVec4(q); }

// Appends the channel of one property of one bone, if it leaves its rest at some key.
template <class T>
void addChannel(const Clip& clip, std::uint32_t bone, std::pair<ChannelPath, T Transform::*> property,
                const Transform& rest, RawClip& raw) {
  RawChannel channel;
  channel.bone = bone;
  channel.path = property.first;
  bool moves = false;
  for (std::uint32_t key = 0; key < clip.key_count; ++key) {
    const T& value = clip.key(key)[bone].*property.second;
    moves = moves || differs(value, rest.*property.second);
    channel.values.push_back(toValue(value));
  }
  if (moves) raw.channels.push_back(std::move(channel));
}

}  // namespace

Clip sampleClip(const RawSkeleton& skeleton, const RawClip& raw) {
  for (const RawChannel& channel : raw.channels) checkChannel(skeleton, channel);
  const Sampling sampling = chooseSampling(raw);
  Clip clip;
  clip.name = raw.name;
  clip.seconds = static_cast<float>(sampling.seconds);
  clip.key_count = sampling.key_count;
  const std::vector<Transform> rest = restPose(skeleton);
  for (std::uint32_t key = 0; key < clip.key_count; ++key) {
    clip.transforms.insert(clip.transforms.end(), rest.begin(), rest.end());
    Transform* pose = clip.transforms.data() + key * rest.size();
    const double time = sampling.timeOf(key);
    // Snap to the file's key that is meant: within float noise of it, a STEP would show its neighbour.
    const double noise = clip.key_count < 2 ? 0.0 : kEqualSpacing * sampling.seconds / (clip.key_count - 1);
    for (const RawChannel& channel : raw.channels) {
      float at = static_cast<float>(time);
      const auto near =
          std::lower_bound(channel.times.begin(), channel.times.end(), static_cast<float>(time - noise));
      if (near != channel.times.end() && std::abs(static_cast<double>(*near) - time) <= noise) at = *near;
      applyValue(channel.path, evaluate(channel, at), pose[channel.bone]);
    }
  }
  return clip;
}

RawClip toRawClip(const RawSkeleton& skeleton, const Clip& clip) {
  ENSEMBLE_CHECK(clip.key_count > 0u);
  ENSEMBLE_CHECK(clip.transforms.size() == clip.key_count * skeleton.bones.size());
  RawClip raw;
  raw.name = clip.name;
  for (std::uint32_t bone = 0; bone < skeleton.bones.size(); ++bone) {
    const Transform& rest = skeleton.bones[bone].rest;
    addChannel(clip, bone, std::pair(ChannelPath::kTranslation, &Transform::translation), rest, raw);
    addChannel(clip, bone, std::pair(ChannelPath::kRotation, &Transform::rotation), rest, raw);
    addChannel(clip, bone, std::pair(ChannelPath::kScale, &Transform::scale), rest, raw);
  }
  if (raw.channels.empty() && !skeleton.bones.empty()) {
    RawChannel still;
    for (std::uint32_t key = 0; key < clip.key_count; ++key) {
      still.values.push_back(toValue(skeleton.bones[0].rest.rotation));
    }
    raw.channels.push_back(std::move(still));
  }
  const Sampling sampling{0.0, static_cast<double>(clip.seconds), clip.key_count};
  for (RawChannel& channel : raw.channels) {
    for (std::uint32_t key = 0; key < clip.key_count; ++key) {
      channel.times.push_back(static_cast<float>(sampling.timeOf(key)));
    }
  }
  return raw;
}

void globalPose(const RawSkeleton& skeleton, std::span<const Transform> local,
                std::span<Mat4> world_from_bone) {
  ENSEMBLE_CHECK(local.size() == skeleton.bones.size());
  ENSEMBLE_CHECK(world_from_bone.size() == skeleton.bones.size());
  for (std::size_t bone = 0; bone < local.size(); ++bone) {
    const std::int32_t parent = skeleton.bones[bone].parent;
    const Mat4 parent_from_bone = toMatrix(local[bone]);
    world_from_bone[bone] =
        parent < 0 ? parent_from_bone : world_from_bone[static_cast<std::size_t>(parent)] * parent_from_bone;
  }
}

std::vector<Mat4> skinningMatrices(const RawSkeleton& skeleton, std::span<const Transform> local) {
  std::vector<Mat4> world_from_bone(skeleton.bones.size());
  globalPose(skeleton, local, world_from_bone);
  std::vector<Mat4> matrices;
  matrices.reserve(skeleton.joints.size());
  for (const RawJoint& joint : skeleton.joints) {
    matrices.push_back(world_from_bone[joint.bone] * joint.joint_from_model);
  }
  return matrices;
}

std::vector<Mat4> skinningMatricesAt(const RawSkeleton& skeleton, const Clip& clip, float key) {
  const std::uint32_t last = clip.key_count - 1;
  const std::uint32_t first = std::min(static_cast<std::uint32_t>(key), last);
  std::vector<Mat4> matrices = skinningMatrices(skeleton, clip.key(first));
  const float part = key - static_cast<float>(first);
  if (first < last && part > 0.0f) {
    mixMatrices(matrices, skinningMatrices(skeleton, clip.key(first + 1)), part);
  }
  return matrices;
}

void mixMatrices(std::span<Mat4> a, std::span<const Mat4> b, float part) {
  ENSEMBLE_CHECK(a.size() == b.size());
  for (std::size_t j = 0; j < a.size(); ++j) a[j] = a[j] * (1.0f - part) + b[j] * part;
}

std::vector<Transform> restPose(const RawSkeleton& skeleton) {
  std::vector<Transform> rest;
  rest.reserve(skeleton.bones.size());
  for (const RawBone& bone : skeleton.bones) rest.push_back(bone.rest);
  return rest;
}

Vec3 skinPosition(const RawVertex& vertex, std::span<const Mat4> skinning_matrices) {
  return skinPosition(vertex.position, vertex.skin, skinning_matrices);
}

Vec3 skinPosition(const Vec3& position, const SkinBinding& skin, std::span<const Mat4> skinning_matrices) {
  Vec3 result(0.0f);
  float sum = 0.0f;
  for (std::size_t i = 0; i < 4; ++i) {
    const float weight = skin.weights[i];
    if (weight == 0.0f) continue;
    result += weight * Vec3(skinning_matrices[skin.joints[i]] * Vec4(position, 1.0f));
    sum += weight;
  }
  return sum == 0.0f ? position : result;  // what no joint moves stays
}

}  // namespace ensemble
