#include "engine/query/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <tuple>

#include "engine/core/rounding.hpp"
#include "engine/models/edits.hpp"
#include "engine/models/terrain/terrain.hpp"

namespace psygen::query {
namespace {

using core::BlockCoord;
using core::ErrorCode;

// Blocks from `first` to `last`, both included, relative to another block.
struct BlockRange {
  glm::dvec2 first, last;
  double count() const { return (last.x - first.x + 1) * (last.y - first.y + 1); }
};
BlockRange blocks_around(glm::dvec2 low_m, glm::dvec2 high_m, double block_m) {
  return {glm::floor(low_m / block_m), glm::floor(high_m / block_m)};
}

auto rank(const NearbyModel& m) {
  return std::tuple(m.distance_m, m.block, m.index);
}

constexpr double kSteepestWater = 2;  // slope of falls

// Brings `low` and `high` together; is_low(low) and !is_low(high) stay true.
template <class IsLow>
void halve_step(double& low, double& high, const IsLow& is_low) {
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (is_low(middle) ? low : high) = middle;
  }
}

}  // namespace

core::Result<core::WorldPosition> checked(const core::WorldPosition& at, double block_size_m) {
  const auto is_sound = [](double v) { return std::abs(v) <= World::kMaxLocalM; };  // not of NaN
  if (!is_sound(at.local.x) || !is_sound(at.local.y) || !is_sound(at.local.z))
    return core::invalid_argument(
        fmt::format("the position ({}, {}, {}) m in block ({}, {}) is not finite or "
                    "farther than {} m from its block",
                    at.local.x, at.local.y, at.local.z, at.block.x, at.block.z, World::kMaxLocalM));
  return core::normalised(at, block_size_m);
}

World::World(const world::World& world, const models::Registry& registry, std::size_t cache_bytes)
    : world_(&world),
      registry_(&registry),
      derived_(derived_from(world, registry)),
      cache_(world, registry, cache_bytes) {}

World::Derived World::derived_from(const world::World& world, const models::Registry& registry) {
  const core::RoundToNearest rounding;
  return {world.revision.number, world.block_size_m(), world.terrain.real(models::kTerrainReliefM),
          world::models_reach_m(world, registry), world::drawn_palette(world)};
}

core::Result<core::WorldPosition> World::on_ground(const core::WorldPosition& position) const {
  auto at = checked(position, derived_.block_m);
  if (at && !world_->contains(at->block))
    return core::invalid_argument(
        fmt::format("no ground: block ({}, {}) is outside the world", at->block.x, at->block.z));
  return at;
}

core::Result<Ground> World::ground(const core::WorldPosition& position) {
  const core::RoundToNearest rounding;
  follow_world();
  const auto at = on_ground(position);
  if (!at) return tl::unexpected(at.error());
  const glm::dvec2 local(at->local.x, at->local.z);
  const models::GroundPoint point = cache_.ground(at->block).at(local);
  const world::GroundBlends blends =
      world::ground_blends(derived_.palette, static_cast<float>(point.height_m), point.normal,
                           world::pattern_place(at->block, derived_.block_m, glm::vec2(local)),
                           world::road_at(*world_, at->block, local));
  const world::WaterPoint water = world::water_at(*world_, *at, point.height_m);
  return Ground{.height_m = point.height_m,
                .normal = point.normal,
                .kind = world::main_kind(blends),
                .water_depth_m = water.depth_m,
                .surface_m = std::max(point.height_m, water.surface_m),
                .water = water.body};
}

core::Result<world::WaterPoint> World::water(const core::WorldPosition& position) {
  const core::RoundToNearest rounding;
  follow_world();
  const auto at = on_ground(position);
  if (!at) return tl::unexpected(at.error());
  const glm::dvec2 local(at->local.x, at->local.z);
  return world::water_at(*world_, *at, cache_.ground(at->block).at(local).height_m);
}

