#include "engine/world/ground_below.hpp"

#include <algorithm>
#include <cmath>

#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

// Maximum numbers of vertices that are looked at.
constexpr double kMaxOfRoad = 40'000, kMaxOfWater = 5000;

// `ground_m` returns the height of the ground at `place_m`, a place in metres from the origin of
// the piece. Roads need it only on their strip.
template <class Ground>
double moved_m(const models::GroundEdit& edit, glm::dvec2 place_m, const Ground& ground_m) {
  if (edit.road) {
    const models::RoadEffect road = effect_of(*edit.road, place_m);
    return road.weight > 0 ? std::abs(road.height_m - ground_m()) : 0;
  }
  const double before_m = ground_m();
  const double after_m = edit.river ? shaped_by(*edit.river, before_m, place_m)
                                    : shaped_by(*edit.lake, before_m, place_m);
  return std::abs(after_m - before_m);
}

}  // namespace

GroundBelow::GroundBelow(const World& world, const models::EditLayer& layer)
    : world_(world), layer_(layer), terrain_(world.terrain) {
  terrain_.set_edits(&layer_, 0);
}

double GroundBelow::ground_m(glm::dvec2 at_m) const {
  const core::WorldPosition at = world_.position(at_m);
  return models::ground_height_m(terrain_, at.block, at.local.x, at.local.z);
}

std::optional<models::BodySurface> GroundBelow::water_over(glm::dvec2 at_m) const {
  const core::WorldPosition at = world_.position(at_m);
  const auto water =
      layer_.ground.water_over(at.block, {at.local.x, at.local.z}, world_.block_size_m());
  return water && water->widths <= 0.5 ? water : std::nullopt;
}

models::GroundEdit GroundBelow::square_around(const FlatBox& box, const core::WorldPosition& origin,
                                              double reach_m) const {
  models::GroundEdit edit;
  edit.square = true;
  core::WorldPosition centre = origin;
  centre.local += glm::dvec3(box.centre().x, 0, box.centre().y);
  edit.centre = core::normalised(centre, world_.block_size_m());
  edit.radius_m = std::max(box.size().x, box.size().y) / 2 + reach_m;
  return edit;
}

double GroundBelow::max_moved_m(const models::GroundEdit& edit) const {
  const double cell_m = world_.cell_m(), block_m = world_.block_size_m();
  const double relief_m = world_.terrain.real(models::kTerrainReliefM);
  const double radius_m = edit.radius_m + cell_m;
  const double vertices = 4 * radius_m * radius_m / (cell_m * cell_m);
  if (edit.road && vertices > kMaxOfRoad) return relief_m;
  const auto step = edit.road
                        ? std::int64_t{1}
                        : static_cast<std::int64_t>(std::ceil(std::sqrt(vertices / kMaxOfWater)));
  const auto last = world_.terrain.integer(models::kTerrainSize) - 1;
  const auto block_at = [&](double local_m) {
    return static_cast<std::int64_t>(std::floor(local_m / block_m));
  };
  // Vertices in the square of the edit, along one axis of a block `away_m` from its centre.
  const auto first_of = [&](double away_m) {
    return std::clamp<std::int64_t>(
        static_cast<std::int64_t>(std::floor((-away_m - edit.radius_m) / cell_m)), 0, last);
  };
  const auto last_of = [&](double away_m) {
    return std::clamp<std::int64_t>(
        static_cast<std::int64_t>(std::ceil((-away_m + edit.radius_m) / cell_m)), 0, last);
  };
  const core::WorldPosition& centre = edit.centre;
  double most = 0;
  for (std::int64_t z = block_at(centre.local.z - radius_m);
       z <= block_at(centre.local.z + radius_m); ++z) {
    for (std::int64_t x = block_at(centre.local.x - radius_m);
         x <= block_at(centre.local.x + radius_m); ++x) {
      const core::BlockCoord block = core::moved(centre.block, x, z);
      const glm::dvec3 away = core::offset_m(block, centre, block_m);
      const std::int64_t x0 = first_of(away.x), x1 = last_of(away.x);
      const std::int64_t z0 = first_of(away.z), z1 = last_of(away.z);
      const auto questions = ((x1 - x0) / step + 1) * ((z1 - z0) / step + 1);
      const models::BlockGround ground(terrain_, block, static_cast<std::size_t>(questions));
      for (std::int64_t k = z0; k <= z1; k += step) {
        for (std::int64_t i = x0; i <= x1; i += step) {
          const glm::dvec2 local_m =
              glm::dvec2(static_cast<double>(i), static_cast<double>(k)) * cell_m;
          const glm::dvec2 place_m = models::from_origin_m(edit.origin(), block, local_m, block_m);
          most =
              std::max(most, moved_m(edit, place_m, [&] { return ground.at(local_m).height_m; }));
        }
      }
    }
  }
  return step > 1 ? std::min(1.1 * most + 0.5, relief_m) : most;
}

}  // namespace psygen::world
