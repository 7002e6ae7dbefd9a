#include "engine/models/network/network.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace psygen::models {
namespace {

using network::floor_div;
using network::kUnitsPerCell;

// Samples are served by a patch within this many spacings beyond its tile, so that the vertices
// around a node need no second patch.
constexpr std::int64_t kBeyond = 2;
// A patch begins with the nodes of the tile this many levels coarser around it.
constexpr int kSharedLevels = 2;

bool is_fine(GroundDetail detail) {
  return detail.level <= 1;
}

}  // namespace

core::Result<std::shared_ptr<const RiverNetwork>> RiverNetwork::create(
    const RiverSettings& settings, const RiverFrame& frame, std::shared_ptr<NetworkStore> store) {
  if (auto valid = check(settings, frame); !valid) return tl::unexpected(valid.error());
  return std::shared_ptr<const RiverNetwork>(new RiverNetwork(settings, frame, std::move(store)));
}

RiverNetwork::RiverNetwork(const RiverSettings& settings, const RiverFrame& frame,
                           std::shared_ptr<NetworkStore> store)
    : scale_(settings, frame),
      identity_(models::identity(settings, frame)),
      store_(std::move(store)) {
  // Tiles are 2^n blocks wide, so nodes of the quadtree lie in one tile each.
  const std::int64_t block = frame.cells_per_block * kUnitsPerCell;
  for (int k = 0; k <= settings.halvings; ++k) {
    std::int64_t side = block;
    while (2 * side <= 45 * scale_.spacing(k))
      side *= 2;
    tile_units_[static_cast<std::size_t>(k)] = side;
  }
}

int RiverNetwork::level_of(GroundDetail detail) const {
  int level = scale_.halvings();
  if (is_fine(detail)) return level;
  double spacing = static_cast<double>(scale_.spacing(level)) / static_cast<double>(kUnitsPerCell);
  while (level > 0 && 2 * spacing <= detail.spacing_cells()) {
    spacing *= 2;
    --level;
  }
  return level;
}

network::TileKey RiverNetwork::tile_of(std::int64_t x_cells, std::int64_t z_cells,
                                       GroundDetail detail) const {
  const int level = level_of(detail);
  return {level, floor_div(x_cells * kUnitsPerCell, tile_units(level)),
          floor_div(z_cells * kUnitsPerCell, tile_units(level))};
}

void RiverNetwork::each_tile(CellRange x, CellRange z, GroundDetail detail,
                             const std::function<void(const network::TileKey&)>& visit) const {
  const network::TileKey first = tile_of(x.first, z.first, detail);
  const network::TileKey last = tile_of(x.last, z.last, detail);
  for (std::int64_t j = first.j; j <= last.j; ++j) {
    for (std::int64_t i = first.i; i <= last.i; ++i)
      visit({first.level, i, j});
  }
}

std::shared_ptr<const network::RootTile> RiverNetwork::root_tile(
    const network::TileKey& key) const {
  const auto make = [&] { return network::make_root_tile(scale_, key); };
  if (store_ == nullptr) return std::make_shared<const network::RootTile>(make());
  return store_->get<network::RootTile>({identity_, {-1, key.i, key.j}}, make);
}

network::RootNodes RiverNetwork::root() const {
  return {scale_, [this](const network::TileKey& key) { return root_tile(key); }};
}

bool RiverNetwork::ready(const network::TileKey& tile) const {
  return store_ != nullptr && store_->has({identity_, tile});
}

network::Square RiverNetwork::square_of(const network::TileKey& tile) const {
  const std::int64_t side = tile_units(tile.level), beyond = kBeyond * scale_.spacing(tile.level);
  return {tile.i * side - beyond, tile.j * side - beyond, side + 2 * beyond};
}

// The nodes of a tile and those around it. Tiles share the nodes that the store keeps of the wide
// tile around them.
network::NodePatch RiverNetwork::nodes_of(const network::TileKey& tile) const {
  network::RootNodes from = root();
  const auto around = [this](const network::TileKey& of) {
    return network::surroundings_of(scale_, of.level, square_of(of));
  };
  const int shared = tile.level - kSharedLevels;
  if (store_ == nullptr || shared < 1)
    return network::nodes_around(scale_, from, tile.level, around(tile), tile.level);
  const std::int64_t ratio = tile_units(shared) / tile_units(tile.level);
  const network::TileKey wide{shared, floor_div(tile.i, ratio), floor_div(tile.j, ratio)};
  const auto nodes = store_->get<network::NodePatch>(
      {identity_, {-2 - shared, wide.i, wide.j}},
      [&] { return network::nodes_around(scale_, from, shared, around(wide), tile.level); });
  return network::nodes_from(scale_, from, *nodes, tile.level, around(tile), tile.level);
}

