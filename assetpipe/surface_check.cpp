#include "assetpipe/surface_check.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>

#include <array>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace ensemble {

SurfaceCheck checkSurface(std::span<const Vec3> positions, std::span<const Triangle> faces) {
  namespace processing = CGAL::Polygon_mesh_processing;
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  std::vector<Kernel::Point_3> points;
  points.reserve(positions.size());
  for (const Vec3& p : positions) points.emplace_back(double{p.x}, double{p.y}, double{p.z});
  std::vector<std::array<std::size_t, 3>> soup;
  soup.reserve(faces.size());
  for (const Triangle& face : faces) soup.push_back({face[0], face[1], face[2]});

  SurfaceCheck check;
  if (soup.empty() || !processing::is_polygon_soup_a_polygon_mesh(soup)) return check;
  check.is_manifold = true;
  Mesh mesh;
  processing::polygon_soup_to_polygon_mesh(points, soup, mesh);
  check.is_closed = CGAL::is_closed(mesh);
  check.faces_outwards = check.is_closed && processing::is_outward_oriented(mesh);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  processing::self_intersections(mesh, std::back_inserter(pairs));
  for (const auto& pair : pairs) {
    const Triangle& face = faces[static_cast<std::size_t>(pair.first)];
    check.crossings.push_back((positions[face[0]] + positions[face[1]] + positions[face[2]]) / 3.0f);
  }
  return check;
}

}  // namespace ensemble
