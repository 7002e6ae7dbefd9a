#include "engine/world/shaped_ground.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/cancellation.hpp"
#include "engine/models/edits.hpp"
#include "engine/models/kit/exact_math.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/curve.hpp"
#include "engine/world/river_course.hpp"
#include "engine/world/road_crossings.hpp"
#include "engine/world/road_shapes.hpp"
#include "engine/world/water.hpp"
#include "engine/world/water_shapes.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

using models::GroundChange;
using models::GroundEdit;

tl::unexpected<ShapeError> refused(std::string_view key, core::Error error) {
  return tl::unexpected(ShapeError{{}, key, 0, std::move(error)});
}
tl::unexpected<ShapeError> refused(std::string_view key, std::string sentence) {
  return refused(key, {core::ErrorCode::kInvalidArgument, std::move(sentence)});
}

using Shaped = tl::expected<void, ShapeError>;

// Adds the length of a road or river to that of all. Fails if it is above `max_m`.
Shaped add_length(std::span<const glm::dvec2> points_m, std::string_view shapes, double max_m,
                  double& length_m) {
  length_m += chords_m(points_m);
  if (length_m <= max_m) return {};
  return refused("points_m", {core::ErrorCode::kOverBudget,
                              fmt::format("all {} together are longer than the allowed {:g} m",
                                          shapes, max_m)});
}

// Builds the layer of one world, edit by edit.
class Shaper {
 public:
  explicit Shaper(const World& world)
      : world_(world),
        block_m_(world.block_size_m()),
        relief_m_(world.terrain.real(models::kTerrainReliefM)) {}

  Shaped add(const Stamp& stamp) {
    const bool sets = stamp.mode != "add";
    const double lowest = sets ? 0 : -relief_m_;
    const bool in_metres = stamp.is_in_metres();
    const auto [least, largest] = in_metres ? numbers_of(stamp) : std::pair{0.0F, 0.0F};
    const double high_m = in_metres ? double{largest} : stamp.height_m;
    for (const double height_m : {stamp.base_m + double{least}, stamp.base_m + high_m}) {
      if (height_m >= lowest && height_m <= relief_m_) continue;
      return refused(
          in_metres ? "image" : "height_m",
          fmt::format("the stamp reaches {:g} m, but must stay within {:g} to {:g} m: the "
                      "height range of the terrain (relief_m)",
                      height_m, lowest, relief_m_));
    }
    const auto centre = inside(stamp.centre_m);
    if (!centre) return refused("centre_m", centre.error());
    GroundEdit edit;
    edit.change = sets ? GroundChange::kStampSet : GroundChange::kStampAdd;
    edit.square = true;
    edit.centre = *centre;
    const glm::dvec2 half_m = stamp.size_m / 2.0;
    edit.radius_m = std::max(half_m.x, half_m.y);
    edit.sides = half_m / edit.radius_m;
    edit.falloff = std::min({stamp.border_m, half_m.x, half_m.y}) / edit.radius_m;
    edit.map = map_of(stamp);
    edit.strength = stamp.strength;
    if (stamp.mode == "highest") edit.blend = models::GroundBlend::kHighest;
    if (stamp.mode == "lowest") edit.blend = models::GroundBlend::kLowest;
    edit.mask = mask_of(stamp);
    if (stamp.turn_deg != 0)
      edit.turn = {models::exact_cos_degrees(stamp.turn_deg),
                   models::exact_sin_degrees(stamp.turn_deg)};
    return add(std::move(edit), "centre_m");
  }

  // The network that fits the world: its finest nodes are 16 to 512 cells apart, and its coast lies
  // within the relief.
  Shaped add(models::RiverSettings network) {
    constexpr double kMinCells = 16, kMaxCells = 512, kMinCoast = 0.02, kMaxCoast = 0.9;
    network.seed = world_.seed;
    const auto node_cells = [&] {
      return std::ldexp(network.root_spacing_m, -network.halvings) / world_.cell_m();
    };
    while (network.halvings > 1 && node_cells() < kMinCells)
      --network.halvings;
    while (network.halvings < 8 && node_cells() > kMaxCells)
      ++network.halvings;
    const models::RiverFrame frame{
        .cell_m = world_.cell_m(),
        .cells_per_block = world_.terrain.integer(models::kTerrainSize) - 1,
        .relief_m = relief_m_,
        .sea_level_m =
            std::clamp(world_.water.level_m, kMinCoast * relief_m_, kMaxCoast * relief_m_)};
    auto made =
        models::RiverNetwork::create(network, frame, std::make_shared<models::NetworkStore>());
    if (!made) return refused("root_spacing_m", std::move(made.error()));
    layer_.ground.network = std::move(*made);
    return {};
  }

  void add(const models::Erosion& erosion) {
    layer_.ground.erosion = std::make_shared<const models::Erosion>(erosion);
  }

