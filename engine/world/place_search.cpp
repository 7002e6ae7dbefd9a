#include "engine/world/place_search.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

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

BlockObstacles::BlockObstacles(const World& world, core::BlockCoord block, SpacedBlocks* shared)
    : world_(world), block_(block), shared_(shared) {}
BlockObstacles::~BlockObstacles() = default;

std::span<const models::GroundEdit* const> BlockObstacles::roads(double margin_m) {
  if (world_.shaped.roads.empty() || !world_.shaped.layer) return {};
  const auto [answer, is_new] = roads_.try_emplace(margin_m);
  const double block_m = world_.block_size_m();
  if (is_new)
    answer->second = world_.shaped.layer->ground.roads_in(models::QuadCoord::of(block_), block_m,
                                                          margin_m / block_m);
  return answer->second;
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
  if (!others_) others_ = std::make_unique<Spacing>(world_, block_, shared_);
  return *others_;
}

PlaceSearch::PlaceSearch(const World& world, const Scatter& scatter, BlockObstacles& block)
    : world_(world),
      seed_(world.seed),
      size_m_(static_cast<float>(world.block_size_m())),
      scatter_(scatter),
      tries_(scatter.keeps_apart() ? 1 : kPlacementTries),
      has_filter_(scatter.has_filter()),
      obstacles_(block),
      block_(block.block()),
      min_up_(static_cast<float>(std::cos(glm::radians(scatter.max_slope_deg)))) {
  const SiteRules& site = scatter.site;
  if (site.min_slope_deg > 0)
    max_up_ = static_cast<float>(std::cos(glm::radians(site.min_slope_deg)));
  if (site.limits_facing()) {
    const double towards = glm::radians(site.facing_deg);
    facing_ = glm::vec2(std::sin(towards), -std::cos(towards));
    min_facing_ = static_cast<float>(std::cos(glm::radians(site.facing_spread_deg)));
  }
  if (scatter.mask.ground != 0) palette_ = drawn_palette(world);
}

bool PlaceSearch::has_rivers() const {
  return obstacles_.may_have_water(scatter_.water_reach_m());
}

// True if the limits allow this ground.
bool PlaceSearch::may_stand(const models::GroundPoint& ground, glm::dvec2 local_m) const {
  if (!(ground.height_m >= scatter_.min_height_m && ground.height_m <= scatter_.max_height_m &&
        ground.normal.y >= min_up_ && ground.normal.y <= max_up_))
    return false;
  if (scatter_.site.limits_facing() && !faces(ground.normal)) return false;
  if (scatter_.limits_depth()) {
    const auto water = water_over(local_m, has_rivers());
    if (water && water->depth_over(ground.height_m) > scatter_.max_depth_m) return false;
  }
  if (!palette_) return true;
  const GroundKind kind = main_kind(
      ground_blends(*palette_, static_cast<float>(ground.height_m), ground.normal,
                    pattern_place(block_, static_cast<double>(size_m_), glm::vec2(local_m))));
  return (scatter_.mask.ground >> static_cast<unsigned>(kind) & 1U) != 0;
}

bool PlaceSearch::faces(const glm::vec3& normal) const {
  static const auto flat = static_cast<float>(std::cos(glm::radians(SiteRules::kFlatDeg)));
  const glm::vec2 downhill(normal.x, normal.z);
  return normal.y > flat || glm::dot(downhill, facing_) >= min_facing_ * glm::length(downhill);
}

bool PlaceSearch::has_its_road(glm::dvec2 local_m) const {
  const double block_m = world_.block_size_m(), near_m = scatter_.site.near_road_m;
  const bool asks_for_one = std::isfinite(near_m);
  const double margin_m = std::max(asks_for_one ? near_m : 0, scatter_.site.far_from_road_m);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const models::GroundEdit* road : obstacles_.roads(margin_m))
    nearest_m = std::min(nearest_m, beside_road_m(*road->road, block_, local_m, block_m));
  return nearest_m >= scatter_.site.far_from_road_m && (!asks_for_one || nearest_m <= near_m);
}