std::shared_ptr<const network::Patch> RiverNetwork::patch(const network::TileKey& tile) const {
  const auto make = [&] {
    const network::Square square = square_of(tile);
    return network::make_patch(scale_, nodes_of(tile), square);
  };
  if (store_ == nullptr) return std::make_shared<const network::Patch>(make());
  return store_->get<network::Patch>({identity_, tile}, make);
}

network::NodePatch RiverNetwork::nodes(int level, std::int64_t x_cells, std::int64_t z_cells,
                                       std::int64_t side_cells) const {
  network::RootNodes from = root();
  const network::Square square{x_cells * kUnitsPerCell, z_cells * kUnitsPerCell,
                               side_cells * kUnitsPerCell};
  return network::nodes_around(scale_, from, level, {square, scale_.spacing(level)}, level);
}

std::optional<std::int64_t> RiverNetwork::serving_tile(int level, std::int64_t first,
                                                       std::int64_t last) const {
  const std::int64_t side = tile_units(level), beyond = kBeyond * scale_.spacing(level);
  const std::int64_t tile = floor_div((first + last) / 2, side);
  if (first < tile * side - beyond || last > (tile + 1) * side + beyond) return std::nullopt;
  return tile;
}

RiverNetwork::Cells RiverNetwork::square_of(core::BlockCoord corner, int level) const {
  const std::int64_t cells = scale_.frame.cells_per_block;
  return {corner.x * cells, corner.z * cells, cells << level};
}

std::vector<RiverNetwork::Span> RiverNetwork::spans_of(int level, std::int64_t first_cell,
                                                       std::int64_t cells) const {
  const std::int64_t first = first_cell * kUnitsPerCell, end = first + cells * kUnitsPerCell;
  if (const auto tile = serving_tile(level, first, end)) return {{*tile, first, end}};
  std::vector<Span> spans;
  const std::int64_t side = tile_units(level), beyond = kBeyond * scale_.spacing(level);
  for (std::int64_t at = first; at < end; at = spans.back().end) {
    const std::int64_t tile = floor_div(at, side);
    spans.push_back({tile, at, std::min((tile + 1) * side + beyond, end)});
  }
  return spans;
}

RiverNetwork::Part RiverNetwork::part_of(int level, const Span& x, const Span& z) const {
  Part part{patch({level, x.tile, z.tile}), {}};
  const network::Patch& of = *part.patch;
  const auto unit = [](std::int64_t at, std::int64_t origin) {
    return static_cast<std::int32_t>(at - origin);
  };
  part.box = {unit(x.first, of.x), unit(z.first, of.z), unit(x.end, of.x) - 1,
              unit(z.end, of.z) - 1};
  return part;
}

std::vector<RiverNetwork::Part> RiverNetwork::parts_of(const Cells& cells,
                                                       GroundDetail detail) const {
  const int level = level_of(detail);
  const std::vector<Span> columns = spans_of(level, cells.x, cells.side);
  std::vector<Part> parts;
  for (const Span& z : spans_of(level, cells.z, cells.side)) {
    for (const Span& x : columns)
      parts.push_back(part_of(level, x, z));
  }
  return parts;
}

bool RiverNetwork::may_have_water(const Cells& cells) const {
  constexpr std::size_t kMaxPatches = 4;
  const int level = scale_.halvings();
  const std::vector<Span> columns = spans_of(level, cells.x, cells.side);
  const std::vector<Span> rows = spans_of(level, cells.z, cells.side);
  if (columns.size() * rows.size() > kMaxPatches) return true;
  return std::ranges::any_of(rows, [&](const Span& z) {
    return std::ranges::any_of(columns, [&](const Span& x) {
      const Part part = part_of(level, x, z);
      return part.patch->may_have_water(part.box.grown(1));
    });
  });
}

