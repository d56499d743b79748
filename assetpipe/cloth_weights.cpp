// Weights of cloth: from the skin below, from both legs under a skirt, or from one joint. Where cloth that
// moves otherwise than the skin would sink into it in one of the template's clips, it follows the skin more
// closely.
#include <algorithm>
#include <array>
#include <cmath>

#include "assetpipe/cloth_mesh.h"
#include "core/check.h"

namespace ensemble {
namespace {

constexpr int kSmoothRounds = 4;
constexpr float kLeastWeight = 0.02f;
constexpr float kKeepOff = 0.005f;  // metres off the skin in motion, for cloth that is so far off at rest
constexpr std::size_t kFollowSteps = 4;  // from its own weights to the skin's

class ClothWeigher {
 public:
  ClothWeigher(const TailorFrame& frame, const GarmentRecipe& recipe, const FieldMesh& mesh)
      : frame_(frame),
        recipe_(recipe),
        mesh_(mesh),
        joint_count_(frame.body().body().skeleton.joints.size()) {}

  std::vector<SkinBinding> run() {
    const std::string joint = recipe_.attach ? recipe_.attach->value : "";
    if (!joint.empty() || recipe_.kind == GarmentKind::kHead) return ofOneJoint(joint);
    takeFromSkin();
    skin_rows_ = rows_;
    for (int round = 0; round < kSmoothRounds; ++round) smooth();
    if (recipe_.hang > 0.0f) {
      for (std::size_t v = 0; v < mesh_.positions.size(); ++v) hang(mesh_.positions[v], rows_[v]);
    }
    followSkin();
    std::vector<SkinBinding> result;
    for (const std::vector<float>& row : rows_) result.push_back(strongest(row));
    return result;
  }

 private:
  std::vector<SkinBinding> ofOneJoint(const std::string& name) const {
    SkinBinding skin;
    skin.joints[0] = frame_.marks().joint(Landmark::kHead);
    if (const auto joint = findJoint(frame_.body().body().skeleton, name)) skin.joints[0] = *joint;
    skin.weights[0] = 1.0f;
    return std::vector<SkinBinding>(mesh_.positions.size(), skin);
  }

  void takeFromSkin() {
    const BodySurface& surface = frame_.body().surface();
    const TemplateBody& body = frame_.body().body();
    for (const Vec3& p : mesh_.positions) {
      const NearestPoint at = surface.nearest(p);
      std::vector<float> row(joint_count_, 0.0f);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t source = surface.source()[surface.faces()[at.face][k]];
        const SkinBinding& skin = body.vertices[VertexId(source)].skin;
        for (std::size_t i = 0; i < 4; ++i) {
          row[skin.joints[i]] += at.shares[static_cast<int>(k)] * skin.weights[i];
        }
      }
      rows_.push_back(std::move(row));
      below_.push_back(at);
      // Tight cloth moves just as the skin does.
      looseness_.push_back(0.5f * smoothStep(0.003f, 0.014f, at.distance));
    }
  }