// A ray from a normalised origin, with a direction of unit length.
struct World::Course {
  core::WorldPosition origin;
  glm::dvec3 direction{0.0};
  double longest_m = 0;

  PlaneLine plane() const { return {{origin.local.x, origin.local.z}, {direction.x, direction.z}}; }
  double height_at(double t) const { return origin.local.y + t * direction.y; }
  double lowest(double from, double to) const { return std::min(height_at(from), height_at(to)); }
  double highest(double from, double to) const { return std::max(height_at(from), height_at(to)); }
};

// Distance along a ray to the seam of an endless world; infinite: the ray does not cross it.
double World::seam_m(const Course& course) const {
  constexpr double kBeforeM = 1e-4;
  double nearest_m = std::numeric_limits<double>::infinity();
  const auto check = [&](std::int64_t blocks, std::int32_t block, double local, double step) {
    if (blocks != 0 || step == 0) return;
    const auto [first, end] = world::World::ends(blocks);
    const double away_m =
        step > 0 ? static_cast<double>(end - block) * derived_.block_m - local - kBeforeM
                 : static_cast<double>(first - block) * derived_.block_m - local + kBeforeM;
    nearest_m = std::min(nearest_m, std::max(away_m / step, 0.0));
  };
  const auto& [block, local] = course.origin;
  check(world_->blocks_x, block.x, local.x, course.direction.x);
  check(world_->blocks_z, block.z, local.z, course.direction.z);
  return nearest_m;
}

core::Result<Hit> World::cast(const Ray& ray) {
  const core::RoundToNearest rounding;
  follow_world();
  const auto origin = checked(ray.origin, derived_.block_m);
  if (!origin) return tl::unexpected(origin.error());
  const double largest =
      std::max({std::abs(ray.direction.x), std::abs(ray.direction.y), std::abs(ray.direction.z)});
  if (!core::is_finite(ray.direction) || largest == 0)
    return core::invalid_argument(
        fmt::format("the direction ({}, {}, {}) of the ray is zero or not finite", ray.direction.x,
                    ray.direction.y, ray.direction.z));
  if (!(ray.longest_m > 0))
    return core::invalid_argument(
        fmt::format("the length {} m of the ray is not above 0", ray.longest_m));
  const glm::dvec3 scaled = ray.direction / largest;
  Course course{*origin, scaled / std::sqrt(glm::dot(scaled, scaled)),
                std::min(ray.longest_m, kMaxLocalM)};
  course.longest_m = std::min(course.longest_m, seam_m(course));
  Hit hit;
  hit.distance_m = course.longest_m;
  if (ray.ground) cast_ground(course, hit);
  if (ray.models) cast_models(course, hit);
  if (ray.objects) cast_objects(course, hit);
  if (ray.water) cast_water(course, hit);
  hit.position = core::normalised(
      {origin->block, origin->local + hit.distance_m * course.direction}, derived_.block_m);
  return hit;
}

void World::cast_ground(const Course& course, Hit& hit) {
  Side side = Side::kUnknown;
  std::int64_t left = kMaxBlocks;
  const PlaneLine plane = course.plane();
  march(plane, derived_.block_m, 0, course.longest_m,
        [&](std::int64_t x, std::int64_t z, double from, double to) {
          if (left-- == 0) {
            hit.distance_m = from;
            return false;
          }
          const BlockCoord block = moved(course.origin.block, x, z);
          if (!world_->contains(block)) {
            side = Side::kUnknown;
            return true;
          }
          if (course.lowest(from, to) > derived_.relief_m) {
            side = Side::kAbove;
            return course.direction.y < 0;  // else it never descends
          }
          if (course.highest(from, to) < 0) {
            side = Side::kBelow;
            return course.direction.y > 0;
          }
          const glm::dvec2 corner = glm::dvec2(x, z) * derived_.block_m;
          const GroundRay local{
              {plane.from - corner, plane.step}, course.origin.local.y, course.direction.y};
          const auto found = cache_.ground(block).cast(local, from, to, side);
          if (!found) return true;
          hit.kind = HitKind::kGround;
          hit.distance_m = found->t;
          hit.normal = found->normal;
          hit.from_inside = found->from_below;
          hit.block = block;
          hit.model = world_->terrain_model;
          return false;
        });
}

