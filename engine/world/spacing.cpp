#include "engine/world/spacing.hpp"

#include <algorithm>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <tuple>

namespace psygen::world {

Spacing::Spacing(const World& world, core::BlockCoord block)
    : world_(world), block_(block), size_m_(world.block_size_m()) {
  std::uint32_t first = 0;
  for (const Scatter& scatter : world.scatter) {
    firsts_.push_back(first);
    first += scatter.count;
    widest_m_ = std::max(widest_m_, scatter.spacing_m);
  }
}

Spacing::Candidate Spacing::draw(core::BlockCoord block, std::uint32_t scatter,
                                 std::uint32_t index) const {
  core::RandomStream random(world_.seed, block.x, block.z, index, core::Purpose::kPosition);
  const glm::dvec2 at_m = draw_place(random, size_m_);
  return {at_m, random.next_u64(), index, scatter, {}};
}

Spacing::Beside& Spacing::beside(glm::ivec2 offset) {
  const auto known = std::ranges::find(beside_, offset, [](const auto& b) { return b->offset; });
  if (known != beside_.end()) return **known;
  const core::BlockCoord block = core::moved(block_, offset.x, offset.y);
  beside_.push_back(
      std::unique_ptr<Beside>(new Beside{offset, BlockObstacles(world_, block), {}, {}}));
  Beside& made = *beside_.back();
  if (!world_.contains(block)) return made;
  // Skips candidates beyond the reach of our block.
  const glm::dvec2 low = -glm::dvec2(offset) * size_m_ - widest_m_;
  const glm::dvec2 high = low + size_m_ + 2 * widest_m_;
  for (std::uint32_t s = 0; s < world_.scatter.size(); ++s) {
    if (!world_.scatter[s].keeps_apart()) continue;
    for (std::uint32_t k = 0; k < world_.scatter[s].count; ++k) {
      const Candidate c = draw(block, s, firsts_[s] + k);
      if (glm::all(glm::lessThan(low, c.at_m)) && glm::all(glm::lessThan(c.at_m, high)))
        made.candidates.push_back(c);
    }
  }
  std::ranges::sort(made.candidates, {}, [](const Candidate& c) { return c.at_m.x; });
  return made;
}

// True if `a`, on the block at this offset, comes before `b`, on our block.
bool Spacing::comes_first(const Candidate& a, glm::ivec2 a_block, const Candidate& b) const {
  const auto rank = [this](const Candidate& c, core::BlockCoord block) {
    return std::tuple(-world_.scatter[c.scatter].spacing_m, c.scatter, ~c.turn, block.x, block.z,
                      c.index);
  };
  return rank(a, core::moved(block_, a_block.x, a_block.y)) < rank(b, block_);
}

bool Spacing::is_allowed(Beside& block, Candidate& candidate, const models::BlockGround& ground,
                         glm::dvec2 corner_m) const {
  if (candidate.is_allowed) return *candidate.is_allowed;
  const PlaceSearch search(world_, world_.scatter[candidate.scatter], block.obstacles);
  const bool is_own = block.offset == glm::ivec2(0, 0);
  std::optional<Foothold> found;
  if (is_own || ground.node_level() > 0) {
    found = search.find(ground, candidate.index, corner_m + glm::dvec2(block.offset) * size_m_);
  } else {
    if (!block.ground)
      block.ground.emplace(unedited_terrain(world_), block.obstacles.block(),
                           world_.has_costly_heights() ? block.candidates.size() : 1);
    found = search.find(*block.ground, candidate.index);
  }
  candidate.is_allowed = found.has_value();
  return *candidate.is_allowed;
}

bool Spacing::is_crowded(std::uint32_t index, const models::BlockGround& ground,
                         glm::dvec2 corner_m) {
  const auto scatter =
      static_cast<std::uint32_t>(std::ranges::upper_bound(firsts_, index) - firsts_.begin() - 1);
  const Candidate own = draw(block_, scatter, index);
  const double spacing_m = world_.scatter[scatter].spacing_m;
  const double reach_m = (spacing_m + widest_m_) / 2;
  const auto block_at = [this](double m) { return static_cast<int>(std::floor(m / size_m_)); };
  for (int z = block_at(own.at_m.y - reach_m); z <= block_at(own.at_m.y + reach_m); ++z) {
    for (int x = block_at(own.at_m.x - reach_m); x <= block_at(own.at_m.x + reach_m); ++x) {
      Beside& block = beside({x, z});
      const glm::dvec2 corner = glm::dvec2(x, z) * size_m_, place = own.at_m - corner;
      auto next = std::ranges::lower_bound(block.candidates, place.x - reach_m, {},
                                           [](const Candidate& c) { return c.at_m.x; });
      for (; next != block.candidates.end() && next->at_m.x < place.x + reach_m; ++next) {
        const glm::dvec2 away = next->at_m - place;
        const double apart_m = (spacing_m + world_.scatter[next->scatter].spacing_m) / 2;
        if (away.x * away.x + away.y * away.y >= apart_m * apart_m) continue;
        if (!comes_first(*next, {x, z}, own)) continue;
        if (is_allowed(block, *next, ground, corner_m)) return true;
      }
    }
  }
  return false;
}

}  // namespace psygen::world
