#include "assetpipe/people_garments.h"

#include <algorithm>
#include <map>
#include <utility>

#include "assetpipe/simplify_surface.h"
#include "core/check.h"

namespace ensemble {
namespace {

constexpr float kCoverDepth = 0.0015f;  // metres that skin lies under the outside of what hides it

Vec3 middleOf(const FieldMesh& mesh, std::size_t face) {
  const Triangle& corners = mesh.faces[face];
  return (mesh.positions[corners[0]] + mesh.positions[corners[1]] + mesh.positions[corners[2]]) / 3.0f;
}

/// The cloth's outside, cut along the edges of its openings.
FieldMesh cutShell(const Figure& figure, const GarmentDesign& design) {
  const FieldMesherOptions mesher{design.low, design.high, design.cell * figure.scale, design.symmetric};
  FieldMesh mesh = meshField(design.shell, mesher);
  snapToBorder(mesh, design.shell, design.opening, mesher.cell);
  std::vector<std::uint8_t> keep(mesh.faces.size());
  for (std::size_t f = 0; f < keep.size(); ++f) keep[f] = design.opening(middleOf(mesh, f)) < 0.0f;
  mesh = keepFaces(mesh, keep);
  if (!design.label) return mesh;
  for (const Field& seam : design.seams) snapToBorder(mesh, design.shell, seam, mesher.cell);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    mesh.labels[f] = design.label(middleOf(mesh, f));
    ENSEMBLE_CHECK(mesh.labels[f] < design.materials.size());
  }
  return mesh;
}

/// Edges that one face has, as that face runs along them, with the face's label.
struct BorderEdge {
  std::uint32_t from, to;
  std::uint8_t label;
};

std::vector<BorderEdge> borderEdges(const FieldMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint8_t> edges;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Triangle& face = mesh.faces[f];
    for (int corner = 0; corner < 3; ++corner) {
      edges.emplace(std::pair(face[corner], face[(corner + 1) % 3]), mesh.labels[f]);
    }
  }
  std::vector<BorderEdge> borders;
  for (const auto& [edge, label] : edges) {
    if (!edges.contains({edge.second, edge.first})) borders.push_back({edge.first, edge.second, label});
  }
  return borders;
}

/// Fills the primitive of each label with vertices as faces ask for them.
class PrimitiveBuilder {
 public:
  PrimitiveBuilder(const Figure& figure, const GarmentDesign& design, const FieldMesh& mesh)
      : figure_(figure),
        design_(design),
        mesh_(mesh),
        primitives_(design.materials.size()),
        numbers_(design.materials.size(), std::vector<std::uint32_t>(mesh.positions.size() * 3, ~0u)) {}