// Finds the nearest hit of a block's models.
void World::cast_block(const Course& course, glm::dvec3 corner_m, BlockCoord block, Hit& hit) {
  const Line line{course.origin.local - corner_m, course.direction};
  const BoxLine at_boxes(line);
  BlockSolids& all = cache_.solids(block);
  if (all.boxes.empty() || !meets(at_boxes, hit.distance_m, all.box)) return;
  const StandingSolid* nearest = nullptr;
  for (std::size_t i = 0; i < all.boxes.size(); ++i) {
    if (!meets(at_boxes, hit.distance_m, all.boxes[i])) continue;
    StandingSolid& s = all.solids[i];
    const auto found = s.solid.cast({line.origin - s.foot, line.direction}, hit.distance_m);
    if (!found || (found->t >= hit.distance_m && hit.kind != HitKind::kNothing)) continue;
    nearest = &s;
    hit.kind = HitKind::kModel;
    hit.distance_m = found->t;
    hit.normal = found->normal;
    hit.from_inside = found->from_inside;
  }
  if (nearest == nullptr) return;
  const world::Placement& placement = cache_.models(block)[nearest->model];
  hit.block = block;
  hit.index = placement.index;
  hit.model = placement.model;
}

// Models extend beyond their block, so each step of the ray visits all blocks within reach.
void World::cast_models(const Course& course, Hit& hit) {
  std::vector<glm::dvec2> seen;
  std::int64_t left = kMaxBlocks;
  const PlaneLine plane = course.plane();
  const double longest_m = hit.distance_m;
  const glm::dvec2 max_m(max_reach_m());
  const double reach_m = max_m.x, top_m = derived_.relief_m + max_m.y;
  march(plane, derived_.block_m, 0, longest_m,
        [&](std::int64_t x, std::int64_t z, double from, double to) {
          if (from > hit.distance_m) return false;
          if (course.lowest(from, to) > top_m) return course.direction.y < 0;
          const glm::dvec2 a = plane.at(from), b = plane.at(to);
          const BlockRange near =
              blocks_around(glm::min(a, b) - reach_m, glm::max(a, b) + reach_m, derived_.block_m);
          const double farthest = 2 * std::ceil(reach_m / derived_.block_m) + 1;
          std::erase_if(seen, [&](const glm::dvec2& s) {
            return std::abs(s.x - static_cast<double>(x)) > farthest ||
                   std::abs(s.y - static_cast<double>(z)) > farthest;
          });
          for (double bz = near.first.y; bz <= near.last.y; ++bz) {
            for (double bx = near.first.x; bx <= near.last.x; ++bx) {
              const BlockCoord block = moved(course.origin.block, static_cast<std::int64_t>(bx),
                                             static_cast<std::int64_t>(bz));
              if (!world_->contains(block) ||
                  std::ranges::find(seen, glm::dvec2(bx, bz)) != seen.end())
                continue;
              if (left-- == 0) {
                if (from < hit.distance_m) {
                  hit = Hit();
                  hit.distance_m = from;
                }
                return false;
              }
              seen.emplace_back(bx, bz);
              cast_block(course, {bx * derived_.block_m, 0, bz * derived_.block_m}, block, hit);
            }
          }
          return true;
        });
}

void World::cast_objects(const Course& course, Hit& hit) const {
  if (objects_ == nullptr) return;
  const auto found = objects_->cast(course.origin, course.direction, hit.distance_m);
  if (!found || (found->hit.t >= hit.distance_m && hit.kind != HitKind::kNothing)) return;
  hit = Hit();
  hit.kind = HitKind::kObject;
  hit.distance_m = found->hit.t;
  hit.normal = found->hit.normal;
  hit.from_inside = found->hit.from_inside;
  hit.object = found->name;
}

