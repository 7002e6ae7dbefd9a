#include "engine/world/spacing.hpp"

#include <algorithm>
#include <cmath>
#include <glm/vector_relational.hpp>
#include <numbers>
#include <tuple>

#include "engine/core/rounding.hpp"

namespace psygen::world {

double kept_share(double per_m2, double spacing_m) {
  const core::RoundToNearest rounding;
  const double within = per_m2 * std::numbers::pi * spacing_m * spacing_m;
  if (within <= 0) return 1;
  // e^λ as a power of 2^20, with the same bits on every machine.
  double power = 1 + within * 0x1p-20;
  for (int i = 0; i < 20; ++i)
    power *= power;
  return (1 - 1 / power) / within;
}

Spacing::Spacing(const World& world, core::BlockCoord block)
    : world_(world), block_(block), size_m_(world.block_size_m()) {
  std::uint32_t first = 0;
  for (const Scatter& scatter : world.scatter) {
    firsts_.push_back(first);
    first += scatter.count;
    widest_spacing_m_ = std::max(widest_spacing_m_, scatter.spacing_m);
    reach_m_ = std::max({reach_m_, scatter.spacing_m, scatter.site.beside_m});
  }
}

Spacing::Candidate Spacing::draw(core::BlockCoord block, std::uint32_t scatter,
                                 std::uint32_t index) const {
  core::RandomStream random(world_.seed, block.x, block.z, index, core::Purpose::kPosition);
  const glm::dvec2 at_m = draw_place(random, size_m_);
  return {at_m, random.next_u64(), index, scatter, {}, {}};
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
  const glm::dvec2 low = -glm::dvec2(offset) * size_m_ - reach_m_;
  const glm::dvec2 high = low + size_m_ + 2 * reach_m_;
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

Spacing::Below Spacing::below(Beside& block, const models::BlockGround& ground,
                              glm::dvec2 corner_m) const {
  if (block.offset == glm::ivec2(0, 0) || ground.node_level() > 0)
    return {ground, corner_m + glm::dvec2(block.offset) * size_m_};
  if (!block.ground)
    block.ground.emplace(unedited_terrain(world_), block.obstacles.block(),
                         world_.has_costly_heights() ? block.candidates.size() : 1);
  return {*block.ground, {0, 0}};
}

bool Spacing::is_allowed(Beside& block, Candidate& candidate, const Below& below) const {
  if (!candidate.is_allowed) {
    const PlaceSearch search(world_, world_.scatter[candidate.scatter], block.obstacles);
    candidate.is_allowed = search.find(below.ground, candidate.index, below.corner_m).has_value();
  }
  return *candidate.is_allowed;
}

template <class IsWanted>
bool Spacing::any_within(glm::dvec2 place_m, double reach_m, const IsWanted& is_wanted) {
  const auto block_at = [this](double m) { return static_cast<int>(std::floor(m / size_m_)); };
  for (int z = block_at(place_m.y - reach_m); z <= block_at(place_m.y + reach_m); ++z) {
    for (int x = block_at(place_m.x - reach_m); x <= block_at(place_m.x + reach_m); ++x) {
      Beside& block = beside({x, z});
      const glm::dvec2 place = place_m - glm::dvec2(x, z) * size_m_;
      auto next = std::ranges::lower_bound(block.candidates, place.x - reach_m, {},
                                           [](const Candidate& c) { return c.at_m.x; });
      for (; next != block.candidates.end() && next->at_m.x < place.x + reach_m; ++next) {
        const glm::dvec2 away = next->at_m - place;
        if (is_wanted(block, *next, away.x * away.x + away.y * away.y)) return true;
      }
    }
  }
  return false;
}

bool Spacing::is_crowded(std::uint32_t index, const models::BlockGround& ground,
                         glm::dvec2 corner_m) {
  const auto scatter =
      static_cast<std::uint32_t>(std::ranges::upper_bound(firsts_, index) - firsts_.begin() - 1);
  const Candidate own = draw(block_, scatter, index);
  const double spacing_m = world_.scatter[scatter].spacing_m;
  const auto is_in_the_way = [&](Beside& block, Candidate& other, double away2) {
    const double apart_m = (spacing_m + world_.scatter[other.scatter].spacing_m) / 2;
    return away2 < apart_m * apart_m && comes_first(other, block.offset, own) &&
           is_allowed(block, other, below(block, ground, corner_m));
  };
  return any_within(own.at_m, (spacing_m + widest_spacing_m_) / 2, is_in_the_way);
}

bool Spacing::any_stands(const SiteRules& site, const models::BlockGround& ground,
                         glm::dvec2 corner_m, glm::dvec2 place_m) {
  const auto stands = [&](Beside& block, Candidate& other, double away2) {
    if ((site.beside >> other.scatter & 1U) == 0 || away2 >= site.beside_m * site.beside_m)
      return false;
    if (!other.stands) {
      const Below here = below(block, ground, corner_m);
      Spacing& around = block.offset == glm::ivec2(0, 0) ? *this : block.obstacles.others();
      other.stands = is_allowed(block, other, here) &&
                     !around.is_crowded(other.index, here.ground, here.corner_m);
    }
    return *other.stands;
  };
  return any_within(place_m, site.beside_m, stands);
}

}  // namespace psygen::world
