// The blocks that physics has loaded into Bullet: ground as a heightfield with the triangles of the
// finest mesh, trunks and rocks as static objects. Loaded from queries when something comes near,
// and removed when unused for a while. Internal to physics. One thread.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "engine/query/world.hpp"

namespace psygen::physics {

// Groups of Bullet's collision filter.
enum Group : int { kGround = 1, kModels = 2, kBodies = 4, kCharacters = 8, kObjects = 16 };

class Terrain {
 public:
  // Most blocks along each axis that are loaded around one body or character.
  static constexpr std::int64_t kMaxAside = 32;

  // Both arguments must outlive it.
  Terrain(btDynamicsWorld& bullet, query::World& query)
      : bullet_(bullet),
        query_(query),
        revision_(query.world().revision.number),
        block_m_(query.world().block_size_m()) {}
  ~Terrain() { clear(); }
  Terrain(const Terrain&) = delete;
  Terrain& operator=(const Terrain&) = delete;

  // Sets the block at whose corner Bullet's origin is. Moves the blocks that the last step needed,
  // and removes the others. O(objects).
  void set_origin(core::BlockCoord origin);
  // Loads the missing blocks that extend into the square from `low` to `high`, in Bullet's x and z,
  // and keeps all of them for this step.
  void need(const glm::dvec2& low, const glm::dvec2& high, std::uint64_t step);
  // Removes blocks that were not needed for `keep_steps`; of the other idle blocks, keeps the
  // `most` newest.
  void drop_idle(std::uint64_t step, std::uint32_t keep_steps, std::size_t most);
  void remove(core::BlockCoord block);
  // Removes all blocks if the world was replaced since the last call (World::revision), and names
  // Bullet's origin by a block of the new world. Returns the offset by which all coordinates must
  // be reduced then: not 0 only for blocks of another size.
  std::optional<btVector3> follow_world();
  // Blocks that edits of the world have changed, and the larger reach of their models before and
  // after.
  struct Changes {
    std::unordered_set<core::BlockCoord, core::BlockCoordHash> blocks;
    double reach_m = 0;
  };
  // Removes the blocks that have changed since the last call, and returns them.
  Changes sync_edits();
  // True if the changes extend into the square from `low` to `high`.
  bool is_near(const Changes& changes, const glm::dvec2& low, const glm::dvec2& high) const;
  void clear();
  std::size_t size() const { return blocks_.size(); }

  // Returns the ground under a point in Bullet's coordinates, clamped to a bounded world. Always
  // the present ground of queries, even if Bullet gets it only in the next step.
  models::GroundPoint ground(const btVector3& at);
  // True if block indices wrap between the origin and a block.
  bool is_across_seam(core::BlockCoord block) const;
  // Returns the point inside the walls of a bounded world, at least `margin_m` from them.
  btVector3 inside(const btVector3& at, double margin_m) const;
  // Conversions between Bullet's coordinates and the world's.
  core::WorldPosition position(const btVector3& at) const;
  btVector3 coordinates(const core::WorldPosition& at) const;

 private:
  struct Part {
    std::unique_ptr<btCollisionShape> shape;
    std::unique_ptr<btCollisionObject> object;
    btVector3 from_corner{0, 0, 0};  // of its block
  };
  struct Block {
    std::uint64_t needed = 0;     // the last step that needed the block
    std::uint64_t edits = 0;      // query::edits_of_block() at the time of loading
    std::vector<double> heights;  // of the ground; Bullet refers to them
    std::vector<Part> parts;
  };
  using Blocks = std::unordered_map<core::BlockCoord, Block, core::BlockCoordHash>;

  glm::dvec3 corner_of(core::BlockCoord block) const;
  // Returns the height of a vertex of a block's grid of size² vertices, or of the row beyond its
  // border. NaN if no block is loaded there.
  double height(core::BlockCoord block, int size, int x, int z) const;
  void make(core::BlockCoord at, Block& block);
  // `place` is relative to the block's corner.
  void add(core::BlockCoord at, Block& block, std::unique_ptr<btCollisionShape> shape,
           const btTransform& place, Group group);
  // Visits the blocks that reach into a square, until visit() returns false.
  template <class Visit>
  void each_near(const glm::dvec2& low, const glm::dvec2& high, double reach_m,
                 const Visit& visit) const;
  Blocks::iterator erase(Blocks::iterator block);

  btDynamicsWorld& bullet_;
  query::World& query_;
  std::shared_ptr<const models::EditLayer> edits_;  // at the last look
  double reach_m_ = 0;                              // of the models at that time
  std::uint64_t revision_;                          // of the world that the blocks belong to
  double block_m_;                                  // side of its blocks
  std::uint64_t last_step_ = 0;                     // the last step of need()
  core::BlockCoord origin_;
  Blocks blocks_;
};

}  // namespace psygen::physics