std::optional<world::WaterSurface> World::water_under(const Course& course, double t) const {
  return world::water_surface(*world_,
                              {course.origin.block, course.origin.local + t * course.direction});
}

// Ends a ray at a surface of water at a distance, if the ground there is lower.
bool World::meet_water(const Course& course, double t, Hit& hit) {
  const auto at = on_ground({course.origin.block, course.origin.local + t * course.direction});
  const auto water = water_under(course, t);
  if (!at || !water) return false;
  const glm::dvec2 local(at->local.x, at->local.z);
  if (water->depth_over(cache_.ground(at->block).at(local).height_m) <= 0) return false;
  hit = Hit();
  hit.kind = HitKind::kWater;
  hit.distance_m = t;
  hit.normal = water->normal;
  hit.from_inside = glm::dot(glm::dvec3(water->normal), course.direction) > 0;
  hit.block = at->block;
  hit.water = water->body;
  return true;
}

// The sea is a plane. Blocks with rivers and lakes are searched in steps, and the step with the
// surface is halved. A step over the border of the water ends, or begins, at the border.
void World::cast_water(const Course& course, Hit& hit) {
  const double sea_m = world_->water.level_m;
  const double to_sea = (sea_m - course.origin.local.y) / course.direction.y;  // NaN: along it
  if (world_->water.exists() && to_sea >= 0 && to_sea <= hit.distance_m) {
    const auto water = water_under(course, to_sea);
    if (water && water->body == world::kSea) meet_water(course, to_sea, hit);
  }
  const auto& layer = world_->layer();
  if (!layer) return;
  const PlaneLine plane = course.plane();
  const double step_m = world_->cell_m() / 2;
  // A ray that is farther from the water meets none within a step.
  const double near_m = step_m * (kSteepestWater + std::abs(course.direction.y));
  const auto may_meet = [&](const std::optional<double>& height_m) {
    return height_m && std::abs(*height_m) <= near_m;
  };
  std::int64_t left = kMaxBlocks;
  // Metres of the ray above the water that is not the sea.
  const auto above_m = [&](double t) -> std::optional<double> {
    const auto water = water_under(course, t);
    if (!water || water->body == world::kSea) return std::nullopt;
    return course.height_at(t) - water->surface_m;
  };
  march(plane, derived_.block_m, 0, hit.distance_m,
        [&](std::int64_t x, std::int64_t z, double from, double to) {
          if (from >= hit.distance_m) return false;
          if (left-- == 0) {
            hit = Hit();
            hit.distance_m = from;
            return false;
          }
          if (course.lowest(from, to) > derived_.relief_m) return course.direction.y < 0;
          const BlockCoord block = moved(course.origin.block, x, z);
          if (!world_->contains(block) || !layer->ground.may_have_water(block, 0, derived_.block_m))
            return true;
          const double end = std::min(to, hit.distance_m);
          std::optional<double> before = above_m(from);
          for (double t = from; t < end;) {
            const double next = std::min(t + step_m, end);
            const auto after = above_m(next);
            double low = t, high = next;
            auto above_low = before, above_high = after;
            if (!after && may_meet(before)) {
              double dry = next;
              high = t;
              halve_step(high, dry, [&](double at) { return above_m(at).has_value(); });
              above_high = above_m(high);
            } else if (!before && may_meet(after)) {
              double dry = t;
              low = next;
              halve_step(dry, low, [&](double at) { return !above_m(at); });
              above_low = above_m(low);
            }
            if (above_low && above_high && (*above_low < 0) != (*above_high < 0)) {
              const bool begins_below = *above_low < 0;
              halve_step(low, high, [&](double at) {
                const auto there = above_m(at);
                return there && (*there < 0) == begins_below;
              });
              if (meet_water(course, high, hit)) return false;
            }
            before = after;
            t = next;
          }
          return true;
        });
}

