// KHR_draco_mesh_compression; Draco bitstream 2.2, sections 3 (header) and 4 (connectivity).
#include "core/gltf_draco.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <new>

#include "core/check.h"
#include "core/input_error.h"

namespace ensemble {
namespace {

constexpr std::uint16_t kBitstreamVersion = 2 << 8 | 2;
constexpr std::uint16_t kMetadataFlag = 0x8000;

// Reads the start of Draco data, so that sizes are known before memory is spent on them.
class HeaderReader {
 public:
  HeaderReader(const JsonRef& ref, std::span<const std::byte> bytes) : ref_(ref), bytes_(bytes) {}

  std::uint8_t byte() {
    if (offset_ >= bytes_.size()) ref_.fail("the Draco data end in their header");
    return std::to_integer<std::uint8_t>(bytes_[offset_++]);
  }

  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const std::uint8_t next = byte();
      value |= std::uint64_t{next & 0x7fu} << shift;
      if ((next & 0x80u) == 0) return value;
    }
    ref_.fail("the Draco data announce an endless number");
  }

 private:
  const JsonRef& ref_;
  std::span<const std::byte> bytes_;
  std::size_t offset_ = 0;
};

void checkHeader(const JsonRef& ref, std::span<const std::byte> bytes, std::uint64_t max_faces,
                 std::uint64_t max_vertices) {
  HeaderReader reader(ref, bytes);
  for (const char expected : {'D', 'R', 'A', 'C', 'O'}) {
    if (reader.byte() != static_cast<std::uint8_t>(expected)) ref.fail("the data are not Draco's");
  }
  const int major = reader.byte(), minor = reader.byte();
  if ((major << 8 | minor) != kBitstreamVersion) {
    ref.fail(fmt::format("Draco version {}.{} instead of 2.2", major, minor));
  }
  if (reader.byte() != draco::TRIANGULAR_MESH) ref.fail("the Draco data are no triangle mesh");
  const int method = reader.byte();
  if (method > draco::MESH_EDGEBREAKER_ENCODING) ref.fail(fmt::format("unknown Draco method {}", method));
  const int flags = reader.byte() | reader.byte() << 8;
  if ((flags & kMetadataFlag) != 0) ref.fail("Draco metadata are not supported", "export without metadata");
  std::uint64_t faces = 0, vertices = 0;
  if (method == draco::MESH_EDGEBREAKER_ENCODING) {
    reader.byte();  // kind of traversal
    vertices = reader.varint();
    faces = reader.varint();
  } else {
    faces = reader.varint();
    vertices = reader.varint();
  }
  if (faces > max_faces || vertices > max_vertices) {
    ref.fail(fmt::format("the Draco data announce {} faces and {} vertices, the accessors {} and {}", faces,
                         vertices, max_faces, max_vertices));
  }
}

const draco::PointAttribute& findAttribute(const draco::Mesh& mesh, const JsonRef& unique_id,
                                           std::uint32_t components) {
  const auto id = static_cast<std::uint32_t>(unique_id.wholeNumber(0xffffffffu));
  const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id);
  if (attribute == nullptr) unique_id.fail(fmt::format("the Draco data have no attribute {}", id));
  if (static_cast<std::uint32_t>(attribute->num_components()) != components) {
    unique_id.fail(fmt::format("the Draco attribute has {} components, the accessor {}",
                               static_cast<int>(attribute->num_components()), components));
  }
  // Draco reads these unchecked, as a bool that may be neither.
  if (attribute->data_type() == draco::DT_BOOL) {
    unique_id.fail("the Draco attribute holds truth values, which glTF has none of");
  }
  return *attribute;
}

template <class T>
std::vector<T> readAttribute(const draco::Mesh& mesh, const JsonRef& unique_id, std::uint32_t components) {
  const draco::PointAttribute& attribute = findAttribute(mesh, unique_id, components);
  std::vector<T> result(std::size_t{mesh.num_points()} * components);
  for (std::uint32_t point = 0; point < mesh.num_points(); ++point) {
    const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(point));
    if (value.value() >= attribute.size() ||
        !attribute.ConvertValue<T>(value, static_cast<std::int8_t>(components),
                                   &result[point * components])) {
      unique_id.fail(fmt::format("the Draco attribute has no value for vertex {}", point));
    }
  }
  return result;
}