  Shaped add(const Road& road) {
    for (const glm::dvec2& point : road.points_m) {
      if (const auto at = inside(point); !at) return refused("points_m", at.error());
    }
    if (auto ok = add_length(road.points_m, "roads", kMaxRoadsM, roads_m_); !ok) return ok;
    auto edits = road_edits(world_, layer_, road);
    if (!edits) return refused("points_m", std::move(edits.error()));
    for (GroundEdit& piece : *edits)
      piece.strength = road.strength;
    return add(std::move(*edits));
  }

  // Adds a lake or a river. `make` is lake_edits or river_edits.
  template <class Body, class Make>
  Shaped add(const Body& body, const BodyName& name, const Make& make) {
    auto made = make(world_, layer_, body, name);
    if (!made) return refused(made.error().key, made.error().error);
    if (auto ok = add(std::move(made->edits)); !ok) return ok;
    for (std::string& warning : made->warnings)
      warnings_.push_back(std::move(warning));
    return {};
  }

  void check_roads() {
    for (std::string& warning : road_crossings(world_, layer_))
      warnings_.push_back(std::move(warning));
  }

  models::EditLayer take() {
    // 2,000 blocks; a network's guide lines take some of it.
    constexpr std::size_t kHeightBytes = std::size_t{16} << 20;
    if (layer_.ground.has_fixed_part())
      layer_.ground.heights = std::make_shared<core::ValueCache>(kHeightBytes);
    return std::move(layer_);
  }
  std::vector<std::string> take_warnings() { return std::move(warnings_); }

 private:
  core::Result<core::WorldPosition> inside(glm::dvec2 at_m) const {
    const core::WorldPosition at = world_.position(at_m);
    if (world_.contains(at.block)) return at;
    return core::fail(core::ErrorCode::kInvalidArgument,
                      fmt::format("{:g}, {:g} m is outside the world", at_m.x, at_m.y));
  }

  static std::shared_ptr<const models::Heightmap> map_of(const Stamp& stamp) {
    auto map = std::make_shared<models::Heightmap>();
    map->columns = stamp.picture->width, map->rows = stamp.picture->height;
    map->heights_m.reserve(stamp.picture->pixels());
    const bool in_metres = stamp.is_in_metres();
    for (std::size_t i = 0; i < stamp.picture->pixels(); ++i) {
      const float number = stamp.picture->number(i);
      const bool is_height = stamp.is_height(number);
      const double above_m =
          in_metres ? double{number} : stamp.height_m * (double{number} / stamp.picture->white);
      map->has_holes = map->has_holes || !is_height;
      map->heights_m.push_back(is_height ? static_cast<float>(stamp.base_m + above_m)
                                         : std::numeric_limits<float>::quiet_NaN());
    }
    return map;
  }

  // Null: it acts everywhere.
  std::shared_ptr<const models::GroundMask> mask_of(const Stamp& stamp) const {
    const auto rise = [](double degrees) {
      constexpr double kSteepest = 89;
      const double angle = std::clamp(degrees, 0.0, kSteepest);
      return models::exact_sin_degrees(angle) / models::exact_cos_degrees(angle);
    };
    auto mask = std::make_shared<models::GroundMask>();
    mask->picture = stamp.mask.picture;
    mask->area_m = stamp.mask.area_m;
    mask->noise_m = stamp.mask.noise_m;
    mask->share = stamp.mask.share;
    mask->patches = patch_seed(stamp.mask, world_.seed);
    mask->height_m = {stamp.min_height_m, stamp.height_fade_m, stamp.max_height_m,
                      stamp.height_fade_m};
    const double low = stamp.min_slope_deg, high = stamp.max_slope_deg, fade = stamp.slope_fade_deg;
    if (low > 0) mask->slope.min = rise(low), mask->slope.min_fade = rise(low + fade) - rise(low);
    if (high < 90)
      mask->slope.max = rise(high), mask->slope.max_fade = rise(high) - rise(high - fade);
    return stamp.mask.thins() || mask->reads_guide() ? std::move(mask) : nullptr;
  }

  // Adds the pieces of a road, a lake or a river.
  Shaped add(std::vector<GroundEdit> pieces) {
    for (GroundEdit& piece : pieces) {
      if (auto ok = add(std::move(piece), "points_m"); !ok) return ok;
    }
    return {};
  }
  Shaped add(GroundEdit edit, std::string_view key) {
    if (auto ok = core::check_cancelled(); !ok) return refused(key, ok.error());
    edit.id = layer_.next_id++;
    seal(edit);
    if (layer_.ground.shapes.add(std::make_shared<const GroundEdit>(std::move(edit)), block_m_))
      return {};
    return refused(key,
                   {core::ErrorCode::kOverBudget,
                    fmt::format("more than {} stamps and pieces of roads or water overlap there",
                                models::GroundEdits::kMaxTogether)});
  }

  const World& world_;
  double block_m_, relief_m_;
  double roads_m_ = 0;  // total length of all roads so far
  std::vector<std::string> warnings_;
  models::EditLayer layer_;
};

