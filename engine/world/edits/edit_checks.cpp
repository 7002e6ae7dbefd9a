#include "engine/world/edits/edit_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/models/terrain/terrain.hpp"
#include "engine/world/edits/edits.hpp"
#include "engine/world/placement.hpp"

namespace psygen::world {
namespace {

using core::ErrorCode;
using models::BlockEdits;
using models::GroundEdit;

core::Result<void> check_heightmap(const models::Heightmap* map, double relief_m, bool adds) {
  if (map == nullptr) return core::invalid_argument("the stamp has no heightmap");
  const auto side = [](std::uint32_t n) { return n >= 2 && n <= kMaxHeightmapSide; };
  if (!side(map->columns) || !side(map->rows)) {
    return core::invalid_argument(
        fmt::format("a heightmap of {} × {} points is not allowed: each side has 2 to {}",
                    map->columns, map->rows, kMaxHeightmapSide));
  }
  const std::size_t points = std::size_t{map->columns} * map->rows;
  if (map->heights_m.size() != points) {
    return core::invalid_argument(fmt::format("the heightmap has {} heights, not {} × {}",
                                              map->heights_m.size(), map->columns, map->rows));
  }
  const double lowest = adds ? -relief_m : 0;
  for (const float h : map->heights_m) {
    if (static_cast<double>(h) >= lowest && static_cast<double>(h) <= relief_m) continue;
    return core::invalid_argument(
        fmt::format("a height of {:g} m in the heightmap is not allowed: it must be {:g} to {:g} m",
                    h, lowest, relief_m));
  }
  return {};
}

// Metres from the origin of a body of water that a piece may have.
constexpr double kFarM = 1e6;
bool is_near(glm::dvec2 at_m) {
  return std::abs(at_m.x) <= kFarM && std::abs(at_m.y) <= kFarM;  // false for NaN
}
bool is_in(double value, double lowest, double highest) {
  return value >= lowest && value <= highest;
}

bool is_sound(const models::RiverPiece& river, double relief_m) {
  bool sound = river.body >= kFirstAdded && river.points.size() >= 2 && is_in(river.edge_m, 0, 1e4);
  for (const models::RiverPoint& p : river.points) {
    const double length2 = p.direction.x * p.direction.x + p.direction.y * p.direction.y;
    sound = sound && is_near(p.at_m) && is_in(length2, 0.99, 1.01) &&
            is_in(p.half_width_m, 1e-3, kMaxRiverWidthM) && is_in(p.surface_m, 0, relief_m) &&
            is_in(p.bed_m, 0, p.surface_m) && is_in(p.bank_m, 1e-3, kMaxRiverBankM) &&
            is_in(p.speed_m_s, 0, 100) && is_in(p.discharge_m3_s, 0, kMaxDischarge) &&
            is_in(p.fall, 0, 1e6) && is_in(p.foam, 0, 1);
  }
  for (const models::RiverNeighbour& n : river.near)
    sound = sound && is_near(n.from_m) && is_near(n.to_m);
  return sound;
}

bool is_sound(const models::LakePiece& lake, double relief_m) {
  bool sound = lake.body >= kFirstAdded && is_in(lake.level_m, 0, relief_m) &&
               is_in(lake.depth_m, kMinDepthM, kMaxLakeDepthM) &&
               is_in(lake.shore_m, kMinDepthM, kMaxShoreM) && is_in(lake.edge_m, 0, 1e4) &&
               is_near(lake.low_m) && is_near(lake.high_m);
  for (const models::LakeSegment& s : lake.segments)
    sound = sound && is_near(s.from_m) && is_near(s.to_m) && is_near(s.from_normal) &&
            is_near(s.to_normal);
  return sound;
}

}  // namespace

std::string text_of(core::BlockCoord block) {
  return fmt::format("block ({}, {})", block.x, block.z);
}

core::Result<void> check_block(const World& world, core::BlockCoord block) {
  if (world.contains(block)) return {};
  return core::invalid_argument(fmt::format("{} is outside the world", text_of(block)));
}

core::Result<void> check_heights(const BlockEdits& edits, core::BlockCoord block) {
  std::size_t count = 0;
  for (const auto& edit : edits.ground)
    count += edit->map ? edit->map->heights_m.size() : 0;
  if (count <= kMaxHeightsPerBlock) return {};
  return core::fail(ErrorCode::kOverBudget,
                    fmt::format("the heightmaps of {} have {} heights (limit: {})", text_of(block),
                                count, kMaxHeightsPerBlock));
}

core::Result<void> check_room(const BlockEdits& edits, core::BlockCoord block) {
  const std::size_t count = edits.removed.size() + edits.placed.size() + edits.ground.size();
  if (count < kMaxEditsPerBlock) return {};
  return core::fail(ErrorCode::kOverBudget, fmt::format("{} already has the maximum of {} edits",
                                                        text_of(block), kMaxEditsPerBlock));
}

core::Result<void> check_removed(const World& world, core::BlockCoord block, std::uint32_t index) {
  if (auto ok = check_block(world, block); !ok) return ok;
  const std::size_t count = models_per_block(world);
  if (index < count) return {};
  return core::invalid_argument(
      fmt::format("{} has no model {}: a block has {}", text_of(block), index, count));
}

core::Result<core::WorldPosition> check_place(const World& world, const core::WorldPosition& at) {
  constexpr double kFarthest = 1e9;
  const auto usable = [](double v) { return std::abs(v) <= kFarthest; };  // false for NaN
  if (!usable(at.local.x) || !usable(at.local.z)) {
    return core::invalid_argument(fmt::format("the position {:g}, {:g} m from {} is out of range",
                                              at.local.x, at.local.z, text_of(at.block)));
  }
  const double size = world.block_size_m();
  const auto index = [size](std::int32_t block, double local) {
    return static_cast<double>(block) + std::floor(local / size);
  };
  const auto fits = [](double i) { return i >= INT32_MIN && i <= INT32_MAX; };
  core::WorldPosition place = core::normalised(at, size);
  const bool inside = fits(index(at.block.x, at.local.x)) && fits(index(at.block.z, at.local.z));
  if (!inside || !world.contains(place.block)) {
    return core::invalid_argument(
        fmt::format("the position {:g}, {:g} m from {} is outside the world", at.local.x,
                    at.local.z, text_of(at.block)));
  }
  place.local.y = 0;
  return place;
}

core::Result<void> check_ground(const World& world, const GroundEdit& edit) {
  const double relief_m = world.terrain.real(models::kTerrainReliefM);
  if (!(edit.radius_m >= kMinEditRadiusM && edit.radius_m <= kMaxEditRadiusM)) {
    return core::invalid_argument(
        fmt::format("a radius of {:g} m is not allowed: it must be {:g} to {:g} m", edit.radius_m,
                    kMinEditRadiusM, kMaxEditRadiusM));
  }
  if (!(edit.falloff >= 0 && edit.falloff <= 1))
    return core::invalid_argument(
        fmt::format("a falloff of {:g} is not allowed: it must be 0 to 1", edit.falloff));
  if (!(edit.strength >= 0 && edit.strength <= 1))
    return core::invalid_argument(
        fmt::format("a strength of {:g} is not allowed: it must be 0 to 1", edit.strength));
  if (edit.blend > models::GroundBlend::kLowest)
    return core::invalid_argument("this type of blend does not exist");
  if (edit.mask) return core::invalid_argument("masks can be in world files only");
  switch (edit.change) {
    case models::GroundChange::kRaise:
      if (std::abs(edit.height_m) <= relief_m) return {};
      return core::invalid_argument(
          fmt::format("raising ground by {:g} m is not allowed: at most {:g} m, up or down",
                      edit.height_m, relief_m));
    case models::GroundChange::kFlatten:
      if (edit.height_m >= 0 && edit.height_m <= relief_m) return {};
      return core::invalid_argument(
          fmt::format("ground at {:g} m is not allowed: it must be 0 to {:g} m, the height range "
                      "of the terrain",
                      edit.height_m, relief_m));
    case models::GroundChange::kStampAdd:
      return check_heightmap(edit.map.get(), relief_m, true);
    case models::GroundChange::kStampSet:
      return check_heightmap(edit.map.get(), relief_m, false);
    case models::GroundChange::kRoad:
      return core::invalid_argument("roads can be in world files only");
    case models::GroundChange::kRiver:
    case models::GroundChange::kLake:
      if (edit.is_whole() && edit.square && edit.height_m >= 0 && edit.height_m <= 2 * relief_m &&
          (edit.river ? is_sound(*edit.river, relief_m)
                      : edit.lake && is_sound(*edit.lake, relief_m)))
        return {};
      return core::invalid_argument("a piece of water has numbers out of range");
  }
  return core::invalid_argument("this type of ground edit does not exist");
}

core::Result<void> check_above(double above_m) {
  constexpr double kHighest = 1000;
  if (std::abs(above_m) <= kHighest) return {};
  return core::invalid_argument(
      fmt::format("{:g} m above the ground is not allowed: it must be {:g} to {:g} m", above_m,
                  -kHighest, kHighest));
}

core::Result<void> check_model(const models::Registry& registry, models::ModelIndex model,
                               const models::Parameters& parameters, double above_m) {
  if (model >= registry.size())
    return core::invalid_argument(
        fmt::format("there is no model type {}: there are {}", model, registry.size()));
  if (auto ok = check_above(above_m); !ok) return ok;
  const models::ModelType& type = registry[model];
  if (auto ok = models::validate(type, parameters); !ok) return ok;
  if (type.mesh_size(parameters, 0).layout != core::VertexLayout::kModel)
    return core::invalid_argument(fmt::format("models of type {} cannot be placed", type.name()));
  return {};
}

}  // namespace psygen::world
