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
  if (within < 1e-3) return 1 - within / 2 + within * within / 6;
  // e^λ as a power of 2^20, with the same bits on every machine.
  double power = 1 + within * 0x1p-20;
  for (int i = 0; i < 20; ++i)
    power *= power;
  return std::clamp((1 - 1 / power) / within, 0.0, 1.0);
}

SpacedBlocks::SpacedBlocks(const World& world, std::optional<core::BlockCoord> centre)
    : world_(world), centre_(centre), size_m_(world.block_size_m()) {
  std::uint32_t first = 0;
  for (const Scatter& scatter : world.scatter) {
    firsts_.push_back(first);
    first += scatter.count;
    widest_m_ = std::max(widest_m_, scatter.spacing_m);
    reach_m_ = std::max({reach_m_, scatter.spacing_m, scatter.site.beside_m});
    if (scatter.is_beside()) centre_.reset();  // asks what stands around the neighbours, too
  }
}

Candidate SpacedBlocks::draw(core::BlockCoord block, std::uint32_t index) const {
  core::RandomStream random(world_.seed, block.x, block.z, index, core::Purpose::kPosition);
  const glm::dvec2 at_m = draw_place(random, size_m_);
  const auto after = std::ranges::upper_bound(firsts_, index);
  return {at_m,  random.next_u64(),
          index, static_cast<std::uint32_t>(after - firsts_.begin() - 1),
          {},    {}};
}

SpacedBlock& SpacedBlocks::at(core::BlockCoord block) {
  const auto known =
      std::ranges::find(blocks_, block, [](const auto& spaced) { return spaced->block; });
  if (known != blocks_.end()) return **known;
  SpacedBlock& made =
      *blocks_.emplace_back(std::make_unique<SpacedBlock>(world_, block, centre_ ? nullptr : this));
  if (!world_.contains(block)) return made;
  // Skips candidates beyond the reach of the centre.
  glm::dvec2 low(0.0), high(size_m_);
  if (centre_) {
    const auto blocks = [](std::int32_t from, std::int32_t to) {
      return static_cast<std::int32_t>(static_cast<std::uint32_t>(to) -
                                       static_cast<std::uint32_t>(from));
    };
    const glm::dvec2 offset(blocks(centre_->x, block.x), blocks(centre_->z, block.z));
    low = -offset * size_m_ - reach_m_;
    high = low + size_m_ + 2 * reach_m_;
  }
  for (std::uint32_t s = 0; s < world_.scatter.size(); ++s) {
    if (!world_.scatter[s].keeps_apart()) continue;
    for (std::uint32_t k = 0; k < world_.scatter[s].count; ++k) {
      const Candidate c = draw(block, firsts_[s] + k);
      if (glm::all(glm::lessThanEqual(low, c.at_m)) && glm::all(glm::lessThan(c.at_m, high)))
        made.candidates.push_back(c);
    }
  }
  std::ranges::sort(made.candidates, {}, [](const Candidate& c) { return c.at_m.x; });
  return made;
}

Spacing::Spacing(const World& world, core::BlockCoord block, SpacedBlocks* shared)
    : world_(world),
      block_(block),
      size_m_(world.block_size_m()),
      own_(shared != nullptr ? nullptr : std::make_unique<SpacedBlocks>(world, block)),
      blocks_(shared != nullptr ? *shared : *own_) {}

Spacing::Beside Spacing::beside(glm::ivec2 offset) {
  const auto known = std::ranges::find(beside_, offset, &Beside::offset);
  if (known != beside_.end()) return *known;
  beside_.push_back({offset, &blocks_.at(core::moved(block_, offset.x, offset.y))});
  return beside_.back();
}

// True if `a`, on this block, comes before `b`, on our block.
bool Spacing::comes_first(const Candidate& a, core::BlockCoord a_block, const Candidate& b) const {
  const auto rank = [this](const Candidate& c, core::BlockCoord block) {
    return std::tuple(-world_.scatter[c.scatter].spacing_m, c.scatter, ~c.turn, block.x, block.z,
                      c.index);
  };
  return rank(a, a_block) < rank(b, block_);
}

