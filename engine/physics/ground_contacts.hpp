// Contacts of bodies with the ground as one surface. Bullet tests a shape against each triangle
// alone, so it also reports normals that push against edges inside even ground. Here a contact
// keeps its normal only if the whole surface around its point allows it. Internal to physics. One
// thread.
#pragma once

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <btBulletDynamicsCommon.h>

#include <functional>
#include <memory>

namespace psygen::physics {

// The ground of a block, which must not be turned: size² heights in rows along x, and the heights
// of the neighbours.
class GroundShape final : public btHeightfieldTerrainShape {
 public:
  // Returns the height of a vertex in metres; x and z may be one cell beyond the border. NaN if
  // nothing is loaded there.
  using Height = std::function<double(int x, int z)>;

  // The heights must outlive it, between `low_m` and `high_m`.
  GroundShape(int size, const double* heights, double cell_m, double low_m, double high_m,
              Height height);

  // True if a body above the ground can touch it with this normal at a point of a triangle of three
  // vertices, all in the shape's coordinates: no triangle at the point rises above the plane
  // through the point.
  bool allows(const btVector3& normal, const btVector3& point, const btVector3* triangle) const;

 private:
  Height height_;
  double cell_m_, middle_, middle_m_;  // of the grid, in cells, and of the heights
};

// Makes contacts of spheres, upright capsules, boxes and hulls with GroundShape, the only
// heightfields that its worlds may have. Drops a contact whose normal the ground does not allow,
// and adds those of the shape's corners with the plane of the triangle below them.
class GroundConfiguration final : public btDefaultCollisionConfiguration {
 public:
  GroundConfiguration();
  ~GroundConfiguration() override;
  btCollisionAlgorithmCreateFunc* getCollisionAlgorithmCreateFunc(int first, int second) override;

 private:
  std::unique_ptr<btCollisionAlgorithmCreateFunc> body_first_, ground_first_;
};

}  // namespace psygen::physics