template <class Visit>
void RiverNetwork::each_part(const Lattice& at, GroundDetail detail, const Visit& visit) const {
  if (at.x.empty() || at.z.empty()) return;
  const int level = level_of(detail);
  const std::int64_t side = tile_units(level);
  const bool guided = is_fine(detail);
  const auto one_tile = [&](std::span<const std::int64_t> axis) {
    return serving_tile(level, axis.front() * kUnitsPerCell, axis.back() * kUnitsPerCell);
  };
  const auto one_x = one_tile(at.x), one_z = one_tile(at.z);
  // The samples from `first` on that one call takes, and their tile.
  const auto end_of = [&](std::span<const std::int64_t> axis, std::size_t first,
                          std::optional<std::int64_t> one, std::int64_t& tile) {
    tile = one ? *one : floor_div(axis[first] * kUnitsPerCell, side);
    std::size_t end = first;
    while (end < axis.size() && end - first < network::kMaxSamples &&
           (!guided || (axis[end] - axis[first]) * kUnitsPerCell <= network::kMaxGuidedUnits) &&
           (one || axis[end] * kUnitsPerCell < (tile + 1) * side))
      ++end;
    return end;
  };
  std::array<std::vector<std::int32_t>, 2> units;
  const auto relative = [&](std::span<const std::int64_t> axis, std::size_t first, std::size_t end,
                            std::int64_t origin, std::vector<std::int32_t>& out) {
    out.clear();
    for (std::size_t k = first; k < end; ++k)
      out.push_back(static_cast<std::int32_t>(axis[k] * kUnitsPerCell - origin));
  };
  network::TileKey key{level, 0, 0};
  std::optional<network::TileKey> last;
  std::shared_ptr<const network::Patch> patch;
  for (std::size_t row = 0, row_end = 0; row < at.z.size(); row = row_end) {
    row_end = end_of(at.z, row, one_z, key.j);
    for (std::size_t column = 0, column_end = 0; column < at.x.size(); column = column_end) {
      column_end = end_of(at.x, column, one_x, key.i);
      if (key != last) {
        patch = this->patch(key);
        last = key;
      }
      relative(at.x, column, column_end, patch->x, units[0]);
      relative(at.z, row, row_end, patch->z, units[1]);
      visit(*patch, network::Samples{units[0], units[1], guided}, column, row);
    }
  }
}

namespace {

template <class T>
T* offset(T* rows, std::size_t by) {
  return rows == nullptr ? nullptr : rows + by;
}
// Everything but the base.
network::CarvedRows shifted(const network::CarvedRows& rows, std::size_t by) {
  network::CarvedRows result = rows;
  result.height_m = offset(rows.height_m, by);
  result.water_m = offset(rows.water_m, by);
  result.flow_x = offset(rows.flow_x, by);
  result.flow_z = offset(rows.flow_z, by);
  result.body = offset(rows.body, by);
  return result;
}

}  // namespace

void RiverNetwork::base(const Lattice& at, GroundDetail detail, const BaseRows& rows) const {
  each_part(at, detail,
            [&](const network::Patch& patch, const network::Samples& samples, std::size_t column,
                std::size_t row) {
              const std::size_t by = row * rows.stride + column;
              network::base_rows(patch, samples,
                                 {.height_m = offset(rows.height_m, by),
                                  .slope_x = offset(rows.slope_x, by),
                                  .slope_z = offset(rows.slope_z, by),
                                  .clear = offset(rows.clear, by),
                                  .stride = rows.stride});
            });
}

void RiverNetwork::carve(const Lattice& at, GroundDetail detail, const CarvedRows& rows) const {
  each_part(at, detail,
            [&](const network::Patch& patch, const network::Samples& samples, std::size_t column,
                std::size_t row) {
              const std::size_t by = row * rows.stride + column;
              network::CarvedRows part = shifted(rows, by);
              part.base_m = rows.base_m + row * rows.base_stride + column;
              network::carve_rows(patch, samples, part);
            });
}

void RiverNetwork::evaluate(const Lattice& at, GroundDetail detail, CarvedRows rows) const {
  each_part(at, detail,
            [&](const network::Patch& patch, const network::Samples& samples, std::size_t column,
                std::size_t row) {
              network::ground_rows(patch, samples, shifted(rows, row * rows.stride + column));
            });
}

RiverNetwork::PatchPlace RiverNetwork::in_patch(const core::WorldPosition& place) const {
  const double units_per_m = 1 / scale_.unit_m;
  const auto units = [&](std::int32_t block, double local_m) {
    return static_cast<std::int64_t>(block) * scale_.frame.cells_per_block * kUnitsPerCell +
           static_cast<std::int64_t>(std::floor(local_m * units_per_m + 0.5));
  };
  const std::int64_t x = units(place.block.x, place.local.x);
  const std::int64_t z = units(place.block.z, place.local.z);
  const int level = scale_.halvings();
  auto found = patch({level, floor_div(x, tile_units(level)), floor_div(z, tile_units(level))});
  const auto px = static_cast<std::int32_t>(x - found->x);
  const auto pz = static_cast<std::int32_t>(z - found->z);
  return {std::move(found), px, pz};
}

