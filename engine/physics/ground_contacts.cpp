#include "engine/physics/ground_contacts.hpp"

#include <BulletCollision/CollisionDispatch/btConvexConcaveCollisionAlgorithm.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace psygen::physics {
namespace {

constexpr double kFace = 1 - 1e-6;     // least cosine between normals that count as equal
constexpr double kSlack = 1e-4;        // largest slope of the surface above the plane of a contact
constexpr double kOnFeature = 1e-5;    // barycentric coordinates below it count as 0
constexpr double kOnTriangle = -1e-9;  // least barycentric coordinate of points over a triangle

// Returns the barycentric coordinates of a point, seen from above.
std::array<double, 3> weights(const btVector3& p, const btVector3* v) {
  const auto area = [](const btVector3& a, const btVector3& b, const btVector3& c) {
    return (b.x() - a.x()) * (c.z() - a.z()) - (b.z() - a.z()) * (c.x() - a.x());
  };
  const double whole = area(v[0], v[1], v[2]);
  return {area(p, v[1], v[2]) / whole, area(v[0], p, v[2]) / whole, area(v[0], v[1], p) / whole};
}

// True if an edge of the triangles joins two vertices of the grid. Cells are cut from (x, z + 1) to
// (x + 1, z).
bool is_edge(int dx, int dz) {
  return std::max(std::abs(dx), std::abs(dz)) == 1 && dx != dz;
}

// Calls visit(centre, radius) for balls whose convex hull is the shape.
template <class Visit>
void each_corner(const btConvexShape& shape, const Visit& visit) {
  if (shape.getShapeType() == CAPSULE_SHAPE_PROXYTYPE) {
    const auto& capsule = static_cast<const btCapsuleShape&>(shape);
    for (const double end : {-capsule.getHalfHeight(), capsule.getHalfHeight()})
      visit(btVector3(0, end, 0), capsule.getRadius());
  } else if (shape.isPolyhedral()) {
    const auto& polyhedron = static_cast<const btPolyhedralConvexShape&>(shape);
    // Vertices of boxes are on the surface.
    const double margin = shape.getShapeType() == BOX_SHAPE_PROXYTYPE ? 0 : shape.getMargin();
    btVector3 corner;
    for (int i = 0; i < polyhedron.getNumVertices(); ++i) {
      polyhedron.getVertex(i, corner);
      visit(corner, margin);
    }
  } else {
    visit(btVector3(0, 0, 0), shape.getMargin());  // a sphere
  }
}

// Passes the contacts of a convex shape on.
class GroundResult final : public btManifoldResult {
 public:
  GroundResult(btManifoldResult& to, const btCollisionObjectWrapper& body,
               const GroundShape& ground)
      : btManifoldResult(to), to_(to), body_(body), ground_(ground) {}

  // The normal points from the ground to the body.
  void addContactPoint(const btVector3& normal, const btVector3& point, btScalar depth) override {
    const bool first = m_body0Wrap->getCollisionShape()->getShapeType() == TRIANGLE_SHAPE_PROXYTYPE;
    const btCollisionObjectWrapper& ground = first ? *m_body0Wrap : *m_body1Wrap;
    const btVector3* v =
        static_cast<const btTriangleShape*>(ground.getCollisionShape())->m_vertices1;
    const btVector3& origin = ground.getWorldTransform().getOrigin();
    btVector3 up = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
    if (up.y() < 0) up = -up;
    if (normal.dot(up) >= kFace)
      pass(up, point + normal * depth, v[0] + origin);
    else if (ground_.allows(normal, point - origin, v))
      pass(normal, point + normal * depth, point);
    // One point per triangle does not hold a body level: adds its corners over the triangle.
    const btTransform& pose = body_.getWorldTransform();
    const auto& shape = static_cast<const btConvexShape&>(*body_.getCollisionShape());
    each_corner(shape, [&](const btVector3& corner, btScalar radius) {
      const btVector3 lowest = pose(corner) - up * radius - origin;
      if ((lowest - v[0]).dot(up) <= m_manifoldPtr->getContactBreakingThreshold() &&
          std::ranges::min(weights(lowest, v)) >= kOnTriangle)
        pass(up, lowest + origin, v[0] + origin);
    });
  }

