#include "snapshot.h"

#include <algorithm>

namespace cleave {
namespace {

double index_of(const SceneContent& content, dBodyID body) {
  const auto found = std::ranges::find(content.bodies, body);
  return body == nullptr ? -1 : static_cast<double>(found - content.bodies.begin());
}

void add_body(dBodyID body, std::vector<double>& values) {
  const dReal *x = dBodyGetPosition(body), *q = dBodyGetQuaternion(body);
  const dReal *v = dBodyGetLinearVel(body), *w = dBodyGetAngularVel(body);
  dMass mass;
  dBodyGetMass(body, &mass);
  values.insert(values.end(), x, x + 3);
  values.insert(values.end(), q, q + 4);
  values.insert(values.end(), v, v + 3);
  values.insert(values.end(), w, w + 3);
  values.push_back(dBodyGetGravityMode(body));
  values.push_back(mass.mass);
  values.insert(values.end(), mass.I, mass.I + 12);
}

void add_geom(dGeomID geom, std::vector<double>& values) {
  dVector4 size{};
  switch (dGeomGetClass(geom)) {
    case dPlaneClass:
      dGeomPlaneGetParams(geom, size);
      break;
    case dBoxClass:
      dGeomBoxGetLengths(geom, size);
      break;
    case dSphereClass:
      size[0] = dGeomSphereGetRadius(geom);
      break;
    case dCapsuleClass:
      dGeomCapsuleGetParams(geom, size, size + 1);
      break;
    case dCylinderClass:
      dGeomCylinderGetParams(geom, size, size + 1);
      break;
    default:
      break;
  }
  values.insert(values.end(), size, size + 4);
  if (dGeomGetClass(geom) == dPlaneClass) return;
  const dReal* x = dGeomGetPosition(geom);
  values.insert(values.end(), x, x + 3);
}

void add_joint(dJointID joint, std::vector<double>& values) {
  dVector3 anchor{}, axis{};
  if (dJointGetType(joint) == dJointTypeBall) dJointGetBallAnchor(joint, anchor);
  if (dJointGetType(joint) == dJointTypeHinge) {
    dJointGetHingeAnchor(joint, anchor);
    dJointGetHingeAxis(joint, axis);
  }
  if (dJointGetType(joint) == dJointTypeSlider) dJointGetSliderAxis(joint, axis);
  values.insert(values.end(), anchor, anchor + 3);
  values.insert(values.end(), axis, axis + 3);
}

}  // namespace

std::vector<double> snapshot(const SceneContent& content) {
  std::vector<double> values;
  for (const dBodyID body : content.bodies) add_body(body, values);
  for (const dGeomID geom : content.geoms) {
    values.push_back(dGeomGetClass(geom));
    values.push_back(index_of(content, dGeomGetBody(geom)));
    add_geom(geom, values);
  }
  for (const dJointID joint : content.joints) {
    values.push_back(dJointGetType(joint));
    for (const int side : {0, 1}) values.push_back(index_of(content, dJointGetBody(joint, side)));
    add_joint(joint, values);
  }
  return values;
}

}  // namespace cleave
