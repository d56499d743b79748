#include "assetpipe/cloth_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include "assetpipe/fit_in_motion.h"
#include "assetpipe/simplify_surface.h"
#include "core/check.h"

namespace ensemble {
namespace {

constexpr float kClearance = 0.0015f;  // metres off the body, of the finished cloth
constexpr float kLeastPiece = 0.02f;   // pieces with fewer faces than this share of the largest are crumbs
constexpr int kMotionRounds = 3;
constexpr float kCutRoom = 0.02f;  // metres that cloth is meshed beyond its openings

Vec3 middleOf(const FieldMesh& mesh, const Triangle& face) {
  return (mesh.positions[face[0]] + mesh.positions[face[1]] + mesh.positions[face[2]]) / 3.0f;
}

/// Drops what is not connected with one of the large pieces: the inside of the mouth, crumbs at cuts.
FieldMesh withoutCrumbs(const FieldMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = v;
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& face : mesh.faces) {
    for (std::size_t k = 0; k < 2; ++k) {
      const std::uint32_t a = root(face[k]), b = root(face[k + 1]);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<std::size_t> counts(parent.size(), 0);
  std::size_t largest = 0;
  for (const Triangle& face : mesh.faces) largest = std::max(largest, ++counts[root(face[0])]);
  std::vector<std::uint8_t> keep(mesh.faces.size());
  for (std::size_t f = 0; f < keep.size(); ++f) {
    const std::size_t count = counts[root(mesh.faces[f][0])];
    keep[f] = static_cast<float>(count) >= kLeastPiece * static_cast<float>(largest) ? 1 : 0;
  }
  return keepFaces(mesh, keep);
}

void labelTrims(FieldMesh& mesh, const ClothDesign& design) {
  for (const ClothTrim& trim : design.trims) snapToBorder(mesh, design.shell, trim.inside, design.cell);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Vec3 middle = middleOf(mesh, mesh.faces[f]);
    for (std::size_t t = 0; t < design.trims.size(); ++t) {
      if (design.trims[t].inside(middle) > 0.0f) mesh.labels[f] = static_cast<std::uint8_t>(t + 1);
    }
  }
}

/// Poses of a garment as of a body.
std::vector<PosedBody> poseCloth(const ClothPiece& cloth, const BodySurface& surface,
                                 const std::vector<PosedBody>& poses) {
  std::vector<Vec3> positions;
  std::vector<SkinBinding> skins;
  for (const std::uint32_t source : surface.source()) {
    positions.push_back(cloth.mesh.positions[source]);
    skins.push_back(cloth.skins[source]);
  }
  std::vector<PosedBody> result;
  for (const PosedBody& pose : poses) {
    result.push_back({pose.skinning_matrices, posedPositions(positions, skins, pose.skinning_matrices)});
  }
  return result;
}

/// Lifts cloth off body and garments below, at rest and in motion.
void fitToWear(const TailorFrame& frame, const GarmentRecipe& recipe, std::span<const ClothPiece> below,
               FieldMesh& mesh) {
  const std::vector<PosedBody>& poses = frame.body().poses();
  std::vector<std::unique_ptr<BodySurface>> surfaces;
  std::vector<std::vector<PosedBody>> posed;
  for (const ClothPiece& cloth : below) {
    surfaces.push_back(std::make_unique<BodySurface>(cloth.mesh.positions, cloth.mesh.faces));
    posed.push_back(poseCloth(cloth, *surfaces.back(), poses));
    fitOverCloth(mesh, *surfaces.back(), kClearance);
  }
  for (int round = 0; round < kMotionRounds; ++round) {
    bool moved = liftInMotion(mesh, weighCloth(frame, recipe, mesh), frame.body().surface(), poses);
    for (std::size_t i = 0; i < below.size(); ++i)
      moved = liftInMotion(mesh, weighCloth(frame, recipe, mesh), *surfaces[i], posed[i]) || moved;
    if (!moved) break;
  }
}

}  // namespace

ClothPiece meshCloth(const TailorFrame& frame, const GarmentRecipe& recipe, const ClothDesign& design,
                     std::span<const ClothPiece> below) {
  FieldMesherOptions mesher;
  mesher.low = design.low;
  mesher.high = design.high;
  mesher.cell = design.cell;
  // Closed a little beyond the openings, so that hands and head need not be meshed only to be cut off.
  const float room = kCutRoom * frame.scale();
  const Field meshed = [&design, room](const Vec3& p) {
    return std::max(design.shell(p), design.opening(p) - room);
  };
  FieldMesh mesh = meshField(meshed, mesher);
  if (mesh.faces.empty()) return {};
  snapToBorder(mesh, design.shell, design.opening, mesher.cell);
  std::vector<std::uint8_t> keep(mesh.faces.size());
  for (std::size_t f = 0; f < keep.size(); ++f)
    keep[f] = design.opening(middleOf(mesh, mesh.faces[f])) < 0.0f;
  mesh = withoutCrumbs(keepFaces(mesh, keep));
  labelTrims(mesh, design);
  SimplifySurfaceOptions simplify;
  simplify.target_faces = recipe.triangles;
  mesh = simplifySurface(mesh, design.shell, simplify);
  fitOverBody(mesh, frame.body().surface(), kClearance);
  if (recipe.kind != GarmentKind::kHead) fitToWear(frame, recipe, below, mesh);
  std::vector<SkinBinding> skins = weighCloth(frame, recipe, mesh);
  return {std::move(mesh), std::move(skins)};
}

namespace {

/// Edges that one face has, as that face runs along them.
struct BorderEdge {
  std::uint32_t from, to, face;
};

std::vector<BorderEdge> borderEdges(const FieldMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges;
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    const Triangle& face = mesh.faces[f];
    for (std::size_t k = 0; k < 3; ++k) edges.emplace(std::pair(face[k], face[(k + 1) % 3]), f);
  }
  std::vector<BorderEdge> borders;
  for (const auto& [edge, face] : edges) {
    if (!edges.contains({edge.second, edge.first})) borders.push_back({edge.first, edge.second, face});
  }
  return borders;
}

Vec3 unit(const Vec3& v, const Vec3& otherwise) {
  const float length = glm::length(v);
  return length > 1e-9f ? v / length : otherwise;
}

/// Which way a texture is wrapped around: the trunk, an arm or a leg.
struct Chart {
  Vec3 origin{0.0f}, axis{0.0f, 1.0f, 0.0f}, front{0.0f, 0.0f, 1.0f};
  std::uint32_t number = 0;
};

class Sewer {
 public:
  Sewer(const TailorFrame& frame, const GarmentRecipe& recipe, const ClothPiece& cloth)
      : frame_(frame),
        recipe_(recipe),
        mesh_(cloth.mesh),
        skins_(cloth.skins),
        primitives_(recipe.trims.size() + 1),
        normals_(mesh_.positions.size(), Vec3(0.0f)),
        outwards_(mesh_.positions.size(), Vec3(0.0f)) {
    for (const Triangle& face : mesh_.faces) {
      const Vec3 area = glm::cross(at(face[1]) - at(face[0]), at(face[2]) - at(face[0]));
      for (const std::uint32_t v : face) normals_[v] += area;
    }
    for (Vec3& normal : normals_) normal = unit(normal, Vec3(0, 1, 0));
  }

