#include "engine/world/place_search.hpp"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "engine/models/edits.hpp"
#include "engine/world/compass.hpp"
#include "engine/world/ground_blends.hpp"
#include "engine/world/spacing.hpp"
#include "engine/world/water.hpp"

namespace psygen::world {

models::Parameters unedited_terrain(const World& world) {
  models::Parameters p = world.terrain;
  p.set_edits(world.shaped.layer.get(), 0);
  return p;
}

glm::dvec2 draw_place(core::RandomStream& random, double block_m) {
  const auto coordinate = [&] {
    const auto side = static_cast<float>(block_m);
    const auto drawn = static_cast<float>(random.next_unit() * static_cast<double>(side));
    return static_cast<double>(drawn < side ? drawn : std::nextafter(side, 0.0F));
  };
  const double x = coordinate();
  return {x, coordinate()};
}

BlockObstacles::BlockObstacles(const World& world, core::BlockCoord block)
    : world_(world), block_(block) {}
BlockObstacles::~BlockObstacles() = default;

std::span<const models::GroundEdit* const> BlockObstacles::roads() {
  if (!roads_) {
    roads_.emplace();
    if (!world_.shaped.roads.empty() && world_.shaped.layer)
      *roads_ = world_.shaped.layer->ground.roads_in(models::QuadCoord::of(block_),
                                                     world_.block_size_m());
  }
  return *roads_;
}

bool BlockObstacles::may_have_water(double margin_m) {
  if (!world_.shaped.has_water() || !world_.shaped.layer) return false;
  const auto known = std::ranges::find(water_, margin_m, &std::pair<double, bool>::first);
  if (known != water_.end()) return known->second;
  const bool may =
      world_.shaped.layer->ground.may_have_water(block_, margin_m, world_.block_size_m());
  return water_.emplace_back(margin_m, may).second;
}

Spacing& BlockObstacles::others() {
  if (!others_) others_ = std::make_unique<Spacing>(world_, block_);
  return *others_;
}

PlaceSearch::PlaceSearch(const World& world, const Scatter& scatter, BlockObstacles& block)
    : world_(world),
      seed_(world.seed),
      size_m_(static_cast<float>(world.block_size_m())),
      scatter_(scatter),
      tries_(scatter.keeps_apart() ? 1 : kPlacementTries),
      obstacles_(block),
      block_(block.block()),
      min_up_(static_cast<float>(std::cos(glm::radians(scatter.max_slope_deg)))) {
  if (scatter.mask.ground != 0) palette_ = drawn_palette(world);
}

bool PlaceSearch::has_rivers() const {
  return obstacles_.may_have_water(scatter_.needs_water() ? scatter_.near_water_m : 0);
}

// True if the limits allow this ground.
bool PlaceSearch::may_stand(const models::GroundPoint& ground, glm::dvec2 local_m) const {
  if (!(ground.height_m >= scatter_.min_height_m && ground.height_m <= scatter_.max_height_m &&
        ground.normal.y >= min_up_))
    return false;
  if (scatter_.limits_depth()) {
    const auto water = water_over(local_m);
    if (water && water->depth_over(ground.height_m) > scatter_.max_depth_m) return false;
  }
  if (!palette_) return true;
  const GroundKind kind = main_kind(
      ground_blends(*palette_, static_cast<float>(ground.height_m), ground.normal,
                    pattern_place(block_, static_cast<double>(size_m_), glm::vec2(local_m))));
  return (scatter_.mask.ground >> static_cast<unsigned>(kind) & 1U) != 0;
}

// The surface of the water of the world's function.
std::optional<WaterSurface> PlaceSearch::water_over(glm::dvec2 local_m) const {
  return has_rivers() ? function_water_surface(world_, {block_, {local_m.x, 0, local_m.y}})
                      : sea_surface(world_);
}

// True if there is water at the position, or on one of two rings of eight places around it.
bool PlaceSearch::is_near_water(const models::BlockGround& ground, glm::dvec2 corner_m,
                                glm::dvec2 local_m) const {
  const auto is_wet = [&](glm::dvec2 at_m) {
    const auto water = water_over(at_m);
    return water && water->depth_over(ground.at(corner_m + at_m).height_m) > 0;
  };
  if (is_wet(local_m)) return true;
  for (const double share : {1.0, 0.5}) {
    for (const glm::dvec2& way : kCompass) {
      if (is_wet(local_m + way * (share * scatter_.near_water_m))) return true;
    }
  }
  return false;
}

// True if a road, water or a mask excludes the instance at this position.
bool PlaceSearch::is_left_out(std::uint32_t index, glm::dvec2 local_m, double ground_m) const {
  if (!scatter_.limits_depth() && has_rivers()) {
    const auto water =
        world_.shaped.layer->ground.water_over(block_, local_m, static_cast<double>(size_m_));
    if (water && (water->widths <= 0.5 || water->surface_m > ground_m)) return true;
  }
  for (const models::GroundEdit* road : obstacles_.roads()) {
    if (keeps_clear(*road->road, block_, local_m, static_cast<double>(size_m_))) return true;
  }
  if (!scatter_.mask.thins()) return false;
  const glm::dvec2 place_m =
      glm::dvec2(block_.x, block_.z) * static_cast<double>(size_m_) + local_m;
  const double share = mask_share(scatter_.mask, seed_, place_m);
  if (share <= 0 || share >= 1) return share <= 0;
  core::RandomStream random(seed_, block_.x, block_.z, index, core::Purpose::kMask);
  return random.next_unit() >= share;
}

std::optional<Foothold> PlaceSearch::find(const models::BlockGround& ground, std::uint32_t index,
                                          glm::dvec2 corner_m) const {
  core::RandomStream random(seed_, block_.x, block_.z, index, core::Purpose::kPosition);
  for (int i = 0; i < tries_; ++i) {
    const glm::dvec2 at_m = draw_place(random, static_cast<double>(size_m_));
    const models::GroundPoint point = ground.at(corner_m + at_m);
    if (scatter_.has_filter() && !may_stand(point, at_m)) continue;
    if (scatter_.needs_water() && !is_near_water(ground, corner_m, at_m)) continue;
    if (is_left_out(index, at_m, point.height_m)) return std::nullopt;
    return Foothold{{at_m.x, point.height_m, at_m.y}, point.normal};
  }
  return std::nullopt;
}

}  // namespace psygen::world
