#include "harness/world/extract_shapes.h"

#include <array>
#include <stdexcept>
#include <string>

#include "scenarios/shapes.h"

namespace cleave {
namespace {

struct Geom {
  GeomType type = GeomType::box;
  std::array<double, 3> size{};
  std::array<double, 3> position{};
  std::array<double, 4> orientation{1, 0, 0, 0};
};

GeomType type_of(dGeomID geom, int index) {
  switch (dGeomGetClass(geom)) {
    case dBoxClass:
      return GeomType::box;
    case dSphereClass:
      return GeomType::sphere;
    case dCapsuleClass:
      return GeomType::capsule;
    case dCylinderClass:
      return GeomType::cylinder;
    case dConvexClass:
      return GeomType::convex;
    case dPlaneClass:
      return GeomType::plane;
    default:
      throw std::runtime_error("geom " + std::to_string(index) + " is of ODE's class " +
                               std::to_string(dGeomGetClass(geom)) + ", which cannot be recorded");
  }
}

std::array<double, 3> size_of(dGeomID geom, GeomType type) {
  dVector3 edges{};
  switch (type) {
    case GeomType::box:
      dGeomBoxGetLengths(geom, edges);
      break;
    case GeomType::sphere:
      edges[0] = dGeomSphereGetRadius(geom);
      break;
    case GeomType::capsule:
      dGeomCapsuleGetParams(geom, &edges[0], &edges[1]);
      break;
    case GeomType::cylinder:
      dGeomCylinderGetParams(geom, &edges[0], &edges[1]);
      break;
    case GeomType::convex:
    case GeomType::plane:
      break;
  }
  return {edges[0], edges[1], edges[2]};
}

// Planes are the one kind of geom that ODE gives no position.
void place(dGeomID geom, Geom& out) {
  if (out.type == GeomType::plane) {
    dVector4 plane;
    dGeomPlaneGetParams(geom, plane);
    for (int k = 0; k < 3; ++k) out.position[k] = plane[3] * plane[k];
    out.orientation = orientation_along({plane[0], plane[1], plane[2]});
    return;
  }
  const dReal* position = dGeomGetPosition(geom);
  dQuaternion orientation;
  dGeomGetQuaternion(geom, orientation);
  for (int k = 0; k < 3; ++k) out.position[k] = position[k];
  for (int k = 0; k < 4; ++k) out.orientation[k] = orientation[k];
}

template <std::size_t N>
void append(const std::array<double, N>& values, std::vector<double>& to) {
  to.insert(to.end(), values.begin(), values.end());
}

}  // namespace

ProblemShapes extract_shapes(const OdeWorld& world) {
  const SceneContent& content = world.content();
  ProblemShapes shapes;
  for (int i = 0; i < static_cast<int>(content.geoms.size()); ++i) {
    const dGeomID id = content.geoms[i];
    Geom geom{.type = type_of(id, i)};
    geom.size = size_of(id, geom.type);
    place(id, geom);
    shapes.geom_body.push_back(world.body_index(dGeomGetBody(id)));
    shapes.geom_type.push_back(static_cast<std::uint8_t>(geom.type));
    append(geom.size, shapes.geom_size);
    append(geom.position, shapes.geom_position);
    append(geom.orientation, shapes.geom_orientation);
    const auto corners = content.convex_corners.find(i);
    if (corners != content.convex_corners.end())
      shapes.convex_points.insert(shapes.convex_points.end(), corners->second.begin(), corners->second.end());
    shapes.convex_first.push_back(static_cast<int>(shapes.convex_points.size() / 3));
  }
  return shapes;
}

}  // namespace cleave