  void smooth() {
    std::vector<std::vector<float>> sums(rows_.size(), std::vector<float>(joint_count_, 0.0f));
    std::vector<float> counts(rows_.size(), 0.0f);
    for (const Triangle& face : mesh_.faces) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = face[k], to = face[(k + 1) % 3];
        for (std::size_t j = 0; j < joint_count_; ++j) {
          sums[from][j] += rows_[to][j];
          sums[to][j] += rows_[from][j];
        }
        counts[from] += 1.0f;
        counts[to] += 1.0f;
      }
    }
    for (std::size_t v = 0; v < rows_.size(); ++v) {
      if (counts[v] == 0.0f) continue;
      for (std::size_t j = 0; j < joint_count_; ++j)
        rows_[v][j] = glm::mix(rows_[v][j], sums[v][j] / counts[v], looseness_[v]);
    }
  }

  std::vector<float> mixed(std::size_t v, float share) const {
    std::vector<float> row(joint_count_);
    for (std::size_t j = 0; j < joint_count_; ++j) row[j] = glm::mix(rows_[v][j], skin_rows_[v][j], share);
    return row;
  }

  /// Whether a vertex that moves by these weights stays off the skin below it in all poses.
  bool staysOff(std::size_t v, const std::vector<float>& row) const {
    const BodySurface& surface = frame_.body().surface();
    const Vec3& p = mesh_.positions[v];
    const NearestPoint& below = below_[v];
    const Triangle& face = surface.faces()[below.face];
    const Vec3 normal = glm::cross(surface.positions()[face[1]] - surface.positions()[face[0]],
                                   surface.positions()[face[2]] - surface.positions()[face[0]]);
    const float height = glm::dot(p - below.point, glm::normalize(normal));
    const float least = std::min(0.8f * height, kKeepOff * frame_.scale());
    for (const PosedBody& posed : frame_.body().poses()) {
      Vec3 moved(0.0f);
      for (std::size_t j = 0; j < joint_count_; ++j) {
        if (row[j] > 0.0f) moved += row[j] * Vec3(posed.skinning_matrices[j] * Vec4(p, 1.0f));
      }
      if (heightOver(posed, surface, below, moved) < least) return false;
    }
    return true;
  }

  void followSkin() {
    if (frame_.body().poses().empty()) return;
    std::vector<float> shares(rows_.size(), 0.0f);
    for (std::size_t v = 0; v < rows_.size(); ++v) {
      for (std::size_t step = 0; step <= kFollowSteps; ++step) {
        shares[v] = static_cast<float>(step) / static_cast<float>(kFollowSteps);
        if (staysOff(v, mixed(v, shares[v]))) break;
      }
    }
    // Neighbours come along half-way, so that cloth does not tear.
    std::vector<float> spread = shares;
    for (const Triangle& face : mesh_.faces) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (const std::uint32_t other : {face[(k + 1) % 3], face[(k + 2) % 3]})
          spread[face[k]] = std::max(spread[face[k]], 0.5f * shares[other]);
      }
    }
    for (std::size_t v = 0; v < rows_.size(); ++v) rows_[v] = mixed(v, spread[v]);
  }

  /// A skirt swings with both legs, less than they do, and below the knees with the shins.
  void hang(const Vec3& p, std::vector<float>& row) const {
    const Landmarks& marks = frame_.marks();
    const float s = frame_.scale(), loose = recipe_.hang, hip = frame_.heightOf(0.0f);
    const float off_arms = smoothStep(-0.02f * s, 0.02f * s, frame_.offArms(p));
    const float hung = off_arms * smoothStep(-0.02f * s, 0.10f * s, frame_.heightOf(0.28f) - p.y);
    if (hung <= 0.0f) return;
    for (float& weight : row) weight *= 1.0f - hung;
    const float down = smoothStep(-0.05f * s, glm::mix(0.06f, 0.26f, loose) * s, hip - p.y);
    const float to_legs = hung * down * (1.0f - 0.45f * loose);
    const float half = glm::mix(0.045f, 0.17f, loose) * s;
    const float left =
        smoothStep(-half, half, p.x - frame_.legMiddle(0, hip).x * 0.5f - frame_.legMiddle(1, hip).x * 0.5f);
    const float shin = 0.75f * smoothStep(-0.04f * s, 0.25f * s, frame_.heightOf(-1.0f) - p.y);
    for (std::size_t side = 0; side < 2; ++side) {
      const float share = to_legs * (side == 0 ? left : 1.0f - left);
      row[marks.joint(Landmark::kHip, side)] += share * (1.0f - shin);
      row[marks.joint(Landmark::kKnee, side)] += share * shin;
    }
    row[marks.joint(Landmark::kPelvis)] += hung - to_legs;
  }

  /// The four largest weights, descending, summing to 1.
  static SkinBinding strongest(const std::vector<float>& row) {
    std::vector<std::uint16_t> order;
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (row[j] > kLeastWeight) order.push_back(static_cast<std::uint16_t>(j));
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint16_t a, std::uint16_t b) { return row[a] > row[b]; });
    order.resize(std::min<std::size_t>(order.size(), 4));
    ENSEMBLE_CHECK(!order.empty());
    SkinBinding skin;
    float sum = 0.0f;
    for (const std::uint16_t joint : order) sum += row[joint];
    for (std::size_t i = 0; i < order.size(); ++i) {
      skin.joints[i] = order[i];
      skin.weights[i] = row[order[i]] / sum;
    }
    return skin;
  }

  const TailorFrame& frame_;
  const GarmentRecipe& recipe_;
  const FieldMesh& mesh_;
  std::size_t joint_count_;
  std::vector<std::vector<float>> rows_, skin_rows_;
  std::vector<NearestPoint> below_;
  std::vector<float> looseness_;  // how much of its neighbours' weights a vertex takes in a round
};

}  // namespace

std::vector<SkinBinding> weighCloth(const TailorFrame& frame, const GarmentRecipe& recipe,
                                    const FieldMesh& mesh) {
  return ClothWeigher(frame, recipe, mesh).run();
}

}  // namespace ensemble
