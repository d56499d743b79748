// glTF 2.0, sections 3.6 (binary data storage) and 4.4 (GLB).
#include "core/gltf_glb_builder.h"

#include <string>

#include "core/input_error.h"

namespace ensemble {
namespace {

constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;

void append32(std::uint64_t value, std::vector<std::byte>& bytes) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::byte>(value >> shift & 0xffu));
}

void padTo4(std::vector<std::byte>& bytes, std::byte filler) {
  while (bytes.size() % 4 != 0) bytes.push_back(filler);
}

}  // namespace

std::size_t GlbBuilder::addAccessor(ViewKind kind, std::span<const std::byte> bytes, std::size_t count,
                                    AccessorShape shape) {
  auto& index = view_of_kind_[static_cast<std::size_t>(kind)];
  if (!index) {
    index = views_.size();
    View view;
    if (kind == ViewKind::kIndices) {
      view.target = kElementArrayBuffer;
    } else if (kind != ViewKind::kInverseBind && kind != ViewKind::kAnimation) {
      view.target = kArrayBuffer;
      view.stride = static_cast<std::uint32_t>(bytes.size() / count);
    }
    views_.push_back(std::move(view));
  }
  std::vector<std::byte>& data = views_[*index].bytes;
  padTo4(data, std::byte{0});
  const std::size_t accessor = addEmptyAccessor(count, shape);
  accessors_[accessor]["bufferView"] = *index;
  accessors_[accessor]["byteOffset"] = data.size();
  data.insert(data.end(), bytes.begin(), bytes.end());
  return accessor;
}

std::size_t GlbBuilder::addEmptyAccessor(std::size_t count, AccessorShape shape) {
  accessors_.push_back({{"componentType", shape.component_type}, {"count", count}, {"type", shape.type}});
  return accessors_.size() - 1;
}

void GlbBuilder::setBounds(std::size_t accessor, std::span<const float> min, std::span<const float> max) {
  accessors_[accessor]["min"] = Json(std::vector<double>(min.begin(), min.end()));
  accessors_[accessor]["max"] = Json(std::vector<double>(max.begin(), max.end()));
}

std::size_t GlbBuilder::addView(std::span<const std::byte> bytes) {
  views_.push_back({{bytes.begin(), bytes.end()}, 0, 0});
  return views_.size() - 1;
}

std::vector<std::byte> GlbBuilder::finish() {
  std::vector<std::byte> bin;
  Json views = Json::array();
  for (View& view : views_) {
    Json entry{{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", view.bytes.size()}};
    if (view.stride != 0) entry["byteStride"] = view.stride;
    if (view.target != 0) entry["target"] = view.target;
    views.push_back(std::move(entry));
    bin.insert(bin.end(), view.bytes.begin(), view.bytes.end());
    padTo4(bin, std::byte{0});
    view.bytes = {};
  }
  if (!accessors_.empty()) json["accessors"] = accessors_;
  if (!views.empty()) {
    json["bufferViews"] = std::move(views);
    json["buffers"] = Json::array({{{"byteLength", bin.size()}}});
  }
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::uint64_t total = 12 + 8 + text.size() + (bin.empty() ? 0 : 8 + bin.size());
  if (total > 0xffffffffu) throw SystemError({"", "", "a GLB can't have 4 GiB or more", "split the asset"});
  std::vector<std::byte> file;
  file.reserve(total);
  append32(0x46546c67, file);  // "glTF"
  append32(2, file);
  append32(total, file);
  append32(text.size(), file);
  append32(0x4e4f534a, file);  // "JSON"
  const auto text_bytes = std::as_bytes(std::span(text));
  file.insert(file.end(), text_bytes.begin(), text_bytes.end());
  if (!bin.empty()) {
    append32(bin.size(), file);
    append32(0x004e4942, file);  // "BIN"
    file.insert(file.end(), bin.begin(), bin.end());
  }
  return file;
}

}  // namespace ensemble
