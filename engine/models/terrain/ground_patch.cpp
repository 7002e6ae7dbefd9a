#include "engine/models/terrain/ground_patch.hpp"

#include <algorithm>

#include "engine/models/edits.hpp"
#include "engine/models/task_type.hpp"
#include "engine/models/terrain/grid.hpp"
#include "engine/models/terrain/light.hpp"
#include "engine/models/terrain/shape.hpp"
#include "engine/models/terrain/terrain.hpp"

namespace psygen::models {
namespace {

enum PatchParameter : std::size_t { kLevel, kI, kJ };
constexpr HardRange kTiles{-9e18, 9e18};
constexpr ParameterSpec kSchema[] = {
    placed(integer_parameter("level", "1", 0, {0, 8}, {0, 8}, "level of the nodes")),
    placed(integer_parameter("tile_x", "1", 0, kTiles, {0, 0}, "tile along x")),
    placed(integer_parameter("tile_z", "1", 0, kTiles, {0, 0}, "tile along z"))};

class GroundPatchType final : public TaskType {
 public:
  std::string_view name() const override { return "ground_patch"; }
  std::string_view doc() const override { return "rivers and heights of a part of a network"; }
  std::span<const ParameterSpec> parameters() const override { return kSchema; }
  // The coarsest patches need more of the root.
  double steps(const Parameters& p, int) const override { return p.integer(kLevel) < 3 ? 3 : 1; }
  double step_seconds() const override { return 2e-3; }
  bool may_run_on_main_thread() const override { return true; }

 private:
  void perform(const Parameters& p) const override {
    if (p.edits() == nullptr || p.edits()->ground.network == nullptr) return;
    static_cast<void>(p.edits()->ground.network->patch(
        {static_cast<int>(p.integer(kLevel)), p.integer(kI), p.integer(kJ)}));
  }
};

}  // namespace

std::vector<network::TileKey> ground_patches(const Parameters& terrain, std::int64_t beyond_cells) {
  std::vector<network::TileKey> tiles;
  const TerrainShape shape(terrain);
  if (shape.stack == nullptr || shape.stack->network == nullptr) return tiles;
  const auto add = [&tiles](const network::TileKey& tile) {
    if (std::ranges::find(tiles, tile) == tiles.end()) tiles.push_back(tile);
  };
  const std::int64_t x = terrain.integer(kTerrainBlockX), z = terrain.integer(kTerrainBlockZ);
  // The parent's samples, and those of normals, lie up to a cell of level 1 beyond.
  const int beyond = terrain_strides(shape.size)[1];
  const auto along = [&](std::int64_t block) {
    return LatticeSpan{shape.world_of(block, -beyond),
                       shape.world_of(block, shape.size - 1 + beyond)};
  };
  constexpr std::int64_t kMaxBeyondCells = 512;
  const std::int64_t more = std::min(beyond_cells, kMaxBeyondCells);
  const auto wider = [more](LatticeSpan span) {
    return LatticeSpan{span.first - more, span.last + more};
  };
  const LatticeSpan along_x = along(x), along_z = along(z);
  shape.each_patch(wider(along_x), wider(along_z), shape.detail(), add);
  shape.each_patch(along_x, along_z, GroundDetail::of_node(shape.node_level + 1), add);
  TerrainLight::each_grid(shape,
                          {terrain.real(kTerrainSunAzimuth), terrain.real(kTerrainSunElevation)}, x,
                          z, 0, [&](LatticeSpan of_x, LatticeSpan of_z, GroundDetail detail) {
                            shape.each_patch(of_x, of_z, detail, add);
                          });
  return tiles;
}

std::unique_ptr<ModelType> make_ground_patch_type() {
  return std::make_unique<GroundPatchType>();
}

Parameters ground_patch_parameters(const EditLayer* layer, const network::TileKey& tile) {
  Parameters p;
  p.set_integer(kLevel, tile.level);
  p.set_integer(kI, tile.i);
  p.set_integer(kJ, tile.j);
  p.set_edits(layer, layer->ground.network->identity());
  return p;
}

}  // namespace psygen::models
