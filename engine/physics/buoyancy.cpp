#include "engine/physics/buoyancy.hpp"

#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/physics/shapes.hpp"

namespace psygen::physics {
namespace {

using models::Collider;

constexpr double kDragCoefficient = 0.8;  // of the mean area of the three sides of the box
constexpr double kViscosity = 1.5;        // 1/s, of a body under water
constexpr double kAngularViscosity = 3;   // 1/s
constexpr double kSlowest = 0.03;         // m/s and rad/s, of a body in water that stays awake
constexpr double kAddedMass = 0.5;        // of the displaced water

double volume_of(const Collider::Sphere& s) {
  const double r = static_cast<double>(s.radius);
  return 4.0 / 3 * std::numbers::pi * r * r * r;
}
double volume_of(const Collider::Capsule& c) {
  const double r = static_cast<double>(c.radius);
  const double length = (to_bt(c.to) - to_bt(c.from)).length();
  return std::numbers::pi * r * r * (length + 4.0 / 3 * r);
}
double volume_of(const Collider::Box& b) {
  const glm::dvec3 size(b.max - b.min);
  return size.x * size.y * size.z;
}
// The sum of tetrahedra over the triangles of the faces.
double volume_of(const Collider::Hull& h) {
  std::vector<glm::dvec3> points;
  for (const glm::vec3& p : h.points)
    points.emplace_back(p);
  btConvexHullComputer hull;
  hull.compute(&points.front().x, sizeof(glm::dvec3), static_cast<int>(points.size()), 0, 0);
  double sixfold = 0;
  for (int f = 0; f < hull.faces.size(); ++f) {
    const btConvexHullComputer::Edge* const first = &hull.edges[hull.faces[f]];
    const btVector3& a = hull.vertices[first->getSourceVertex()];
    for (const auto* edge = first->getNextEdgeOfFace(); edge != first;
         edge = edge->getNextEdgeOfFace()) {
      const btVector3& b = hull.vertices[edge->getSourceVertex()];
      const btVector3& c = hull.vertices[edge->getTargetVertex()];
      sixfold += a.dot(b.cross(c));
    }
  }
  return std::abs(sixfold) / 6;
}

}  // namespace

Displacement displacement_of(const Collider& shape) {
  Displacement all;
  core::Bounds box = models::bounds_of(shape.shapes.front());
  for (const Collider::Shape& part : shape.shapes) {
    all.volume_m3 += std::visit([](const auto& s) { return volume_of(s); }, part);
    const core::Bounds of = models::bounds_of(part);
    box = {glm::min(box.min, of.min), glm::max(box.max, of.max)};
  }
  all.centre = glm::dvec3(box.centre());
  all.half = glm::dvec3(box.half_extent());
  return all;
}

WaterHere water_at(Terrain& terrain, const world::World& world, const btVector3& at) {
  const auto water = world::water_surface(world, terrain.position(at));
  if (!water || water->depth_over(terrain.ground(at).height_m) <= 0) return {};
  return {water->surface_m, to_bt(water->normal),
          to_bt(glm::dvec3(water->flow_m_s.x, 0, water->flow_m_s.y))};
}

void float_body(btRigidBody& rigid, const Displacement& shape, const WaterHere& water,
                double density, double gravity, double dt) {
  // Eight cells of the box share the volume.
  const btTransform& pose = rigid.getWorldTransform();
  const btVector3& middle = pose.getOrigin();
  const btVector3& tilt = pose.getBasis().getRow(1);
  const double radius_m = (std::abs(tilt.x()) * shape.half.x + std::abs(tilt.y()) * shape.half.y +
                           std::abs(tilt.z()) * shape.half.z) /
                          2;  // half of the height of a cell
  double under = 0;
  btVector3 lever(0, 0, 0);
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 side((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5,
                          (i & 4) != 0 ? 0.5 : -0.5);
    const btVector3 way = pose.getBasis() * to_bt(shape.centre + side * shape.half);
    const double depth_m = water.surface_at(way) - (middle.y() + way.y());
    const double share = std::clamp((depth_m + radius_m) / (2 * radius_m), 0.0, 1.0) / 8;
    under += share;
    lever += way * share;
  }
  if (under <= 0) return;
  // Bullet's limit of 0.8 m/s would stop a body in the middle of a wave.
  if (rigid.getLinearVelocity().length() > kSlowest ||
      rigid.getAngularVelocity().length() > kSlowest)
    rigid.setDeactivationTime(0);
  const double mass = 1 / rigid.getInvMass(), displaced = density * shape.volume_m3 * under;
  const double inertia = mass + kAddedMass * displaced;
  btVector3 velocity = rigid.getLinearVelocity();
  // Bullet adds the whole gravity later.
  const double rise = (displaced - mass) / inertia * gravity + gravity;
  velocity.setY(velocity.y() + rise * dt);
  const double area_m2 =
      (shape.half.x * shape.half.y + shape.half.y * shape.half.z + shape.half.z * shape.half.x) *
      4 / 3;
  const double drag = 0.5 * density * kDragCoefficient * area_m2 * under / inertia;
  btVector3 relative = velocity - water.flow;
  relative /= 1 + dt * (drag * relative.length() + kViscosity * under);
  rigid.setLinearVelocity(water.flow + relative);
  const double lift = displaced / under * gravity * mass / inertia * dt;
  rigid.applyTorqueImpulse(lever.cross(btVector3(0, lift, 0)));
  rigid.setAngularVelocity(rigid.getAngularVelocity() / (1 + dt * kAngularViscosity * under));
}

}  // namespace psygen::physics