bool PlaceSearch::has_its_neighbours(const models::BlockGround& ground, glm::dvec2 corner_m,
                                     glm::dvec2 local_m) const {
  return obstacles_.others().any_stands(scatter_.site, ground, corner_m, local_m);
}

bool PlaceSearch::may_be_near_inland(glm::dvec2 local_m, double reach_m) const {
  if (!has_rivers()) return false;
  const models::GroundStack& ground = world_.shaped.layer->ground;
  return ground.may_have_network_water(block_, local_m, reach_m) || ground.shapes.has_water();
}

std::optional<WaterSurface> PlaceSearch::water_over(glm::dvec2 local_m, bool is_inland) const {
  return is_inland ? function_water_surface(world_, {block_, {local_m.x, 0, local_m.y}})
                   : sea_surface(world_);
}

// Looks at the position, and at two rings of eight places around it.
bool PlaceSearch::is_near_water(const models::BlockGround& ground, glm::dvec2 corner_m,
                                glm::dvec2 local_m, double reach_m, double lowest_m) const {
  const bool is_inland = may_be_near_inland(local_m, reach_m);
  const auto is_wet = [&](glm::dvec2 at_m) {
    const auto water = water_over(at_m, is_inland);
    return water && water->surface_m >= lowest_m &&
           water->depth_over(ground.at(corner_m + at_m).height_m) > 0;
  };
  if (is_wet(local_m)) return true;
  for (const double share : {1.0, 0.5}) {
    for (const glm::dvec2& way : kCompass) {
      if (is_wet(local_m + way * (share * reach_m))) return true;
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
  for (const models::GroundEdit* road : obstacles_.roads(0)) {
    if (keeps_clear(*road->road, block_, local_m, static_cast<double>(size_m_))) return true;
  }
  if (!scatter_.mask.thins()) return false;
  const double share = mask_share(local_m);
  if (share <= 0 || share >= 1) return share <= 0;
  core::RandomStream random(seed_, block_.x, block_.z, index, core::Purpose::kMask);
  return random.next_unit() >= share;
}

double PlaceSearch::mask_share(glm::dvec2 local_m) const {
  const glm::dvec2 corner_m = glm::dvec2(block_.x, block_.z) * static_cast<double>(size_m_);
  return world::mask_share(scatter_.mask, seed_, corner_m + local_m);
}

double PlaceSearch::mask_share(std::uint32_t index) const {
  core::RandomStream random(seed_, block_.x, block_.z, index, core::Purpose::kPosition);
  return mask_share(draw_place(random, static_cast<double>(size_m_)));
}

std::optional<Foothold> PlaceSearch::find(const models::BlockGround& ground, std::uint32_t index,
                                          glm::dvec2 corner_m) const {
  core::RandomStream random(seed_, block_.x, block_.z, index, core::Purpose::kPosition);
  for (int i = 0; i < tries_; ++i) {
    const glm::dvec2 at_m = draw_place(random, static_cast<double>(size_m_));
    const models::GroundPoint point = ground.at(corner_m + at_m);
    if (has_filter_ && !may_stand(point, at_m)) continue;
    const SiteRules& site = scatter_.site;
    if (site.asks_for_roads() && !has_its_road(at_m)) continue;
    if (scatter_.needs_water() && !is_near_water(ground, corner_m, at_m, scatter_.near_water_m,
                                                 point.height_m - site.max_above_water_m))
      continue;
    if (site.far_from_water_m > 0 && is_near_water(ground, corner_m, at_m, site.far_from_water_m,
                                                   -std::numeric_limits<double>::infinity()))
      continue;
    if (scatter_.is_beside() && !has_its_neighbours(ground, corner_m, at_m)) continue;
    if (is_left_out(index, at_m, point.height_m)) return std::nullopt;
    return Foothold{{at_m.x, point.height_m, at_m.y}, point.normal};
  }
  return std::nullopt;
}

}  // namespace psygen::world
