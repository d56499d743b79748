#include "assetpipe/people_garments.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "assetpipe/simplify_surface.h"
#include "core/check.h"

namespace ensemble {
namespace {

constexpr float kHemRounding = 0.005f;  // metres
constexpr float kCoverDepth = 0.0015f;  // metres that skin lies under the outside of what hides it

/// Labels every face, with the lines between labels cut straight.
void labelFaces(FieldMesh& mesh, const Field& solid, const GarmentDesign& design) {
  if (!design.label) return;
  for (const Field& seam : design.seams) snapToBorder(mesh, solid, seam, design.cell);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Triangle& face = mesh.faces[f];
    mesh.labels[f] =
        design.label((mesh.positions[face[0]] + mesh.positions[face[1]] + mesh.positions[face[2]]) / 3.0f);
    ENSEMBLE_CHECK(mesh.labels[f] < design.materials.size());
  }
}

/// Drops what lies deeper than the hem: the flat ends of the solid inside the openings.
FieldMesh dropInside(FieldMesh mesh, const Field& solid, const GarmentDesign& design) {
  const Field hem_line = [&design](const Vec3& p) { return design.shell(p) + design.hem; };
  snapToBorder(mesh, solid, hem_line, design.cell);
  std::vector<std::uint8_t> keep(mesh.faces.size());
  for (std::size_t f = 0; f < keep.size(); ++f) {
    const Triangle& face = mesh.faces[f];
    keep[f] = hem_line((mesh.positions[face[0]] + mesh.positions[face[1]] + mesh.positions[face[2]]) / 3.0f) > 0.0f;
  }
  return keepFaces(mesh, keep);
}

}  // namespace

MadeGarment makeGarment(const Figure& figure, const GarmentDesign& design) {
  const Field solid = [&design](const Vec3& p) {
    return smoothMax(design.shell(p), design.opening(p), kHemRounding);
  };
  FieldMesherOptions mesher{design.low, design.high, design.cell * figure.scale, design.symmetric};
  FieldMesh mesh = dropInside(meshField(solid, mesher), solid, design);
  labelFaces(mesh, solid, design);
  SimplifySurfaceOptions simplify;
  simplify.target_faces = design.symmetric ? design.face_count / 2 : design.face_count;
  simplify.importance = design.importance;
  mesh = simplifySurface(mesh, solid, simplify);
  if (design.symmetric) mesh = mirrored(mesh);

  MadeGarment made;
  made.materials = design.materials;
  made.node.name = "garment." + (design.name.starts_with("cloth.") ? design.name.substr(6) : design.name);
  for (std::uint32_t label = 0; label < design.materials.size(); ++label) {
    std::vector<std::uint8_t> keep(mesh.faces.size());
    for (std::size_t f = 0; f < keep.size(); ++f) keep[f] = mesh.labels[f] == label;
    const FieldMesh part = keepFaces(mesh, keep);
    if (part.faces.empty()) continue;
    RawPrimitive primitive;
    primitive.material = label;
    primitive.faces = part.faces;
    for (const Vec3& p : part.positions) {
      primitive.vertices.push_back(makeVertex(figure, solid, p, design.binding(p)));
    }
    made.node.primitives.push_back(std::move(primitive));
  }
  if (design.covers_skin) {
    made.cover = [shell = design.shell, opening = design.opening, margin = design.cover_margin](const Vec3& p) {
      return std::max(shell(p) + kCoverDepth, opening(p) + margin);
    };
  }
  return made;
}

std::vector<std::uint8_t> findCoveredFaces(const FieldMesh& body, const std::vector<const MadeGarment*>& garments) {
  std::vector<std::uint8_t> covered(body.faces.size(), 0);
  for (const MadeGarment* garment : garments) {
    if (!garment->cover) continue;
    std::vector<std::uint8_t> under(body.positions.size());
    for (std::size_t v = 0; v < under.size(); ++v) under[v] = garment->cover(body.positions[v]) < 0.0f;
    for (std::size_t f = 0; f < covered.size(); ++f) {
      const Triangle& face = body.faces[f];
      if (under[face[0]] != 0 && under[face[1]] != 0 && under[face[2]] != 0) covered[f] = 1;
    }
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
