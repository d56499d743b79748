// The skin of a template as a surface that points are measured against.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/raw_asset.h"

namespace ensemble {

/// The point of a surface that is nearest to another.
struct NearestPoint {
  std::uint32_t face = 0;
  Vec3 point{0.0f};
  Vec3 shares{1.0f, 0.0f, 0.0f};  ///< barycentric, of the face's corners
  float distance = 0.0f;          ///< metres, never negative
};

/// Triangles with the nearest point on them found by Embree. Vertices of one position are one vertex.
class BodySurface {
 public:
  /// @param faces indices into `positions`; at least one
  BodySurface(std::span<const Vec3> positions, std::span<const Triangle> faces);
  ~BodySurface();
  BodySurface(const BodySurface&) = delete;
  BodySurface& operator=(const BodySurface&) = delete;

  NearestPoint nearest(const Vec3& position) const;
  /// Negative inside. The side is told by the angle-weighted normal of the nearest face, edge or corner
  /// (Baerentzen and Aanaes 2005), right for closed surfaces and next to holes that are small.
  float signedDistance(const Vec3& position) const;
  /// Outward, unit; smooth over the corners.
  Vec3 normalAt(const NearestPoint& nearest) const;
  /// The normal that tells the side of the point found.
  Vec3 sideNormal(const NearestPoint& nearest) const;

  /// Whether the point found lies on an edge, or a corner, that has one face only.
  bool isOnBorder(const NearestPoint& nearest) const;

  const std::vector<Triangle>& faces() const { return faces_; }  ///< in the given order, indices welded
  const std::vector<Vec3>& positions() const { return positions_; }
  const std::vector<Vec3>& normals() const { return normals_; }  ///< of the vertices, unit
  /// The given vertex that each welded one stands for.
  const std::vector<std::uint32_t>& source() const { return source_; }

 private:
  struct State;
  void weld(std::span<const Vec3> positions, std::span<const Triangle> faces);
  void findNormals();
  void findNeighbours();
  void buildScene();
  Vec3 edgeNormal(std::uint32_t face, std::size_t corner) const;

  std::vector<Vec3> positions_, normals_, face_normals_;
  std::vector<Triangle> faces_;
  std::vector<std::array<std::uint32_t, 3>> across_;  // the face behind each edge, or the face itself
  std::vector<std::uint8_t> on_border_;               // per vertex
  std::vector<std::uint32_t> source_;
  std::unique_ptr<State> state_;
};

}  // namespace ensemble
