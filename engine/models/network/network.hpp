// A river network as ground: rivers first, and land that follows them. Heights and water are pure
// functions of the settings, the frame and the place, with the same bits on every CPU, from any
// thread, in any order and batch, and whatever the store keeps. Immutable; any thread. A patch that
// is not in the store costs about 2 ms, nothing cached 15 ms. Makes no erosion and no detail: these
// act between base() and carve().
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/models/kit/ground_detail.hpp"
#include "engine/models/network/kernel.hpp"
#include "engine/models/network/store.hpp"

namespace psygen::models {

// The water of the network at a place. Depth 0: dry.
struct NetworkWater {
  float surface_m = 0, depth_m = 0;
  glm::vec2 flow_m_s{0.0F};
  std::uint32_t body = 0;  // a lake, a channel, or network::kSeaBody
};

// A channel at a place: mean discharge (network::discharge_m3_s()) and width of the water.
struct NetworkChannel {
  double discharge_m3_s = 0, width_m = 0;
};

// The water of a lake or a channel at a place.
struct InlandWater {
  NetworkWater water;                     // not dry
  std::optional<NetworkChannel> channel;  // whose water it is; nothing: of a lake
};

class RiverNetwork {
 public:
  // Lattice points in cells of node level 0, ascending.
  struct Lattice {
    std::span<const std::int64_t> x, z;
  };
  struct CellRange {
    std::int64_t first = 0, last = 0;
  };
  // A square of cells of node level 0, from its first vertex on.
  struct Cells {
    std::int64_t x = 0, z = 0, side = 0;
    Cells grown(std::int64_t by) const { return {x - by, z - by, side + 2 * by}; }
  };
  // A part of a square: units, and a patch that serves them.
  struct Part {
    std::shared_ptr<const network::Patch> patch;
    network::Box box;
  };
  using BaseRows = network::BaseRows;
  using CarvedRows = network::CarvedRows;
  static constexpr float kDry = network::kDry;

  // `store` may be shared by networks; null: every patch is made anew. Fails as check() does.
  static core::Result<std::shared_ptr<const RiverNetwork>> create(
      const RiverSettings& settings, const RiverFrame& frame, std::shared_ptr<NetworkStore> store);

  // What it was made from, and a hash of that, never 0.
  const RiverSettings& settings() const { return scale_.settings; }
  const RiverFrame& frame() const { return scale_.frame; }
  std::uint64_t identity() const { return identity_; }

  // The ground before channels and lakes, with slopes, and the places where erosion and detail act.
  void base(const Lattice& at, GroundDetail detail, const BaseRows& rows) const;
  // Cuts channels and lakes into `height_m`, which holds the base with detail; `base_m` must hold
  // the base alone.
  void carve(const Lattice& at, GroundDetail detail, const CarvedRows& rows) const;
  // Both without anything between; `base_m` of the rows is not used.
  void evaluate(const Lattice& at, GroundDetail detail, CarvedRows rows) const;

  // The water at a place over ground that nothing but the network shaped, at detail 0. Places are
  // finite and rounded to 1/64 cell; at vertices it has the bits of evaluate().
  NetworkWater water_at(const core::WorldPosition& place) const;
  // The same without the sea: nothing where no river and no lake is. Of channels that meet, the one
  // whose middle is nearer in its widths. Dry places take a tenth of the time.
  std::optional<InlandWater> inland_water_at(const core::WorldPosition& place) const;
  // False if inland_water_at() has nothing at any place in a square, its border included. May be
  // true although it has nothing; always for squares over more than four patches.
  bool may_have_water(const Cells& cells) const;

  // All ground of the network lies between 0 and the relief.
  network::HeightRange bounds() const;
  // Bounds of a square, its border included, from its patches, which are made if they are missing;
  // about five times as wide as the truth.
  network::HeightRange bounds(const Cells& cells, GroundDetail detail) const;
  // Distances in metres between the grounds of two details that 99.9 % of places in mountains stay
  // below, and 95 % of all places. By measured tables.
  float error_m(GroundDetail from, GroundDetail to) const;
  float usual_error_m(GroundDetail from, GroundDetail to) const;
  // Estimated time of evaluate() with a warm patch, in units of RidgedNoise::work().
  double work(double samples, GroundDetail detail) const;

  // The level of the nodes that a detail reads: the coarsest that vertices of it can tell.
  int level_of(GroundDetail detail) const;
  // The tile whose patch serves the samples around a place.
  network::TileKey tile_of(std::int64_t x_cells, std::int64_t z_cells, GroundDetail detail) const;
  // Calls visit(tile) for every tile that holds a part of a rectangle of cells, ends included.
  void each_tile(CellRange x, CellRange z, GroundDetail detail,
                 const std::function<void(const network::TileKey&)>& visit) const;
  // The cells of a square of 2^level blocks a side with this block at its corner.
  Cells square_of(core::BlockCoord corner, int level) const;
  // A square in parts, row by row: one if a patch serves it all. Every unit lies in one part,
  // without the far borders of the square. Makes patches that are missing.
  std::vector<Part> parts_of(const Cells& cells, GroundDetail detail) const;
  bool ready(const network::TileKey& tile) const;
  // The patch of a tile, from the store or made.
  std::shared_ptr<const network::Patch> patch(const network::TileKey& tile) const;
  // The nodes of a level within a square of cells and around it, for maps and tests.
  network::NodePatch nodes(int level, std::int64_t x_cells, std::int64_t z_cells,
                           std::int64_t side_cells) const;

 private:
  RiverNetwork(const RiverSettings& settings, const RiverFrame& frame,
               std::shared_ptr<NetworkStore> store);
  std::shared_ptr<const network::RootTile> root_tile(const network::TileKey& key) const;
  network::RootNodes root() const;
  network::Square square_of(const network::TileKey& tile) const;
  network::NodePatch nodes_of(const network::TileKey& tile) const;
  std::int64_t tile_units(int level) const { return tile_units_[static_cast<std::size_t>(level)]; }
  double unlimited_error_m(GroundDetail from, GroundDetail to) const;
  // The tile along an axis whose patch serves all units from `first` to `last`, if one does: that
  // of their middle.
  std::optional<std::int64_t> serving_tile(int level, std::int64_t first, std::int64_t last) const;
  // A range of units along an axis, without its end, and the tile whose patch serves it.
  struct Span {
    std::int64_t tile, first, end;
  };
  std::vector<Span> spans_of(int level, std::int64_t first_cell, std::int64_t cells) const;
  Part part_of(int level, const Span& x, const Span& z) const;
  // A place in units from the origin of its patch.
  struct PatchPlace {
    std::shared_ptr<const network::Patch> patch;
    std::int32_t x, z;
  };
  PatchPlace in_patch(const core::WorldPosition& place) const;
  static NetworkWater water_at(const PatchPlace& place);
  static std::optional<NetworkChannel> channel_of(const NetworkWater& water, const PatchPlace& at);
  // Calls visit(patch, samples, first column, first row) for parts of a lattice.
  template <class Visit>
  void each_part(const Lattice& at, GroundDetail detail, const Visit& visit) const;

  network::Scale scale_;
  std::uint64_t identity_;
  std::array<std::int64_t, 9> tile_units_{};
  std::shared_ptr<NetworkStore> store_;
};

}  // namespace psygen::models