core::Result<std::vector<World::BlockAround>> World::blocks_within(const core::WorldPosition& at,
                                                                   double radius_m) const {
  if (!(radius_m >= 0) || !std::isfinite(radius_m))
    return core::invalid_argument(
        fmt::format("the radius must be finite and not negative, not {} m", radius_m));
  const glm::dvec2 centre(at.local.x, at.local.z);
  const BlockRange range = blocks_around(centre - radius_m, centre + radius_m, derived_.block_m);
  if (!(range.count() <= static_cast<double>(kMaxBlocks)))
    return core::fail(ErrorCode::kOverBudget,
                      fmt::format("a radius of {} m covers {:.0f} blocks; at most {} are searched",
                                  radius_m, range.count(), kMaxBlocks));
  std::vector<BlockAround> blocks;
  for (double z = range.first.y; z <= range.last.y; ++z) {
    for (double x = range.first.x; x <= range.last.x; ++x) {
      const BlockCoord block =
          moved(at.block, static_cast<std::int64_t>(x), static_cast<std::int64_t>(z));
      const glm::dvec2 corner = glm::dvec2(x, z) * derived_.block_m;
      const glm::dvec2 gap = centre - glm::clamp(centre, corner, corner + derived_.block_m);
      const double distance_m = std::sqrt(glm::dot(gap, gap));
      if (distance_m <= radius_m && world_->contains(block))
        blocks.push_back({block, {corner.x, 0, corner.y}, distance_m});
    }
  }
  return blocks;
}

template <class Visit>
void World::each_model(const BlockAround& b, const core::WorldPosition& at,
                       std::span<const models::ModelIndex> only, const Visit& visit) {
  for (const world::Placement& p : cache_.models(b.block)) {
    if (!only.empty() && std::ranges::find(only, p.model) == only.end()) continue;
    const glm::dvec3 foot(p.position), away = b.corner_m + foot - at.local;
    visit(NearbyModel{b.block, p.index, p.model, {b.block, foot}, std::sqrt(glm::dot(away, away))});
  }
}

core::Result<void> World::models_within(const core::WorldPosition& position, double radius_m,
                                        std::vector<NearbyModel>& out,
                                        std::span<const models::ModelIndex> only) {
  const core::RoundToNearest rounding;
  out.clear();
  follow_world();
  const auto at = checked(position, derived_.block_m);
  if (!at) return tl::unexpected(at.error());
  const auto blocks = blocks_within(*at, radius_m);
  if (!blocks) return tl::unexpected(blocks.error());
  for (const BlockAround& b : *blocks)
    each_model(b, *at, only, [&](const NearbyModel& found) {
      if (found.distance_m <= radius_m) out.push_back(found);
    });
  std::ranges::sort(out, {}, rank);
  return {};
}

core::Result<std::optional<NearbyModel>> World::nearest(const core::WorldPosition& position,
                                                        double radius_m,
                                                        std::span<const models::ModelIndex> only) {
  const core::RoundToNearest rounding;
  follow_world();
  const auto at = checked(position, derived_.block_m);
  if (!at) return tl::unexpected(at.error());
  auto blocks = blocks_within(*at, radius_m);
  if (!blocks) return tl::unexpected(blocks.error());
  std::ranges::sort(*blocks, {},
                    [](const BlockAround& b) { return std::tuple(b.distance_m, b.block); });
  std::optional<NearbyModel> best;
  for (const BlockAround& b : *blocks) {
    if (best && b.distance_m > best->distance_m) break;
    each_model(b, *at, only, [&](const NearbyModel& found) {
      if (found.distance_m <= radius_m && (!best || rank(found) < rank(*best))) best = found;
    });
  }
  return best;
}

std::optional<world::Placement> World::placement(BlockCoord block, std::uint32_t index) {
  if (!world_->contains(block)) return std::nullopt;
  const auto models = cache_.models(block);
  const auto found = std::ranges::lower_bound(models, index, {}, &world::Placement::index);
  if (found == models.end() || found->index != index) return std::nullopt;
  return *found;
}

}  // namespace psygen::query
