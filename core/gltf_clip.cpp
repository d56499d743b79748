// glTF 2.0, section 3.11 (animations).
#include "core/gltf_clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/gltf_accessor.h"

namespace ensemble {
namespace {

Interpolation readInterpolation(const JsonRef& sampler) {
  const std::string name = sampler.stringOr("interpolation", "LINEAR");
  if (name == "LINEAR") return Interpolation::kLinear;
  if (name == "STEP") return Interpolation::kStep;
  if (name == "CUBICSPLINE") return Interpolation::kCubicSpline;
  sampler.require("interpolation").fail(fmt::format("interpolation '{}' does not exist", name));
}

std::optional<ChannelPath> readPath(const JsonRef& path) {
  const std::string& name = path.string();
  if (name == "translation") return ChannelPath::kTranslation;
  if (name == "rotation") return ChannelPath::kRotation;
  if (name == "scale") return ChannelPath::kScale;
  if (name == "weights" || name == "pointer") return std::nullopt;
  path.fail(fmt::format("path '{}' does not exist", name));
}

class ClipReader {
 public:
  ClipReader(const GltfDocument& document, const GltfSkeleton& skeleton, const GltfNodes& tree,
             DroppedList& dropped)
      : document_(document),
        skeleton_(skeleton),
        tree_(tree),
        dropped_(dropped),
        keys_left_(document.options().max_keys),
        poses_left_(document.options().max_poses) {}

  RawClip read(std::size_t index) {
    const JsonRef animation = document_.item("animations", index);
    RawClip clip;
    clip.name = animation.stringOr("name", "");
    if (clip.name.empty()) clip.name = fmt::format("clip {}", index);
    const JsonRef channels = animation.require("channels");
    std::set<std::pair<std::uint32_t, ChannelPath>> seen;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const auto channel = readChannel(animation, channels[c], clip.name);
      if (!channel) continue;
      if (!seen.emplace(channel->bone, channel->path).second) {
        channels[c].fail("the clip animates this property of this node twice");
      }
      clip.channels.push_back(*channel);
    }
    checkLength(animation, clip);
    return clip;
  }

 private:
  // A time of 1e30 s in a file of 1 kB must not become as many key frames.
  void checkLength(const JsonRef& animation, const RawClip& clip) {
    double keys = 0.0, end = 0.0;
    for (const RawChannel& channel : clip.channels) {
      keys = std::max(keys, static_cast<double>(channel.times.size()));
      end = std::max(end, static_cast<double>(channel.times.back()));
    }
    const double poses =
        std::max(keys, 30.0 * end + 2.0) * static_cast<double>(skeleton_.skeleton.bones.size());
    if (poses > static_cast<double>(poses_left_)) {
      animation.fail(
          fmt::format("the clip's {} s for {} bones are more than fit", end, skeleton_.skeleton.bones.size()),
          "shorten the clip");
    }
    poses_left_ -= static_cast<std::uint64_t>(poses);
  }

  std::optional<RawChannel> readChannel(const JsonRef& animation, const JsonRef& json,
                                        const std::string& clip_name) {
    const JsonRef target = json.require("target");
    const auto path = readPath(target.require("path"));
    const auto node = document_.findIndex(target, "node", "nodes");
    const JsonRef samplers = animation.require("samplers");
    const std::uint64_t sampler = json.require("sampler").wholeNumber(0xffffffffu);
    if (sampler >= samplers.size()) {
      json.require("sampler").fail(fmt::format("there is no sampler number {}", sampler));
    }
    if (!path) {
      dropped_.add(fmt::format("morph targets in clip '{}'", clip_name));
      return std::nullopt;
    }
    if (!node) return std::nullopt;  // as the specification says
    const auto bone = skeleton_.bone_of_node.find(*node);
    if (bone == skeleton_.bone_of_node.end()) {
      dropped_.add(fmt::format("animation of node '{}', which is no bone", tree_.nodes[*node].label(*node)));
      return std::nullopt;
    }
    RawChannel channel;
    channel.bone = bone->second;
    channel.path = *path;
    readSampler(samplers[sampler], channel);
    return channel;
  }

  void readSampler(const JsonRef& sampler, RawChannel& channel) {
    channel.interpolation = readInterpolation(sampler);
    const JsonRef input = sampler.require("input"), output = sampler.require("output");
    const std::uint32_t input_index = document_.index(input, "accessors");
    const std::uint32_t output_index = document_.index(output, "accessors");
    const std::uint64_t keys = describeAccessor(document_, input_index).count;
    if (keys == 0) input.fail("the channel has no keys");
    if (keys > keys_left_) {
      input.fail(fmt::format("more than the {} keys allowed in a file", document_.options().max_keys),
                 "export at a lower frame rate");
    }
    keys_left_ -= keys;
    const std::uint64_t values_a_key = channel.interpolation == Interpolation::kCubicSpline ? 3 : 1;
    const std::uint64_t values = describeAccessor(document_, output_index).count;
    if (values != keys * values_a_key) output.fail(fmt::format("{} values for {} keys", values, keys));
    channel.times = readFloats(document_, input_index, 1);
    for (std::size_t i = 0; i < channel.times.size(); ++i) {
      if (channel.times[i] < 0.0f) input.fail(fmt::format("key {} has a negative time", i));
      if (i > 0 && !(channel.times[i] > channel.times[i - 1])) {
        input.fail(fmt::format("the times do not ascend at key {}", i));
      }
    }
    readValues(output, output_index, channel);
  }

  void readValues(const JsonRef& output, std::uint32_t accessor, RawChannel& channel) {
    const std::uint32_t components = channel.path == ChannelPath::kRotation ? 4 : 3;
    const std::vector<float> numbers = readFloats(document_, accessor, components);
    const bool is_cubic = channel.interpolation == Interpolation::kCubicSpline;
    for (std::size_t i = 0; i < numbers.size() / components; ++i) {
      Vec4 value(0.0f);
      for (std::uint32_t c = 0; c < components; ++c) value[static_cast<int>(c)] = numbers[i * components + c];
      if (components == 4 && (!is_cubic || i % 3 == 1) && !(glm::length(value) > 1e-6f)) {
        output.fail(fmt::format("rotation {} is a quaternion of length 0", i));
      }
      channel.values.push_back(value);
    }
  }

  const GltfDocument& document_;
  const GltfSkeleton& skeleton_;
  const GltfNodes& tree_;
  DroppedList& dropped_;
  std::uint64_t keys_left_, poses_left_;
};

}  // namespace

std::vector<RawClip> readClips(const GltfDocument& document, const GltfSkeleton& skeleton,
                               const GltfNodes& tree, DroppedList& dropped) {
  ClipReader reader(document, skeleton, tree, dropped);
  std::vector<RawClip> clips;
  for (std::size_t i = 0; i < document.count("animations"); ++i) {
    RawClip clip = reader.read(i);
    if (!clip.channels.empty()) clips.push_back(std::move(clip));
  }
  return clips;
}

}  // namespace ensemble