  std::vector<RawPrimitive> run() {
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) addFace(f);
    addHems();
    std::vector<RawPrimitive> result;
    for (std::uint32_t label = 0; label < primitives_.size(); ++label) {
      primitives_[label].material = label;
      if (!primitives_[label].faces.empty()) result.push_back(std::move(primitives_[label]));
    }
    return result;
  }

 private:
  const Vec3& at(std::uint32_t v) const { return mesh_.positions[v]; }

  /// One vertex for each position, kind (0 outside, 1 edge, 2 turned in), chart and turn of the texture.
  std::uint32_t vertex(std::uint8_t label, std::uint32_t v, std::uint32_t kind, const Chart& chart,
                       int turn) {
    const auto key = std::tuple(label, v, kind, chart.number, turn);
    RawPrimitive& primitive = primitives_[label];
    const auto [entry, is_new] =
        known_.try_emplace(key, static_cast<std::uint32_t>(primitive.vertices.size()));
    if (!is_new) return entry->second;
    RawVertex made;
    made.position = at(v);
    made.normal = normals_[v];
    made.uv = textureAt(chart, at(v)) + Vec2(static_cast<float>(turn) * turnWidth(chart), 0.0f);
    made.skin = skins_[v];
    if (kind > 0) {
      const Vec3 out = unit(outwards_[v] - normals_[v] * glm::dot(outwards_[v], normals_[v]), normals_[v]);
      if (kind == 2) made.position = turnedIn(v, out);
      made.normal = out;
    }
    primitive.vertices.push_back(made);
    return entry->second;
  }

  /// Where the edge at v ends when it is turned in towards the skin, but not into it.
  Vec3 turnedIn(std::uint32_t v, const Vec3& out) const {
    constexpr float kOffSkin = 0.0006f;
    const BodySurface& body = frame_.body().surface();
    const float thickness = recipe_.thickness * frame_.scale();
    Vec3 p = at(v) - thickness * (normals_[v] + 0.35f * out);
    for (int step = 0; step < 3; ++step) {
      const NearestPoint near = body.nearest(p);
      const Vec3 side = unit(body.sideNormal(near), normals_[v]);
      const float distance = glm::dot(p - near.point, side) < 0.0f ? -near.distance : near.distance;
      if (distance >= kOffSkin) break;
      p += side * (kOffSkin - distance + 1e-5f);
    }
    return p;
  }

  void addFace(std::size_t f) {
    const Triangle& face = mesh_.faces[f];
    const std::uint8_t label = mesh_.labels[f];
    const Chart chart = chartOf(middleOf(mesh_, face));
    Triangle made{};
    for (std::size_t k = 0; k < 3; ++k)
      made[k] = vertex(label, face[k], 0, chart, turnOf(chart, face[0], face[k]));
    primitives_[label].faces.push_back(made);
  }