// Adds an attribute with one value per vertex; `values` is #V by components, tightly packed.
template <class T>
std::uint32_t addAttribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data_type,
                           std::span<const T> values) {
  const std::uint32_t count = mesh.num_points();
  const std::size_t components = values.size() / count;
  draco::GeometryAttribute attribute;
  attribute.Init(type, nullptr, static_cast<std::int8_t>(components), data_type, false,
                 static_cast<std::int64_t>(components * sizeof(T)), 0);
  const int id = mesh.AddAttribute(attribute, true, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i * components]);
  }
  return mesh.attribute(id)->unique_id();
}

// Gathers one attribute of all vertices.
template <class T, class Get>
std::vector<T> gather(const RawPrimitive& primitive, const Get& get) {
  std::vector<T> values;
  for (const RawVertex& vertex : primitive.vertices) get(vertex, values);
  return values;
}

void appendVec3(const Vec3& v, std::vector<float>& values) { values.insert(values.end(), {v.x, v.y, v.z}); }

std::map<std::string, std::uint32_t> addAttributes(const RawPrimitive& primitive,
                                                   const PrimitiveLayout& layout, draco::Mesh& mesh) {
  using Attribute = draco::GeometryAttribute;
  const auto floats = [&](const char* name, Attribute::Type type, const std::vector<float>& values) {
    return std::pair(name, addAttribute<float>(mesh, type, draco::DT_FLOAT32, values));
  };
  std::map<std::string, std::uint32_t> ids;
  ids.insert(
      floats("POSITION", Attribute::POSITION,
             gather<float>(primitive, [](const RawVertex& v, auto& out) { appendVec3(v.position, out); })));
  ids.insert(floats("NORMAL", Attribute::NORMAL, gather<float>(primitive, [](const RawVertex& v, auto& out) {
                      appendVec3(v.normal, out);
                    })));
  if (layout.uv) {
    ids.insert(floats("TEXCOORD_0", Attribute::TEX_COORD,
                      gather<float>(primitive, [](const RawVertex& v, auto& out) {
                        out.insert(out.end(), {v.uv.x, v.uv.y});
                      })));
  }
  if (layout.skin) {
    const auto joints = gather<std::uint16_t>(primitive, [](const RawVertex& v, auto& out) {
      out.insert(out.end(), v.skin.joints.begin(), v.skin.joints.end());
    });
    if (layout.wide_joints) {
      ids["JOINTS_0"] = addAttribute<std::uint16_t>(mesh, Attribute::GENERIC, draco::DT_UINT16, joints);
    } else {
      const std::vector<std::uint8_t> narrow(joints.begin(), joints.end());
      ids["JOINTS_0"] = addAttribute<std::uint8_t>(mesh, Attribute::GENERIC, draco::DT_UINT8, narrow);
    }
    ids.insert(
        floats("WEIGHTS_0", Attribute::GENERIC, gather<float>(primitive, [](const RawVertex& v, auto& out) {
                 out.insert(out.end(), v.skin.weights.begin(), v.skin.weights.end());
               })));
  }
  if (layout.template_vertices) {
    const std::vector<float> numbers(primitive.template_vertices.begin(), primitive.template_vertices.end());
    ids.insert(floats("_TEMPLATE_VERTEX", Attribute::GENERIC, numbers));
  }
  if (layout.collapses && layout.wide_collapses) {
    ids.insert(floats("_COLLAPSE", Attribute::GENERIC, collapseValues<float>(primitive)));
  } else if (layout.collapses) {
    ids["_COLLAPSE"] = addAttribute<std::uint16_t>(mesh, Attribute::GENERIC, draco::DT_UINT16,
                                                   collapseValues<std::uint16_t>(primitive));
  }
  return ids;
}

// Reads the data back: that its numbers stayed is the promise that body meshes rest on.
void measureDecoded(const RawPrimitive& primitive, DracoData& data) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(data.bytes.data()), data.bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  ENSEMBLE_CHECK(decoded.ok());
  const draco::Mesh& mesh = *decoded.value();
  ENSEMBLE_CHECK(mesh.num_points() == primitive.vertices.size());
  ENSEMBLE_CHECK(mesh.num_faces() == primitive.faces.size());
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
    for (std::size_t c = 0; c < 3; ++c) ENSEMBLE_CHECK(face[c].value() == primitive.faces[f][c]);
  }
  const draco::PointAttribute* positions = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  data.position_min = Vec3(INFINITY);
  data.position_max = Vec3(-INFINITY);
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    Vec3 position;
    positions->GetMappedValue(draco::PointIndex(i), &position[0]);
    data.position_min = glm::min(data.position_min, position);
    data.position_max = glm::max(data.position_max, position);
  }
}

}  // namespace

