// Queries of a world that need no mesh: ground under a point, rays against ground, models and
// objects, models near a point, colliders. Answers are exact: the ground is the two triangles per
// cell of the finest mesh, whatever is drawn. Positions are blocks and metres, so precision is the
// same at any distance from the origin. Blocks are made on first use and cached within a byte
// bound; answers do not depend on the cache. One thread. docs/queries.md.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/query/block_cache.hpp"
#include "engine/query/objects.hpp"
#include "engine/world/ground_blends.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/water.hpp"

namespace psygen::query {

// The ground under a point.
struct Ground {
  double height_m = 0;
  glm::vec3 normal{0, 1, 0};  // of the triangle; unit length
  // The surface kind with the largest cover, by the rule of the shader with the triangle's normal.
  // Water is no surface kind: its bottom has one.
  world::GroundKind kind = world::GroundKind::kGrass;
  double water_depth_m = 0;  // from the water's surface down to the ground; 0: dry
  double surface_m = 0;      // height of the water's surface; where dry, of the ground
  world::WaterBody water = world::kNoWater;  // the body of that water
};

// A straight ray.
struct Ray {
  core::WorldPosition origin;
  glm::dvec3 direction{0, -1, 0};  // any length above 0
  double longest_m = 1000;         // above 0; may be infinite; ends at the seam of an endless world
  bool ground = true;              // targets of the ray: the ground, models with a collider,
  bool models = true;
  bool objects = true;  // and objects, of World::meet()
  bool water = false;   // and the surface of the sea, of lakes and rivers, from above and below
};

// The kind of target that a ray hit.
enum class HitKind : std::uint8_t { kNothing, kGround, kModel, kObject, kWater };

// The end of a ray.
struct Hit {
  HitKind kind = HitKind::kNothing;
  double distance_m = 0;         // from the origin; for kNothing, the distance that was searched
  core::WorldPosition position;  // normalised
  glm::vec3 normal{0, 1, 0};     // of the surface, unit length; the ground's points upwards
  // True if the ray came out of the ground or out of the water, or began inside a collider (then
  // distance_m is 0 and the normal points against the ray).
  bool from_inside = false;
  core::BlockCoord block;                      // of the ground or the model
  std::uint32_t index = world::kTerrainIndex;  // of the model within the block
  models::ModelIndex model = 0;                // its type, or that of the terrain
  ObjectTag object = 0;                        // of kObject (scene::entity_of() in a scene)
  world::WaterBody water = world::kNoWater;    // of kWater
};

// A model with its position.
struct NearbyModel {
  core::BlockCoord block;
  std::uint32_t index = 0;       // within the block
  models::ModelIndex model = 0;  // its type
  core::WorldPosition position;  // of its base point
  double distance_m = 0;         // from its base point to the query's position
};

// The queries of one world. World and registry must outlive this object. The world's edits may
// change, and the world and its registry may be replaced in place under a new World::revision, as
// Scene::set_world() does: every call follows. It reads them without a lock, so it belongs to the
// thread that edits the world;
// in a scene this is the main thread. Another thread copies the value (world::World), which costs
// some kilobytes and shares no mutable state, and makes its own queries on the copy. Movable; not
// copyable.
class World {
 public:
  // Limit of the absolute value of a position's metres.
  static constexpr double kMaxLocalM = 1e9;
  // One query visits at most this many blocks: a ray ends there, a larger radius is rejected.
  static constexpr std::int64_t kMaxBlocks = 4096;
  static constexpr std::size_t kUsualBytes = std::size_t{32} << 20;

  // Caches visited blocks within `cache_bytes`, least recently used evicted first. Makes no block
  // yet.
  World(const world::World& world, const models::Registry& registry,
        std::size_t cache_bytes = kUsualBytes);

  // Makes rays, and bodies of physics on these queries, also collide with these objects, as they
  // are at each call. They must belong to the same world, and outlive this object or the next
  // meet(); null: no objects.
  void meet(const Objects* objects) { objects_ = objects; }
  const Objects* objects() const { return objects_; }

  // Returns the ground under (or above) a position, whose height is ignored. Fails with
  // kInvalidArgument for positions that are not finite or too far from their block, and outside a
  // bounded world, where there is no ground. About 50 ns in a cached block.
  core::Result<Ground> ground(const core::WorldPosition& at);

  // Returns the water at a position, whose height is ignored. Fails as ground() does. As fast.
  core::Result<world::WaterPoint> water(const core::WorldPosition& at);