Spacing::GroundAt Spacing::ground_of(const Beside& beside, const models::BlockGround& ground,
                                     glm::dvec2 corner_m) const {
  if (beside.offset == glm::ivec2(0, 0) || ground.node_level() > 0)
    return {ground, corner_m + glm::dvec2(beside.offset) * size_m_};
  SpacedBlock& block = *beside.spaced;
  if (!block.ground)
    block.ground.emplace(unedited_terrain(world_), block.block,
                         world_.has_costly_heights() ? block.candidates.size() : 1);
  return {*block.ground, {0, 0}};
}

bool Spacing::is_allowed(const Beside& beside, Candidate& candidate, const GroundAt& at) const {
  if (!candidate.is_allowed) {
    auto& search = beside.spaced->searches[candidate.scatter];
    if (!search)
      search.emplace(world_, world_.scatter[candidate.scatter], beside.spaced->obstacles);
    candidate.is_allowed = search->find(at.ground, candidate.index, at.corner_m).has_value();
  }
  return *candidate.is_allowed;
}

template <class IsWanted>
bool Spacing::any_within(glm::dvec2 place_m, double reach_m, const IsWanted& is_wanted) {
  const auto block_at = [this](double m) { return static_cast<int>(std::floor(m / size_m_)); };
  for (int z = block_at(place_m.y - reach_m); z <= block_at(place_m.y + reach_m); ++z) {
    for (int x = block_at(place_m.x - reach_m); x <= block_at(place_m.x + reach_m); ++x) {
      const Beside there = beside({x, z});
      std::vector<Candidate>& candidates = there.spaced->candidates;
      const glm::dvec2 place = place_m - glm::dvec2(x, z) * size_m_;
      auto next = std::ranges::lower_bound(candidates, place.x - reach_m, {},
                                           [](const Candidate& c) { return c.at_m.x; });
      for (; next != candidates.end() && next->at_m.x < place.x + reach_m; ++next) {
        const glm::dvec2 away = next->at_m - place;
        if (is_wanted(there, *next, away.x * away.x + away.y * away.y)) return true;
      }
    }
  }
  return false;
}

bool Spacing::is_crowded(std::uint32_t index, const models::BlockGround& ground,
                         glm::dvec2 corner_m) {
  const Candidate own = blocks_.draw(block_, index);
  const double spacing_m = world_.scatter[own.scatter].spacing_m;
  const auto is_in_the_way = [&](const Beside& there, Candidate& other, double away2) {
    const double apart_m = (spacing_m + world_.scatter[other.scatter].spacing_m) / 2;
    return away2 < apart_m * apart_m && comes_first(other, there.spaced->block, own) &&
           is_allowed(there, other, ground_of(there, ground, corner_m));
  };
  return any_within(own.at_m, (spacing_m + blocks_.widest_m()) / 2, is_in_the_way);
}

bool Spacing::any_stands(const SiteRules& site, const models::BlockGround& ground,
                         glm::dvec2 corner_m, glm::dvec2 place_m) {
  const auto stands = [&](const Beside& there, Candidate& other, double away2) {
    if ((site.beside >> other.scatter & 1U) == 0 || away2 >= site.beside_m * site.beside_m)
      return false;
    if (!other.stands) {
      const GroundAt here = ground_of(there, ground, corner_m);
      const bool is_own = there.offset == glm::ivec2(0, 0);
      Spacing& around = is_own ? *this : there.spaced->obstacles.others();
      other.stands = is_allowed(there, other, here) &&
                     !around.is_crowded(other.index, here.ground, here.corner_m);
    }
    return *other.stands;
  };
  return any_within(place_m, site.beside_m, stands);
}

}  // namespace psygen::world