 private:
  // Adds a contact of the body's point `at` with a plane.
  void pass(const btVector3& normal, const btVector3& at, const btVector3& on_plane) {
    const double depth = (at - on_plane).dot(normal);
    to_.setPersistentManifold(m_manifoldPtr);
    to_.addContactPoint(normal, at - normal * depth, depth);
  }

  btManifoldResult& to_;
  const btCollisionObjectWrapper& body_;
  const GroundShape& ground_;
};

struct GroundAlgorithm final : btConvexConcaveCollisionAlgorithm {
  using btConvexConcaveCollisionAlgorithm::btConvexConcaveCollisionAlgorithm;

  void processCollision(const btCollisionObjectWrapper* first,
                        const btCollisionObjectWrapper* second, const btDispatcherInfo& info,
                        btManifoldResult* result) override {
    const bool is_ground = first->getCollisionShape()->getShapeType() == TERRAIN_SHAPE_PROXYTYPE;
    const btCollisionObjectWrapper& ground = is_ground ? *first : *second;
    GroundResult as_surface(*result, is_ground ? *second : *first,
                            static_cast<const GroundShape&>(*ground.getCollisionShape()));
    btConvexConcaveCollisionAlgorithm::processCollision(first, second, info, &as_surface);
  }
};

struct Create final : btCollisionAlgorithmCreateFunc {
  explicit Create(bool ground_first) { m_swapped = ground_first; }
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* first,
                                                 const btCollisionObjectWrapper* second) override {
    void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(GroundAlgorithm));
    return new (memory) GroundAlgorithm(info, first, second, m_swapped);
  }
};

}  // namespace

GroundShape::GroundShape(int size, const double* heights, double cell_m, double low_m,
                         double high_m, Height height)
    : btHeightfieldTerrainShape(size, size, heights, low_m, high_m, 1, false),
      height_(std::move(height)),
      cell_m_(cell_m),
      middle_(0.5 * (size - 1)),
      middle_m_(0.5 * (low_m + high_m)) {
  setLocalScaling({cell_m, 1, cell_m});
}

bool GroundShape::allows(const btVector3& normal, const btVector3& point,
                         const btVector3* triangle) const {
  if (normal.y() <= 0) return false;
  // The vertices of the corner, edge or triangle that holds the point.
  std::array<std::array<int, 2>, 3> feature{};
  std::size_t count = 0;
  const std::array<double, 3> weight = weights(point, triangle);
  for (std::size_t i = 0; i < 3; ++i)
    if (weight[i] > kOnFeature)
      feature[count++] = {static_cast<int>(std::lround(triangle[i].x() / cell_m_ + middle_)),
                          static_cast<int>(std::lround(triangle[i].z() / cell_m_ + middle_))};
  for (int dz = -1; dz <= 1; ++dz)
    for (int dx = -1; dx <= 1; ++dx) {
      const int x = feature[0][0] + dx, z = feature[0][1] + dz;
      // Vertices of the triangles that share the feature.
      const auto is_shared = [&](const std::array<int, 2>& of) {
        return is_edge(x - of[0], z - of[1]) || (x == of[0] && z == of[1]);
      };
      if (!std::all_of(feature.begin(), feature.begin() + count, is_shared)) continue;
      const double height = height_(x, z);
      if (std::isnan(height)) continue;
      const btVector3 way =
          btVector3((x - middle_) * cell_m_, height - middle_m_, (z - middle_) * cell_m_) - point;
      if (way.dot(normal) > kSlack * way.length()) return false;
    }
  return true;
}

GroundConfiguration::GroundConfiguration()
    : body_first_(std::make_unique<Create>(false)), ground_first_(std::make_unique<Create>(true)) {}
GroundConfiguration::~GroundConfiguration() = default;

btCollisionAlgorithmCreateFunc* GroundConfiguration::getCollisionAlgorithmCreateFunc(int first,
                                                                                     int second) {
  if (btBroadphaseProxy::isConvex(first) && second == TERRAIN_SHAPE_PROXYTYPE)
    return body_first_.get();
  if (first == TERRAIN_SHAPE_PROXYTYPE && btBroadphaseProxy::isConvex(second))
    return ground_first_.get();
  return btDefaultCollisionConfiguration::getCollisionAlgorithmCreateFunc(first, second);
}

}  // namespace psygen::physics
