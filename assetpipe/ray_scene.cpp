#include "assetpipe/ray_scene.h"

#include <embree3/rtcore.h>

#include <cstring>
#include <limits>

#include "core/clip.h"
#include "core/input_error.h"

namespace ensemble {
namespace {

constexpr unsigned kBodyGeometry = 0;  // attached first
constexpr float kFar = 100.0f;         // metres: longer than anybody
constexpr float kNearest = 1.0e-4f;    // metres: what is nearer to a point of the body is the body itself

/// What a ray carries for the filters. Rays go one by one, so that N is 1 there.
struct RayContext : RTCIntersectContext {
  std::uint32_t own_face = 0xffffffffu;
  std::span<const std::uint8_t> gone;
  bool is_inward = false;  ///< goes under the skin, and not out to who looks
};

/// The side of what is hit that lies against the ray: less than 0 its outside, more its inside.
float facing(const RTCFilterFunctionNArguments& arguments) {
  RTCRayN* ray = arguments.ray;
  RTCHitN* hit = arguments.hit;
  return RTCHitN_Ng_x(hit, 1, 0) * RTCRayN_dir_x(ray, 1, 0) +
         RTCHitN_Ng_y(hit, 1, 0) * RTCRayN_dir_y(ray, 1, 0) +
         RTCHitN_Ng_z(hit, 1, 0) * RTCRayN_dir_z(ray, 1, 0);
}

// Who looks along the ray's opposite sees the outside of what the ray meets from inside. A ray that goes
// under the skin ends where it leaves the body again.
void filterBody(const RTCFilterFunctionNArguments* arguments) {
  const auto& context = *static_cast<const RayContext*>(arguments->context);
  const std::uint32_t face = RTCHitN_primID(arguments->hit, 1, 0);
  const bool is_gone = !context.gone.empty() && context.gone[face] != 0;
  if (face == context.own_face || is_gone || !(facing(*arguments) > 0.0f)) arguments->valid[0] = 0;
}

void filterSingleSided(const RTCFilterFunctionNArguments* arguments) {
  const auto& context = *static_cast<const RayContext*>(arguments->context);
  const float side = facing(*arguments);
  if (!(context.is_inward ? side < 0.0f : side > 0.0f)) arguments->valid[0] = 0;
}

void filterDoubleSided(const RTCFilterFunctionNArguments* arguments) {
  const auto& context = *static_cast<const RayContext*>(arguments->context);
  if (context.is_inward && !(facing(*arguments) < 0.0f)) arguments->valid[0] = 0;
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

struct RayDevice::State {
  RTCDevice device = nullptr;
};

RayDevice::RayDevice() : state_(std::make_unique<State>()) {
  // We have threads of our own, one for each pose.
  state_->device = rtcNewDevice("threads=1,set_affinity=0");
  if (!state_->device) {
    throw SystemError({"", "Embree", "can't be started on this processor", "use --occlusion authored"});
  }
}

RayDevice::~RayDevice() { rtcReleaseDevice(state_->device); }

struct RayScene::State {
  RTCScene scene = nullptr;

  void add(RTCDevice device, std::span<const Vec3> vertices, std::span<const Triangle> faces,
           RTCFilterFunctionN filter) {
    if (faces.empty()) return;
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* to = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3),
                                       vertices.size());
    std::memcpy(to, vertices.data(), vertices.size_bytes());
    to = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle),
                                 faces.size());
    std::memcpy(to, faces.data(), faces.size_bytes());
    rtcSetGeometryOccludedFilterFunction(geometry, filter);
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
};

RayScene::RayScene(const RayDevice& device, const TemplateBody& body, std::span<const Item* const> items,
                   std::span<const Mat4> matrices)
    : state_(std::make_unique<State>()), body_(posed(body.vertices.raw(), matrices)) {
  const RTCDevice embree = device.state_->device;
  state_->scene = rtcNewScene(embree);
  state_->add(embree, body_, body.faces.raw(), filterBody);
  for (const Item* item : items) {
    for (const Garment& garment : item->garments) {
      for (const ItemPart& part : garment.parts) {
        const RawMaterial& material = item->materials[part.material];
        if (material.alpha_mode != AlphaMode::kOpaque) continue;
        state_->add(embree, posed(part.vertices, matrices), part.faces,
                    material.double_sided ? filterDoubleSided : filterSingleSided);
      }
    }
  }
  rtcCommitScene(state_->scene);
}

RayScene::~RayScene() { rtcReleaseScene(state_->scene); }

bool RayScene::isSeen(Vec3 point, Vec3 direction, std::uint32_t face,
                      std::span<const std::uint8_t> gone) const {
  RayContext context;
  rtcInitIntersectContext(&context);
  context.own_face = face;
  context.gone = gone;
  RTCRay ray = makeRay(point, direction, kFar);
  rtcOccluded1(state_->scene, &context, &ray);
  return ray.tfar > 0.0f;  // -infinity where something is in the way
}

float RayScene::depthOfCloth(Vec3 point, Vec3 normal, std::uint32_t face, float most) const {
  RayContext context;
  rtcInitIntersectContext(&context);
  context.own_face = face;
  context.is_inward = true;
  RTCRayHit found{};
  found.ray = makeRay(point, -normal, most);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(state_->scene, &context, &found);
  const bool is_cloth = found.hit.geomID != RTC_INVALID_GEOMETRY_ID && found.hit.geomID != kBodyGeometry;
  return is_cloth ? found.ray.tfar : std::numeric_limits<float>::infinity();
}

}  // namespace ensemble
