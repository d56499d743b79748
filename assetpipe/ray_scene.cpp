#include "assetpipe/ray_scene.h"

#include <embree3/rtcore.h>

#include "core/clip.h"

namespace ensemble {
namespace {

constexpr float kFar = 100.0f;       // metres: longer than anybody
constexpr float kNearest = 1.0e-4f;  // metres: what is nearer to a point of the surface is the surface itself

/// What a ray carries for the filters. Rays go one by one, so that N is 1 there.
struct RayContext : RTCIntersectContext {
  std::uint32_t own_face = 0xffffffffu;  ///< of the surface
  float outward = 1.0f;                  ///< 1: goes out to who looks; -1: the way of the look, into the body
};

/// Which side of what is hit is looked at: more than 0 its outside, less its inside.
float facing(const RTCFilterFunctionNArguments& arguments) {
  RTCRayN* ray = arguments.ray;
  RTCHitN* hit = arguments.hit;
  const float along = RTCHitN_Ng_x(hit, 1, 0) * RTCRayN_dir_x(ray, 1, 0) +
                      RTCHitN_Ng_y(hit, 1, 0) * RTCRayN_dir_y(ray, 1, 0) +
                      RTCHitN_Ng_z(hit, 1, 0) * RTCRayN_dir_z(ray, 1, 0);
  return static_cast<const RayContext*>(arguments.context)->outward * along;
}

// Its back is not drawn.
void filterSingleSided(const RTCFilterFunctionNArguments* arguments) {
  if (!(facing(*arguments) > 0.0f)) arguments->valid[0] = 0;
}

/// Of the surface that is looked at: the user data are its faces' kinds.
void filterSurface(const RTCFilterFunctionNArguments* arguments) {
  const auto& context = *static_cast<const RayContext*>(arguments->context);
  const std::uint32_t face = RTCHitN_primID(arguments->hit, 1, 0);
  const FaceKind kind = static_cast<const FaceKind*>(arguments->geometryUserPtr)[face];
  if (face == context.own_face || !kind.is_opaque) arguments->valid[0] = 0;
  if (!kind.is_two_sided) filterSingleSided(arguments);
}

std::vector<Vec3> posed(std::span<const RawVertex> vertices, std::span<const Mat4> matrices) {
  std::vector<Vec3> positions;
  positions.reserve(vertices.size());
  for (const RawVertex& vertex : vertices) positions.push_back(skinPosition(vertex, matrices));
  return positions;
}

RTCRay makeRay(Vec3 from, Vec3 direction, float most) {
  RTCRay ray{};
  ray.org_x = from.x, ray.org_y = from.y, ray.org_z = from.z;
  ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
  ray.tnear = kNearest;
  ray.tfar = most;
  ray.mask = 0xffffffffu;
  return ray;
}

}  // namespace

struct RayScene::State {
  RTCScene scene = nullptr;     ///< the surface and what is around it
  RTCScene cloth = nullptr;     ///< the garments around it
  std::vector<FaceKind> kinds;  ///< of the surface

  State(RTCDevice device, const ViewedSurface& surface)
      : scene(rtcNewScene(device)), cloth(rtcNewScene(device)), kinds(surface.kinds) {}
  ~State() {
    rtcReleaseScene(scene);
    rtcReleaseScene(cloth);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// @param filter none: both sides are there
  void add(const RayDevice& device, std::span<const Vec3> vertices, std::span<const Triangle> faces,
           RTCFilterFunctionN filter, bool is_cloth) {
    if (faces.empty()) return;
    const RTCGeometry geometry = device.newTriangles(vertices, faces);
    rtcSetGeometryOccludedFilterFunction(geometry, filter);
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcSetGeometryUserData(geometry, kinds.data());  // for filterSurface
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    if (is_cloth) rtcAttachGeometry(cloth, geometry);
    rtcReleaseGeometry(geometry);
  }
};

RayScene::RayScene(const RayDevice& device, const ViewedSurface& surface, const Around& around,
                   std::span<const Mat4> matrices)
    : state_(std::make_unique<State>(device.get(), surface)), vertices_(posed(surface.vertices, matrices)) {
  state_->add(device, vertices_, surface.faces, filterSurface, false);
  if (around.body != nullptr) {
    state_->add(device, posed(around.body->vertices.raw(), matrices), around.body->faces.raw(),
                filterSingleSided, false);
  }
  for (const Item* item : around.items) {
    for (const Garment& garment : item->garments) {
      for (const ItemPart& part : garment.parts) {
        const RawMaterial& material = item->materials[part.material];
        if (material.alpha_mode != AlphaMode::kOpaque) continue;
        state_->add(device, posed(part.vertices, matrices), part.faces,
                    material.double_sided ? nullptr : filterSingleSided, true);
      }
    }
  }
  rtcCommitScene(state_->scene);
  rtcCommitScene(state_->cloth);
}

RayScene::RayScene(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

bool RayScene::isSeen(Vec3 point, Vec3 direction, std::uint32_t face) const {
  RayContext context;
  rtcInitIntersectContext(&context);
  context.own_face = face;
  RTCRay ray = makeRay(point, direction, kFar);
  rtcOccluded1(state_->scene, &context, &ray);
  return ray.tfar > 0.0f;  // -infinity where something is in the way
}

std::optional<BodyHit> RayScene::bodyAt(Vec3 from, Vec3 direction) const {
  RayContext context;
  rtcInitIntersectContext(&context);
  context.outward = -1.0f;
  RTCRayHit found{};
  found.ray = makeRay(from, direction, kFar);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(state_->scene, &context, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return BodyHit{found.hit.primID, glm::normalize(Vec3(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z))};
}

bool RayScene::hasClothUnder(Vec3 point, Vec3 direction, float most) const {
  if (!(most > 0.0f)) return false;
  RayContext context;
  rtcInitIntersectContext(&context);
  context.outward = -1.0f;
  RTCRayHit found{};
  found.ray = makeRay(point, -direction, most);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(state_->cloth, &context, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  const Vec3 normal(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z);
  return glm::dot(normal, direction) > 0.0f;  // else one looks into the garment
}

}  // namespace ensemble