// Adds the place to the error of a shape.
Shaped wrong_at(std::string_view place, std::size_t number, Shaped failed) {
  failed.error().place = place, failed.error().number = number;
  return failed;
}

// Adds all shapes of one type that act.
template <class Shapes>
Shaped add_all(const Shapes& shapes, std::string_view place, Shaper& shaper) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (!acts(shapes[i])) continue;
    if (auto ok = shaper.add(shapes[i]); !ok) return wrong_at(place, i, std::move(ok));
  }
  return {};
}

// Adds lakes, then rivers, each after those in which it begins or ends.
Shaped add_water(const World& world, Shaper& shaper) {
  const ShapedGround& shaped = world.shaped;
  WaterBody body = kSea + 1;
  for (std::size_t i = 0; i < shaped.lakes.size(); ++i, ++body) {
    if (!acts(shaped.lakes[i])) continue;
    const BodyName name{body, fmt::format("lake {}", i + 1), false};
    if (auto ok = shaper.add(shaped.lakes[i], name, lake_edits); !ok)
      return wrong_at("lake", i, std::move(ok));
  }
  double length_m = 0;
  for (std::size_t i = 0; i < shaped.rivers.size(); ++i) {
    if (!acts(shaped.rivers[i])) continue;
    if (auto ok = add_length(shaped.rivers[i].points_m, "rivers", kMaxRiversM, length_m); !ok)
      return wrong_at("river", i, std::move(ok));
  }
  const RiverOrder rivers = river_order(world, shaped.rivers);
  if (rivers.order.size() < shaped.rivers.size())
    return wrong_at("river", 0, refused("points_m", "rivers end in each other in a circle"));
  for (const std::size_t i : rivers.order) {
    if (!acts(shaped.rivers[i])) continue;
    const BodyName name{body + static_cast<WaterBody>(i), fmt::format("river {}", i + 1),
                        rivers.flows_on[i]};
    if (auto ok = shaper.add(shaped.rivers[i], name, river_edits); !ok)
      return wrong_at("river", i, std::move(ok));
  }
  return {};
}

}  // namespace

bool operator==(const Stamp& a, const Stamp& b) {
  const auto content = [](const Stamp& s) { return s.picture ? s.picture->hash : 0; };
  return a.image == b.image && content(a) == content(b) && a.centre_m == b.centre_m &&
         a.size_m == b.size_m && a.turn_deg == b.turn_deg && a.base_m == b.base_m &&
         a.height_m == b.height_m && a.border_m == b.border_m && a.no_data == b.no_data &&
         a.mode == b.mode && a.unit == b.unit && a.strength == b.strength &&
         a.enabled == b.enabled && a.mask == b.mask && a.min_height_m == b.min_height_m &&
         a.max_height_m == b.max_height_m && a.height_fade_m == b.height_fade_m &&
         a.min_slope_deg == b.min_slope_deg && a.max_slope_deg == b.max_slope_deg &&
         a.slope_fade_deg == b.slope_fade_deg;
}

std::pair<float, float> numbers_of(const Stamp& stamp) {
  constexpr float kEnd = std::numeric_limits<float>::infinity();
  std::pair range{kEnd, -kEnd};
  for (std::size_t i = 0; i < stamp.picture->pixels(); ++i) {
    const float number = stamp.picture->number(i);
    if (!stamp.is_height(number)) continue;
    range = {std::min(range.first, number), std::max(range.second, number)};
  }
  return range;
}

tl::expected<void, ShapeError> shape_ground(World& world) {
  world.shaped.layer = nullptr;
  set_edits(world, nullptr);
  world.shaped.warnings.clear();
  const models::Erosion& erosion = world.shaped.erosion;
  const bool erodes = erosion.strength > 0;
  if (!erodes && !world.shaped.network && world.shaped.empty()) return {};
  Shaper shaper(world);
  if (world.shaped.network) {
    if (auto ok = shaper.add(*world.shaped.network); !ok)
      return wrong_at("rivers", 0, std::move(ok));
  }
  if (erodes) shaper.add(erosion);
  if (auto ok = add_all(world.shaped.stamps, "stamp", shaper); !ok) return ok;
  if (auto ok = add_all(world.shaped.roads, "road", shaper); !ok) return ok;
  if (auto ok = add_water(world, shaper); !ok) return ok;
  if (world.shaped.has_water() || world.water.exists()) shaper.check_roads();
  world.shaped.warnings = shaper.take_warnings();
  world.shaped.layer = std::make_shared<const models::EditLayer>(shaper.take());
  set_edits(world, nullptr);
  return {};
}

std::uint64_t shape_hash(const World& world) {
  if (!world.shaped.layer) return 0;
  return world.shaped.layer->ground.hash_of({models::QuadCoord::kMaxLevel, 0, 0}, 0,
                                            world.block_size_m());
}

}  // namespace psygen::world