NetworkWater RiverNetwork::water_at(const PatchPlace& place) {
  const network::Samples at{{&place.x, 1}, {&place.z, 1}, true};
  float ground = 0, water = 0;
  NetworkWater result;
  network::ground_rows(*place.patch, at,
                       {.height_m = &ground,
                        .water_m = &water,
                        .flow_x = &result.flow_m_s.x,
                        .flow_z = &result.flow_m_s.y,
                        .body = &result.body,
                        .stride = 1});
  if (water <= ground) return {};
  result.surface_m = water;
  result.depth_m = water - ground;
  return result;
}

NetworkWater RiverNetwork::water_at(const core::WorldPosition& place) const {
  return water_at(in_patch(place));
}

std::optional<InlandWater> RiverNetwork::inland_water_at(const core::WorldPosition& place) const {
  const PatchPlace at = in_patch(place);
  if (!at.patch->may_have_water({at.x, at.z, at.x, at.z})) return std::nullopt;
  const NetworkWater water = water_at(at);
  if (!(water.depth_m > 0) || water.body == network::kSeaBody) return std::nullopt;
  return InlandWater{water, channel_of(water, at)};
}

std::optional<NetworkChannel> RiverNetwork::channel_of(const NetworkWater& water,
                                                       const PatchPlace& at) {
  const network::Patch& patch = *at.patch;
  const network::Box here{at.x, at.z, at.x, at.z};
  if (patch.is_lake_level(double{water.surface_m}) && patch.may_have_lake(here))
    return std::nullopt;
  std::optional<NetworkChannel> channel;
  float least = 0.5F;  // distance in widths
  patch.each_curve(here, [&](const network::Curve& c) {
    const network::NearestPlace near =
        network::nearest_place(c, patch.metres(c.x, at.x), patch.metres(c.z, at.z));
    const float width_m = network::width_m(c, near.t), widths = near.distance_m / width_m;
    if (widths > least) return;
    least = widths;
    channel = {double{c.discharge_m3_s}, double{width_m}};
  });
  return channel;
}

network::HeightRange RiverNetwork::bounds() const {
  return {0, static_cast<float>(scale_.frame.relief_m)};
}

network::HeightRange RiverNetwork::bounds(const Cells& cells, GroundDetail detail) const {
  network::HeightRange range{1e30F, -1e30F};
  for (const auto& [patch, box] : parts_of(cells, detail)) {
    const network::HeightRange part = network::range_of(*patch, box.grown(1), is_fine(detail));
    range = {std::min(range.lowest_m, part.lowest_m), std::max(range.highest_m, part.highest_m)};
  }
  return range;
}

double RiverNetwork::unlimited_error_m(GroundDetail from, GroundDetail to) const {
  // Measured between the ground of the finest nodes and that of coarser ones, by their number of
  // levels, in spacings of the coarser.
  constexpr std::array<double, 9> kSpacings{0, .7, .7, .6, .45, .3, .22, .18, .15};
  constexpr double kGuideErrorM = 0.15;  // of interpolation
  const auto error = [&](int level) {
    const auto up = static_cast<std::size_t>(scale_.halvings() - level);
    return kSpacings[up] * static_cast<double>(scale_.spacing(level)) * scale_.unit_m *
           scale_.settings.steepness;
  };
  const int a = level_of(from), b = level_of(to);
  double sum = is_fine(from) != is_fine(to) ? kGuideErrorM : 0;
  if (a != b) sum += error(a) + error(b);
  return sum;
}

float RiverNetwork::error_m(GroundDetail from, GroundDetail to) const {
  return static_cast<float>(std::min(unlimited_error_m(from, to), scale_.frame.relief_m));
}

float RiverNetwork::usual_error_m(GroundDetail from, GroundDetail to) const {
  constexpr double kUsual = 0.2;  // of the error of mountains; measured: 0.1 to 0.2
  return static_cast<float>(std::min(kUsual * unlimited_error_m(from, to), scale_.frame.relief_m));
}

double RiverNetwork::work(double samples, GroundDetail detail) const {
  constexpr double kGuided = 40, kExact = 70;
  return samples * (is_fine(detail) ? kGuided : kExact);
}

}  // namespace psygen::models
