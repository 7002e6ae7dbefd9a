// The places that the limits of a scatter allow on a block, before instances keep apart (Spacing).
// Pure functions of the world and the block. One thread.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

class Spacing;  // spacing.hpp
class SpacedBlocks;
struct WaterSurface;  // water.hpp

// An instance tries this many random positions until its Scatter allows one. Instances that keep
// apart try one.
inline constexpr int kPlacementTries = 24;

// The terrain of the world's function, with stamps and roads but without edits. Instances find
// their places on it.
models::Parameters unedited_terrain(const World& world);

// A random place on a block that floats represent exactly, so that the height belongs to it: x and
// z in metres from the block's corner.
glm::dvec2 draw_place(core::RandomStream& random, double block_m);

// Roads, water of the world's function and other instances that may keep an instance away from a
// place of a block. Found when they are first asked for.
class BlockObstacles {
 public:
  // `world` must outlive it, and so must `shared`: blocks that several of these share, or null.
  BlockObstacles(const World& world, core::BlockCoord block, SpacedBlocks* shared = nullptr);
  ~BlockObstacles();
  core::BlockCoord block() const { return block_; }
  // The roads that may come within so many metres of the block.
  std::span<const models::GroundEdit* const> roads(double margin_m);
  // True if there may be rivers or lakes within so many metres.
  bool may_have_water(double margin_m);
  // The instances that keep apart.
  Spacing& others();

 private:
  const World& world_;
  core::BlockCoord block_;
  SpacedBlocks* shared_;
  // Answers by margin. A map keeps its answers in place.
  std::map<double, std::vector<const models::GroundEdit*>> roads_;
  std::vector<std::pair<double, bool>> water_;
  std::unique_ptr<Spacing> others_;
};

// The position of an instance, in metres from the block's corner.
struct Foothold {
  glm::vec3 position{0.0F};
  glm::vec3 normal{0, 1, 0};  // of the ground
};

// One scatter on one block.
class PlaceSearch {
 public:
  // All arguments must outlive it.
  PlaceSearch(const World& world, const Scatter& scatter, BlockObstacles& block);

  // The fraction of instances that the mask keeps at the first position that an instance tries.
  double mask_share(std::uint32_t index) const;
  // The first allowed position that instance `index` of the block tries. Nothing if no position is
  // allowed, or if a mask, a road or water excludes the one found. `ground` is the ground of the
  // block, or of a larger node in which the block's corner is at `corner_m`.
  std::optional<Foothold> find(const models::BlockGround& ground, std::uint32_t index,
                               glm::dvec2 corner_m = {0, 0}) const;

 private:
  // True if rivers or lakes may be where instances look for water.
  bool has_rivers() const;
  bool may_stand(const models::GroundPoint& ground, glm::dvec2 local_m) const;
  bool faces(const glm::vec3& normal) const;
  bool has_its_road(glm::dvec2 local_m) const;
  // True if there is water within `reach_m` of the position, on or above this height.
  bool is_near_water(const models::BlockGround& ground, glm::dvec2 corner_m, glm::dvec2 local_m,
                     double reach_m, double lowest_m) const;
  bool has_its_neighbours(const models::BlockGround& ground, glm::dvec2 corner_m,
                          glm::dvec2 local_m) const;
  // True if inland water may be within reach of the position.
  bool may_be_near_inland(glm::dvec2 local_m, double reach_m) const;
  // The surface of the water of the world's function; of the sea only if nothing else is there.
  std::optional<WaterSurface> water_over(glm::dvec2 local_m, bool is_inland) const;
  double mask_share(glm::dvec2 local_m) const;
  bool is_left_out(std::uint32_t index, glm::dvec2 local_m, double ground_m) const;

  const World& world_;
  std::uint64_t seed_;
  float size_m_;
  const Scatter& scatter_;
  int tries_;
  bool has_filter_;
  BlockObstacles& obstacles_;
  core::BlockCoord block_;
  float min_up_, max_up_ = 2;  // of the unit normal
  glm::vec2 facing_{0.0F};     // the direction, and the least cosine between it and the slope
  float min_facing_ = -1;
  std::optional<Palette> palette_;  // set if the mask selects kinds of ground
};

}  // namespace psygen::world