  // Returns the first hit of a ray. It hits the ground from either side, and a collider from
  // outside. A ray that begins on the ground (within GroundGrid::kTouchM) and does not rise above
  // it hits it at distance 0. The ground has no vertical sides at the border of a bounded world.
  // The surface of rivers and lakes is sampled every half cell of the ground under the ray, so a
  // ray may miss a crest of less.
  // Fails with kInvalidArgument for an origin as above, a direction that is zero or not finite, and
  // a length that is not above 0. Time grows with the number of cells under the ray where it is
  // near the ground.
  core::Result<Hit> cast(const Ray& ray);

  // Replaces `out` by the models whose base points are within `radius_m` of `at` (in space),
  // nearest first, then by block and index; with `only`, models of these types. A radius of 0 finds
  // models at exactly this point. Fails with kInvalidArgument for a position as above and for a
  // radius that is negative or not finite, with kOverBudget for one that covers more than
  // kMaxBlocks.
  core::Result<void> models_within(const core::WorldPosition& at, double radius_m,
                                   std::vector<NearbyModel>& out,
                                   std::span<const models::ModelIndex> only = {});
  // Returns the nearest model of these types within a radius, or nothing. Errors as above.
  core::Result<std::optional<NearbyModel>> nearest(const core::WorldPosition& at, double radius_m,
                                                   std::span<const models::ModelIndex> only = {});
  // Returns the placement of a model: its parameters, for example for ModelType::collider().
  // Nothing if the block has no model of this index. Logarithmic in the block's models.
  std::optional<world::Placement> placement(core::BlockCoord block, std::uint32_t index);

  // Ground and models with colliders of a whole block, for physics. The block must be in the world.
  // Valid until the next call of any function.
  const GroundGrid& ground_grid(core::BlockCoord block) { return cache_.ground(block); }
  const BlockSolids& solids(core::BlockCoord block) { return cache_.solids(block); }

  // The largest horizontal reach of models from their base points, in metres, including models that
  // edits have placed. O(1).
  double models_reach_m() {
    follow_world();
    return static_cast<double>(max_reach_m().x);
  }

  // World and registry of these queries.
  const world::World& world() const { return *world_; }
  const models::Registry& registry() const { return *registry_; }

 private:
  struct Course;  // a checked ray
  struct BlockAround {
    core::BlockCoord block;
    glm::dvec3 corner_m{0.0};  // from the corner of the position's block
    double distance_m = 0;     // in the plane
  };
  // The values that depend on the world, and the call that makes them again for a replaced one.
  struct Derived {
    std::uint64_t revision = 0;
    double block_m = 0, relief_m = 0;
    glm::vec2 scattered_reach_m{0.0F};  // of the models that the world's function places
    world::Palette palette;
  };
  static Derived derived_from(const world::World& world, const models::Registry& registry);
  void follow_world() {
    if (world_->revision.number != derived_.revision) derived_ = derived_from(*world_, *registry_);
  }
  glm::vec2 max_reach_m() const {
    return world::with_placed_models(derived_.scattered_reach_m, *world_);
  }
  // Returns the normalised position; fails if it has no ground.
  core::Result<core::WorldPosition> on_ground(const core::WorldPosition& at) const;
  double seam_m(const Course& course) const;
  void cast_ground(const Course& course, Hit& hit);
  void cast_models(const Course& course, Hit& hit);
  void cast_objects(const Course& course, Hit& hit) const;
  void cast_water(const Course& course, Hit& hit);
  std::optional<world::WaterSurface> water_under(const Course& course, double t) const;
  bool meet_water(const Course& course, double t, Hit& hit);
  void cast_block(const Course& course, glm::dvec3 corner_m, core::BlockCoord block, Hit& hit);
  core::Result<std::vector<BlockAround>> blocks_within(const core::WorldPosition& at,
                                                       double radius_m) const;
  // Visits the models of these types in a block.
  template <class Visit>
  void each_model(const BlockAround& b, const core::WorldPosition& at,
                  std::span<const models::ModelIndex> only, const Visit& visit);

  const world::World* world_;
  const models::Registry* registry_;
  Derived derived_;
  BlockCache cache_;
  const Objects* objects_ = nullptr;
};

// Returns the position with local x and z in [0, block size). Fails with kInvalidArgument for
// values that are not finite or larger than World::kMaxLocalM.
core::Result<core::WorldPosition> checked(const core::WorldPosition& at, double block_size_m);

}  // namespace psygen::query