  void addFaces() {
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      const std::uint8_t label = mesh_.labels[f];
      const Triangle& face = mesh_.faces[f];
      primitives_[label].faces.push_back(
          {outer(label, face[0]), outer(label, face[1]), outer(label, face[2])});
    }
  }

  /// Edges turned in towards the skin: a strip that faces out of the opening.
  void addHems() {
    for (const BorderEdge& edge : borderEdges(mesh_)) {
      std::vector<Triangle>& faces = primitives_[edge.label].faces;
      const std::uint32_t a = hem(edge.label, edge.from, 1), b = hem(edge.label, edge.to, 1);
      const std::uint32_t inner_a = hem(edge.label, edge.from, 2), inner_b = hem(edge.label, edge.to, 2);
      faces.push_back({b, a, inner_a});
      faces.push_back({b, inner_a, inner_b});
    }
  }

  std::vector<RawPrimitive> take() {
    std::vector<RawPrimitive> result;
    for (std::uint32_t label = 0; label < primitives_.size(); ++label) {
      primitives_[label].material = label;
      if (!primitives_[label].faces.empty()) result.push_back(std::move(primitives_[label]));
    }
    return result;
  }

 private:
  std::uint32_t& number(std::uint8_t label, std::uint32_t vertex, std::size_t kind) {
    return numbers_[label][vertex * 3 + kind];
  }

  std::uint32_t append(std::uint8_t label, const RawVertex& vertex) {
    primitives_[label].vertices.push_back(vertex);
    return static_cast<std::uint32_t>(primitives_[label].vertices.size() - 1);
  }

  std::uint32_t outer(std::uint8_t label, std::uint32_t vertex) {
    std::uint32_t& known = number(label, vertex, 0);
    if (known == ~0u) {
      const Vec3& p = mesh_.positions[vertex];
      known = append(label, makeVertex(figure_, design_.shell, p, design_.binding(p)));
    }
    return known;
  }

  /// kind 1: on the edge; kind 2: turned in.
  std::uint32_t hem(std::uint8_t label, std::uint32_t vertex, std::size_t kind) {
    std::uint32_t& known = number(label, vertex, kind);
    if (known == ~0u) {
      const Vec3& p = mesh_.positions[vertex];
      RawVertex made = makeVertex(figure_, design_.shell, p, design_.binding(p));
      const Vec3 outside = fieldNormal(design_.opening, p);
      const Vec3 sideways = outside - made.normal * glm::dot(outside, made.normal);
      if (kind == 2) made.position -= design_.hem * (made.normal + 0.4f * outside);
      if (glm::length(sideways) > 0.1f) made.normal = glm::normalize(sideways);
      known = append(label, made);
    }
    return known;
  }

  const Figure& figure_;
  const GarmentDesign& design_;
  const FieldMesh& mesh_;
  std::vector<RawPrimitive> primitives_;
  std::vector<std::vector<std::uint32_t>> numbers_;  // by label: three numbers a vertex
};

}  // namespace

MadeGarment makeGarment(const Figure& figure, const GarmentDesign& design) {
  FieldMesh mesh = cutShell(figure, design);
  SimplifySurfaceOptions simplify;
  simplify.target_faces = design.symmetric ? design.face_count / 2 : design.face_count;
  simplify.importance = design.importance;
  mesh = simplifySurface(mesh, design.shell, simplify);
  if (design.symmetric) mesh = mirrored(mesh);

  PrimitiveBuilder builder(figure, design, mesh);
  builder.addFaces();
  builder.addHems();
  MadeGarment made;
  made.materials = design.materials;
  made.node.name = "garment." + (design.name.starts_with("cloth.") ? design.name.substr(6) : design.name);
  made.node.primitives = builder.take();
  if (design.covers_skin) {
    made.cover = [shell = design.shell, opening = design.opening,
                  margin = design.cover_margin](const Vec3& p) {
      return shell(p) + kCoverDepth < 0.0f ? std::max(-opening(p) / margin, 0.0f) : 0.0f;
    };
  }
  return made;
}

std::vector<std::uint8_t> findCoveredFaces(const FieldMesh& body,
                                           const std::vector<const MadeGarment*>& garments) {
  // How far a point lies from the edges adds up over what covers it: the ankle is under the trousers'
  // hem and in the shoe, near the edge of each and yet well hidden.
  std::vector<float> depths(body.positions.size(), 0.0f);
  for (const MadeGarment* garment : garments) {
    if (!garment->cover) continue;
    for (std::size_t v = 0; v < depths.size(); ++v) depths[v] += garment->cover(body.positions[v]);
  }
  std::vector<std::uint8_t> covered(body.faces.size());
  for (std::size_t f = 0; f < covered.size(); ++f) {
    const Triangle& face = body.faces[f];
    covered[f] = depths[face[0]] >= 1.0f && depths[face[1]] >= 1.0f && depths[face[2]] >= 1.0f;
  }
  return covered;
}

RawMaterial clothMaterial(const std::string& name, const Vec3& linear_color) {
  RawMaterial material;
  material.name = name;
  material.base_color = Vec4(linear_color, 1.0f);
  material.double_sided = true;
  return material;
}

}  // namespace ensemble
