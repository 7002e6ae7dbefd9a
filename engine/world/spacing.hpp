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

// The instances that keep apart on a block and around it, drawn when they are first needed.
class Spacing {
 public:
  // `world` must outlive it.
  Spacing(const World& world, core::BlockCoord block);

  // True if instance `index` of the block gives way to another.
  // `ground` and `corner_m` are those of PlaceSearch::find(). Instances of other blocks stand on
  // the unedited ground of their block, or on `ground` if it is a node's.
  bool is_crowded(std::uint32_t index, const models::BlockGround& ground, glm::dvec2 corner_m);
  // True if an instance of the scatters `site.beside` stands within `site.beside_m` of a place in
  // the block.
  bool any_stands(const SiteRules& site, const models::BlockGround& ground, glm::dvec2 corner_m,
                  glm::dvec2 place_m);

 private:
  struct Candidate {
    glm::dvec2 at_m{0.0};    // from its block's corner
    std::uint64_t turn = 0;  // random: the higher comes first
    std::uint32_t index = 0, scatter = 0;
    std::optional<bool> is_allowed, stands;
  };
  // A block with its candidates by ascending x.
  struct Beside {
    glm::ivec2 offset;  // blocks
    BlockObstacles obstacles;
    std::vector<Candidate> candidates;
    std::optional<models::BlockGround> ground;
  };
  // A ground, and where a block's corner is in it.
  struct Below {
    const models::BlockGround& ground;
    glm::dvec2 corner_m;
  };
  Beside& beside(glm::ivec2 offset);
  Candidate draw(core::BlockCoord block, std::uint32_t scatter, std::uint32_t index) const;
  bool comes_first(const Candidate& a, glm::ivec2 a_block, const Candidate& b) const;
  Below below(Beside& block, const models::BlockGround& ground, glm::dvec2 corner_m) const;
  bool is_allowed(Beside& block, Candidate& candidate, const Below& below) const;
  // True if `is_wanted(block, candidate, squared distance)` is, for a candidate within reach of a
  // place in the block.
  template <class IsWanted>
  bool any_within(glm::dvec2 place_m, double reach_m, const IsWanted& is_wanted);

  const World& world_;
  core::BlockCoord block_;
  double size_m_, widest_spacing_m_ = 0;
  double reach_m_ = 0;                 // the largest distance to an instance that matters
  std::vector<std::uint32_t> firsts_;  // index of each scatter's first instance
  std::vector<std::unique_ptr<Beside>> beside_;
};

}  // namespace psygen::world
