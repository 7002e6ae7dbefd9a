// Keeps instances of scatters with a spacing apart. Each owns a disc of this diameter, and no two
// discs overlap. An instance is left out if an instance of higher priority, which its own scatter
// allows, lies within reach, even if that one is left out too. Priority: the larger spacing, the
// earlier scatter, a random number. So nothing depends on instances farther away than one spacing,
// nor on the order of questions: the bits are the same from both sides of every border. One thread.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "engine/world/place_search.hpp"

namespace psygen::world {

// The mean fraction of instances that stand where all ground is allowed, among so many a square
// metre: (1 − e^−λ) / λ, with λ of them within one spacing. 1 without a spacing.
double kept_share(double per_m2, double spacing_m);

// An instance that tries to stand.
struct Candidate {
  glm::dvec2 at_m{0.0};    // from its block's corner
  std::uint64_t turn = 0;  // random: the higher comes first
  std::uint32_t index = 0, scatter = 0;
  std::optional<bool> is_allowed, stands;  // by its own scatter; and by its neighbours, too
};

// A block with those of its candidates that matter, by ascending x.
struct SpacedBlock {
  SpacedBlock(const World& world, core::BlockCoord at, SpacedBlocks* shared)
      : block(at), obstacles(world, at, shared), searches(world.scatter.size()) {}
  SpacedBlock(const SpacedBlock&) = delete;
  SpacedBlock& operator=(const SpacedBlock&) = delete;

  core::BlockCoord block;
  BlockObstacles obstacles;
  std::vector<Candidate> candidates;
  std::optional<models::BlockGround> ground;         // without edits
  std::vector<std::optional<PlaceSearch>> searches;  // of each scatter
};

// The blocks that one or more Spacing ask about, drawn when they are first needed.
class SpacedBlocks {
 public:
  // With a centre only the candidates that may reach this block are drawn. Without one, or if any
  // scatter stands beside another, blocks share all. `world` must outlive it.
  explicit SpacedBlocks(const World& world, std::optional<core::BlockCoord> centre = {});
  SpacedBlock& at(core::BlockCoord block);
  // The candidate of instance `index`.
  Candidate draw(core::BlockCoord block, std::uint32_t index) const;
  double widest_m() const { return widest_m_; }

 private:
  const World& world_;
  std::optional<core::BlockCoord> centre_;
  double size_m_, widest_m_ = 0;       // the widest spacing
  double reach_m_ = 0;                 // the largest distance to an instance that matters
  std::vector<std::uint32_t> firsts_;  // index of each scatter's first instance
  std::vector<std::unique_ptr<SpacedBlock>> blocks_;
};

// The instances that keep apart on a block and around it.
class Spacing {
 public:
  // `world` and `shared` (null: none) must outlive it.
  Spacing(const World& world, core::BlockCoord block, SpacedBlocks* shared);

  // True if instance `index` of the block gives way to another.
  // `ground` and `corner_m` are those of PlaceSearch::find(). Instances of other blocks stand on
  // the unedited ground of their block, or on `ground` if it is a node's.
  bool is_crowded(std::uint32_t index, const models::BlockGround& ground, glm::dvec2 corner_m);
  // True if an instance of the scatters `site.beside` stands within `site.beside_m` of a place in
  // the block.
  bool any_stands(const SiteRules& site, const models::BlockGround& ground, glm::dvec2 corner_m,
                  glm::dvec2 place_m);

 private:
  // A block beside ours, or ours.
  struct Beside {
    glm::ivec2 offset;  // blocks
    SpacedBlock* spaced;
  };
  // A ground, and where a block's corner is in it.
  struct GroundAt {
    const models::BlockGround& ground;
    glm::dvec2 corner_m;
  };
  Beside beside(glm::ivec2 offset);
  bool comes_first(const Candidate& a, core::BlockCoord a_block, const Candidate& b) const;
  GroundAt ground_of(const Beside& beside, const models::BlockGround& ground,
                     glm::dvec2 corner_m) const;
  bool is_allowed(const Beside& beside, Candidate& candidate, const GroundAt& at) const;
  // Returns true if `is_wanted(beside, candidate, squared distance)` accepts any candidate within
  // reach of a place in the block.
  template <class IsWanted>
  bool any_within(glm::dvec2 place_m, double reach_m, const IsWanted& is_wanted);

  const World& world_;
  core::BlockCoord block_;
  double size_m_;
  std::unique_ptr<SpacedBlocks> own_;  // null: shared ones
  SpacedBlocks& blocks_;
  std::vector<Beside> beside_;
};

}  // namespace psygen::world
