// Embree, as ray_scene and body_surface share it.
#pragma once

#include <span>

#include "core/math.h"
#include "core/raw_asset.h"

struct RTCDeviceTy;
struct RTCGeometryTy;

namespace ensemble {

/// Embree without threads of its own. Scenes made with it hold it themselves and may outlive this.
class RayDevice {
 public:
  RayDevice();  ///< @throws SystemError
  ~RayDevice();
  RayDevice(const RayDevice&) = delete;
  RayDevice& operator=(const RayDevice&) = delete;

  RTCDeviceTy* get() const { return device_; }

  /// Triangles as a geometry that is still to be committed; the caller releases it.
  /// @throws SystemError if there is no memory
  RTCGeometryTy* newTriangles(std::span<const Vec3> vertices, std::span<const Triangle> faces) const;

 private:
  RTCDeviceTy* device_ = nullptr;
};

}  // namespace ensemble
