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

// The instances that keep apart on a block and around it, drawn when they are first needed.
class Spacing {
 public:
  // `world` must outlive it.
  Spacing(const World& world, core::BlockCoord block);

  // True if instance `index` of the block gives way to another.
  // `ground` and `corner_m` are those of PlaceSearch::find(). Instances of other blocks stand on
  // the unedited ground of their block, or on `ground` if it is a node's.
  bool is_crowded(std::uint32_t index, const models::BlockGround& ground, glm::dvec2 corner_m);

 private:
  struct Candidate {
    glm::dvec2 at_m{0.0};    // from its block's corner
    std::uint64_t turn = 0;  // random: the higher comes first
    std::uint32_t index = 0, scatter = 0;
    std::optional<bool> is_allowed;
  };
  // A block with its candidates by ascending x.
  struct Beside {
    glm::ivec2 offset;  // blocks
    BlockObstacles obstacles;
    std::vector<Candidate> candidates;
    std::optional<models::BlockGround> ground;
  };
  Beside& beside(glm::ivec2 offset);
  Candidate draw(core::BlockCoord block, std::uint32_t scatter, std::uint32_t index) const;
  bool comes_first(const Candidate& a, glm::ivec2 a_block, const Candidate& b) const;
  bool is_allowed(Beside& block, Candidate& candidate, const models::BlockGround& ground,
                  glm::dvec2 corner_m) const;

  const World& world_;
  core::BlockCoord block_;
  double size_m_, widest_m_ = 0;
  std::vector<std::uint32_t> firsts_;  // index of each scatter's first instance
  std::vector<std::unique_ptr<Beside>> beside_;
};

}  // namespace psygen::world
