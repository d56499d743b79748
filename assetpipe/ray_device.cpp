#include "assetpipe/ray_device.h"

#include <embree3/rtcore.h>

#include <algorithm>

#include "core/input_error.h"

namespace ensemble {

RayDevice::RayDevice() : device_(rtcNewDevice("threads=1,set_affinity=0")) {  // we have threads of our own
  if (!device_)
    throw SystemError({"", "Embree", "can't be started on this processor", "use another machine"});
}

RayDevice::~RayDevice() { rtcReleaseDevice(device_); }

RTCGeometryTy* RayDevice::newTriangles(std::span<const Vec3> vertices,
                                       std::span<const Triangle> faces) const {
  const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* to_vertices = static_cast<Vec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), vertices.size()));
  auto* to_faces = static_cast<Triangle*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), faces.size()));
  if (!to_vertices || !to_faces) {
    rtcReleaseGeometry(geometry);
    throw SystemError({"", "Embree", "has no memory for a mesh", "close other programs"});
  }
  std::copy(vertices.begin(), vertices.end(), to_vertices);
  std::copy(faces.begin(), faces.end(), to_faces);
  return geometry;
}

}  // namespace ensemble
