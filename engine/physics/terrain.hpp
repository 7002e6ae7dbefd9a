// The blocks that physics has in Bullet: ground as a heightfield with the triangles of the finest
// mesh, trunks and rocks as static objects. Made from queries when something comes near, removed
// when nothing has needed them for a while. Internal to physics. One thread.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "engine/query/world.hpp"

namespace psygen::physics {

// Groups of Bullet's collision filter.
enum Group : int { kGround = 1, kModels = 2, kBodies = 4, kCharacters = 8, kObjects = 16 };

class Terrain {
 public:
  // At most this many blocks along each axis are made around one thing.
  static constexpr std::int64_t kMaxAside = 32;

  // Both must outlive it.
  Terrain(btDynamicsWorld& bullet, query::World& query) : bullet_(bullet), query_(query) {}
  ~Terrain() { clear(); }
  Terrain(const Terrain&) = delete;
  Terrain& operator=(const Terrain&) = delete;

  // The block from whose corner Bullet's coordinates count. Moves the blocks that were needed last,
  // and removes the others. O(objects).
  void set_origin(core::BlockCoord origin);
  // Makes what is missing of the blocks that reach into the square from `low` to `high`, in
  // Bullet's x and z, and keeps them for this step.
  void need(const glm::dvec2& low, const glm::dvec2& high, std::uint64_t step);
  // Removes blocks that were not needed for `keep_steps`, and the oldest of more than `most`
  // others.
  void drop_idle(std::uint64_t step, std::uint32_t keep_steps, std::size_t most);
  void remove(core::BlockCoord block);
  // Blocks that edits of the world have changed, and how far their models reached, before or after.
  struct Changes {
    std::unordered_set<core::BlockCoord, core::BlockCoordHash> blocks;
    double reach_m = 0;
  };
  // Removes the blocks that have changed since the last call, and returns them.
  Changes follow_edits();
  // Whether what has changed reaches into the square from `low` to `high`.
  bool is_near(const Changes& changes, const glm::dvec2& low, const glm::dvec2& high) const;
  void clear();
  std::size_t size() const { return blocks_.size(); }

  // The ground under a point in Bullet's coordinates, moved into a bounded world. As queries have
  // it now, also where Bullet gets it in the next step only.
  models::GroundPoint ground(const btVector3& at);
  // The point inside the walls of a bounded world, at least `margin_m` from them.
  btVector3 inside(const btVector3& at, double margin_m) const;
  // Between Bullet's coordinates and the world's.
  core::WorldPosition position(const btVector3& at) const;
  btVector3 coordinates(const core::WorldPosition& at) const;

 private:
  struct Part {
    std::unique_ptr<btCollisionShape> shape;
    std::unique_ptr<btCollisionObject> object;
    btVector3 from_corner{0, 0, 0};  // of the block
  };
  struct Block {
    std::uint64_t needed = 0;     // the last step in which it was
    std::uint64_t edits = 0;      // query::edits_of_block() when it was made
    std::vector<double> heights;  // of the ground; Bullet refers to them
    std::vector<Part> parts;
  };
  using Blocks = std::unordered_map<core::BlockCoord, Block, core::BlockCoordHash>;

  glm::dvec3 corner_of(core::BlockCoord block) const;
  void make(core::BlockCoord at, Block& block);
  // `place` counts from the block's corner.
  void add(core::BlockCoord at, Block& block, std::unique_ptr<btCollisionShape> shape,
           const btTransform& place, Group group);
  // Visits the blocks that reach into a square, until visit() returns false.
  template <class Visit>
  void each_near(const glm::dvec2& low, const glm::dvec2& high, double reach_m,
                 const Visit& visit) const;
  Blocks::iterator erase(Blocks::iterator block);

  btDynamicsWorld& bullet_;
  query::World& query_;
  std::shared_ptr<const models::EditLayer> edits_;  // when they were last looked at
  double reach_m_ = 0;                              // of models, then
  std::uint64_t last_step_ = 0;                     // of need()
  core::BlockCoord origin_;
  Blocks blocks_;
};

}  // namespace psygen::physics