DracoMesh::DracoMesh(const JsonRef& ref, std::span<const std::byte> bytes, std::uint64_t max_faces,
                     std::uint64_t max_vertices) {
  checkHeader(ref, bytes, max_faces, max_vertices);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::Decoder decoder;
  try {
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) ref.fail("the Draco data are damaged");
    mesh_ = std::move(decoded).value();
  } catch (const std::bad_alloc&) {
    ref.fail("the Draco data ask for more memory than there is");
  } catch (const std::length_error&) {
    ref.fail("the Draco data ask for more memory than there is");
  }
  // Whether integers are normalised is for the accessor to say, and encoders differ in what they tell Draco;
  // Draco itself takes the flag from the file unchecked, as a bool that may be neither.
  for (int i = 0; i < mesh_->num_attributes(); ++i) mesh_->attribute(i)->set_normalized(false);
  if (mesh_->num_faces() > max_faces || mesh_->num_points() > max_vertices) {
    ref.fail(fmt::format("the Draco data hold {} faces and {} vertices, the accessors {} and {}",
                         mesh_->num_faces(), mesh_->num_points(), max_faces, max_vertices));
  }
}

DracoMesh::~DracoMesh() = default;
DracoMesh::DracoMesh(DracoMesh&&) noexcept = default;

std::uint64_t DracoMesh::vertexCount() const { return mesh_->num_points(); }

std::vector<std::uint32_t> DracoMesh::indices() const {
  std::vector<std::uint32_t> result;
  result.reserve(std::size_t{mesh_->num_faces()} * 3);
  for (std::uint32_t f = 0; f < mesh_->num_faces(); ++f) {
    for (const draco::PointIndex& corner : mesh_->face(draco::FaceIndex(f))) result.push_back(corner.value());
  }
  return result;
}

std::vector<float> DracoMesh::floats(const JsonRef& unique_id, const GltfAccessor& accessor) const {
  std::vector<float> values = readAttribute<float>(*mesh_, unique_id, accessor.components);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (accessor.normalized)
      values[i] = static_cast<float>(fractionOf(static_cast<double>(values[i]), accessor.component));
    if (!std::isfinite(values[i])) {
      unique_id.fail(fmt::format("element {} is not a finite number", i / accessor.components));
    }
  }
  return values;
}

std::vector<std::uint32_t> DracoMesh::unsignedIntegers(const JsonRef& unique_id,
                                                       const GltfAccessor& accessor) const {
  const draco::DataType type = findAttribute(*mesh_, unique_id, accessor.components).data_type();
  if (type == draco::DT_FLOAT32 || type == draco::DT_FLOAT64) unique_id.fail("expected unsigned integers");
  return readAttribute<std::uint32_t>(*mesh_, unique_id, accessor.components);
}

DracoData encodeDraco(const RawPrimitive& primitive, const PrimitiveLayout& layout,
                      const GlbWriteOptions& options) {
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(primitive.vertices.size()));
  mesh.SetNumFaces(primitive.faces.size());
  for (std::uint32_t f = 0; f < primitive.faces.size(); ++f) {
    const Triangle& face = primitive.faces[f];
    mesh.SetFace(draco::FaceIndex(f),
                 {draco::PointIndex(face[0]), draco::PointIndex(face[1]), draco::PointIndex(face[2])});
  }
  DracoData data;
  data.attribute_ids = addAttributes(primitive, layout, mesh);
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
  encoder.options().SetGlobalBool("compress_connectivity", true);
  encoder.SetSpeedOptions(0, 0);
  using Attribute = draco::GeometryAttribute;
  encoder.SetAttributeQuantization(Attribute::POSITION, options.draco_position_bits);
  encoder.SetAttributeQuantization(Attribute::NORMAL, options.draco_normal_bits);
  encoder.SetAttributeQuantization(Attribute::TEX_COORD, options.draco_uv_bits);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer);
  if (!status.ok()) {
    throw SystemError(
        {"", "", fmt::format("Draco can't compress the mesh ({})", status.error_msg_string()), ""});
  }
  data.bytes.resize(buffer.size());
  std::memcpy(data.bytes.data(), buffer.data(), buffer.size());
  measureDecoded(primitive, data);
  return data;
}

}  // namespace ensemble