  /// A strip that faces out of each opening.
  void addHems() {
    const std::vector<BorderEdge> borders = borderEdges(mesh_);
    for (const BorderEdge& edge : borders) {
      const Triangle& face = mesh_.faces[edge.face];
      const Vec3 normal = glm::cross(at(face[1]) - at(face[0]), at(face[2]) - at(face[0]));
      const Vec3 out = unit(glm::cross(at(edge.to) - at(edge.from), normal), Vec3(0.0f));
      outwards_[edge.from] += out;
      outwards_[edge.to] += out;
    }
    for (const BorderEdge& edge : borders) {
      const std::uint8_t label = mesh_.labels[edge.face];
      const Chart chart = chartOf(middleOf(mesh_, mesh_.faces[edge.face]));
      const int turn = turnOf(chart, edge.from, edge.to);
      const std::uint32_t a = vertex(label, edge.from, 1, chart, 0),
                          b = vertex(label, edge.to, 1, chart, turn);
      const std::uint32_t inner_a = vertex(label, edge.from, 2, chart, 0),
                          inner_b = vertex(label, edge.to, 2, chart, turn);
      primitives_[label].faces.push_back({b, a, inner_a});
      primitives_[label].faces.push_back({b, inner_a, inner_b});
    }
  }

  bool isTextured() const { return recipe_.pattern.kind != PatternKind::kNone || !recipe_.texture.empty(); }
  float repeat() const {
    return frame_.scale() * (recipe_.texture.empty() ? recipe_.pattern.size : recipe_.texture_size);
  }

  Chart chartOf(const Vec3& p) const {
    Chart chart;
    if (!isTextured()) return chart;
    const std::size_t side = TailorFrame::sideOf(p);
    chart.origin = 0.5f * (frame_.legMiddle(0, p.y) + frame_.legMiddle(1, p.y));
    chart.origin.y = 0.0f;
    if (recipe_.kind != GarmentKind::kBody) return chart;
    const bool on_arm = frame_.offArms(p) < 0.0f;
    const Landmarks& marks = frame_.marks();
    if (on_arm) {
      const bool upper = frame_.armPlace(p) < 1.0f;
      const Vec3 from = marks.at(upper ? Landmark::kShoulder : Landmark::kElbow, side);
      const Vec3 to = marks.at(upper ? Landmark::kElbow : Landmark::kWrist, side);
      chart = {from,
               glm::normalize(from - to),
               {0, 0, 1},
               static_cast<std::uint32_t>(1 + side * 2 + (upper ? 0 : 1))};
    } else if (!recipe_.drape && p.y < frame_.heightOf(-0.15f)) {
      const Vec3 from = marks.at(Landmark::kHip, side), to = marks.at(Landmark::kAnkle, side);
      chart = {from, glm::normalize(from - to), {0, 0, 1}, static_cast<std::uint32_t>(5 + side)};
    }
    return chart;
  }

  float angleAt(const Chart& chart, const Vec3& p) const {
    const Vec3 across = glm::normalize(glm::cross(chart.axis, chart.front));
    const Vec3 front = glm::cross(across, chart.axis);
    const Vec3 from = p - chart.origin;
    return std::atan2(glm::dot(from, across), glm::dot(from, front));
  }

  /// A whole number of repeats goes around, so that the texture has no seam.
  float turnWidth(const Chart& chart) const {
    if (!isTextured()) return 0.0f;
    const float around = (chart.number == 0 ? 0.95f : chart.number < 5 ? 0.32f : 0.5f) * frame_.scale();
    return std::max(std::round(around / repeat()), 1.0f);
  }

  Vec2 textureAt(const Chart& chart, const Vec3& p) const {
    if (!isTextured()) return {p.x + 0.5f, 1.0f - p.y};
    return {turnWidth(chart) * angleAt(chart, p) / (2.0f * kPi),
            -glm::dot(p - chart.origin, chart.axis) / repeat()};
  }

  /// Turns that bring v to the side of the seam where `first` is.
  int turnOf(const Chart& chart, std::uint32_t first, std::uint32_t v) const {
    if (!isTextured()) return 0;
    const float apart = angleAt(chart, at(v)) - angleAt(chart, at(first));
    return apart > kPi ? -1 : apart < -kPi ? 1 : 0;
  }

  const TailorFrame& frame_;
  const GarmentRecipe& recipe_;
  const FieldMesh& mesh_;
  const std::vector<SkinBinding>& skins_;
  std::vector<RawPrimitive> primitives_;
  std::vector<Vec3> normals_, outwards_;
  std::map<std::tuple<std::uint8_t, std::uint32_t, std::uint32_t, std::uint32_t, int>, std::uint32_t> known_;
};

}  // namespace

std::vector<RawPrimitive> sewCloth(const TailorFrame& frame, const GarmentRecipe& recipe,
                                   const ClothPiece& cloth) {
  return Sewer(frame, recipe, cloth).run();
}

}  // namespace ensemble
