#include "engine/physics/impact.hpp"

#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <algorithm>
#include <vector>

namespace psygen::physics {
namespace {

// Contacts stop a part that moves and turns by these shares of its thickness per step. They take
// the motion for a straight one.
constexpr double kSlow = 0.5, kSlowTurn = 0.1;
constexpr double kOverlap = 0.25;  // of a part's thickness, at an impact
constexpr double kMaxOverlapM = 0.04;
constexpr double kPush = 0.1;  // of a part's thickness
constexpr int kMaxAdvances = 64;

// A convex part of an object.
struct Part {
  const btConvexShape& shape;
  const btTransform& place;  // in the object
};

template <class Visit>
void each_part(const btCollisionShape& shape, const Visit& visit) {
  if (shape.isConvex()) {
    visit(Part{static_cast<const btConvexShape&>(shape), btTransform::getIdentity()});
  } else if (shape.isCompound()) {
    const auto& whole = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < whole.getNumChildShapes(); ++i)
      visit(Part{static_cast<const btConvexShape&>(*whole.getChildShape(i)),
                 whole.getChildTransform(i)});
  }
}

// Half of a part's smallest width, at most.
double thickness_m(const btConvexShape& shape) {
  if (shape.getShapeType() != BOX_SHAPE_PROXYTYPE) return shape.getMargin();
  const btVector3 half = static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin();
  return half[half.minAxis()];
}

// Largest distance at which points of a part turn around the object's centre. The margin of spheres
// and capsules does not turn.
double arm_m(const Part& part) {
  const double off = part.place.getOrigin().length();
  if (part.shape.getShapeType() == SPHERE_SHAPE_PROXYTYPE) return off;
  if (part.shape.getShapeType() == CAPSULE_SHAPE_PROXYTYPE)
    return off + static_cast<const btCapsuleShape&>(part.shape).getHalfHeight();
  btVector3 centre;
  btScalar radius;
  part.shape.getBoundingSphere(centre, radius);
  return part.place(centre).length() + radius;
}

struct Box {
  btVector3 low, high;
};

// Bounds of a part along a path.
Box swept(const Part& part, const Path& path) {
  Box from, to;
  part.shape.getAabb(path.from * part.place, from.low, from.high);
  part.shape.getAabb(path.at(1) * part.place, to.low, to.high);
  from.low.setMin(to.low);
  from.high.setMax(to.high);
  // Points on an arc of this angle are at most so far from its chord.
  const double arc = arm_m(part) * path.turn.length2() / 8;
  return {from.low - btVector3(arc, arc, arc), from.high + btVector3(arc, arc, arc)};
}

// Finds where `a` overlaps `b` by its allowed depth, or by a little more than at the beginning.
// Replaces `first` if that is earlier. Ignores `b` if it holds the middle of `a` from the
// beginning.
void find_impact(const Part& a, const Path& a_path, const Part& b, const Path& b_path,
                 Impact& first) {
  const double thick_m = thickness_m(a.shape);
  const double usual_m = std::min(kOverlap * thick_m, kMaxOverlapM), slack_m = 0.1 * usual_m;
  const double a_arm = arm_m(a), b_arm = arm_m(b);
  btVoronoiSimplexSolver simplex;
  btGjkEpaPenetrationDepthSolver depths;
  double share = 0, allowed_m = usual_m;
  btVector3 push(0, 0, 0);
  for (int i = 0; i < kMaxAdvances; ++i) {
    btGjkPairDetector detector(&a.shape, &b.shape, &simplex, &depths);
    btDiscreteCollisionDetectorInterface::ClosestPointInput input;
    input.m_transformA = a_path.at(share) * a.place;
    input.m_transformB = b_path.at(share) * b.place;
    btPointCollector nearest;
    detector.getClosestPoints(input, nearest, nullptr);
    if (i == 0) {
      if (!nearest.m_hasResult || nearest.m_distance < -thick_m) return;
      allowed_m = std::max(usual_m, 2 * slack_m - nearest.m_distance);
    }
    if (!nearest.m_hasResult) break;
    const btVector3& normal = nearest.m_normalOnBInWorld;
    const double gap_m = nearest.m_distance + allowed_m;
    push = normal * std::clamp(-nearest.m_distance - usual_m, 0.0, kPush * thick_m);
    if (gap_m <= slack_m) break;
    // The parts stay apart along the normal as long as this speed needs for the gap.
    const double closing_m = (b_path.way - a_path.way).dot(normal) +
                             a_path.turn.cross(normal).length() * a_arm +
                             b_path.turn.cross(normal).length() * b_arm;
    if (closing_m * (first.share - share) <= gap_m) return;
    share += gap_m / closing_m;
  }
  first = {share, push};
}

struct Nearby : btBroadphaseAabbCallback {
  explicit Nearby(const btCollisionObject& of) : body(of) {}
  bool process(const btBroadphaseProxy* proxy) override {
    const btBroadphaseProxy& own = *body.getBroadphaseHandle();
    if (proxy != &own && (proxy->m_collisionFilterGroup & own.m_collisionFilterMask) != 0 &&
        (proxy->m_collisionFilterMask & own.m_collisionFilterGroup) != 0)
      found.push_back(static_cast<const btCollisionObject*>(proxy->m_clientObject));
    return true;
  }
  const btCollisionObject& body;
  std::vector<const btCollisionObject*> found;
};

}  // namespace

Path Path::between(const btTransform& from, const btTransform& to) {
  Path path{from};
  btTransformUtil::calculateVelocity(from, to, 1, path.way, path.turn);
  return path;
}

btTransform Path::at(double share) const {
  btTransform pose;
  btTransformUtil::integrateTransform(from, way, turn, share, pose);
  return pose;
}

Impact first_impact(btDbvtBroadphase& broadphase, const btCollisionObject& body, const Path& path,
                    const PathOf& path_of) {
  Impact first;
  each_part(*body.getCollisionShape(), [&](const Part& part) {
    const double thick_m = thickness_m(part.shape);
    if (path.way.length() <= kSlow * thick_m &&
        path.turn.length() * arm_m(part) <= kSlowTurn * thick_m)
      return;
    const Box box = swept(part, path);
    Nearby nearby(body);
    broadphase.aabbTest(box.low, box.high, nearby);
    for (const btCollisionObject* other : nearby.found) {
      const Path other_path = path_of(*other);
      each_part(*other->getCollisionShape(), [&](const Part& solid) {
        const Box there = swept(solid, other_path);
        if (TestAabbAgainstAabb2(box.low, box.high, there.low, there.high))
          find_impact(part, path, solid, other_path, first);
      });
    }
  });
  return first;
}

}  // namespace psygen::physics
