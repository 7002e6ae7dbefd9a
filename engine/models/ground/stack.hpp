// The ground of a world over its noise, as a stack of layers: of the world file the river network,
// which takes the place of wide noise, the erosion, and the shapes (stamps, roads, rivers and
// lakes); then the edits of a running game. Every height passes the whole stack (TerrainShape). A
// value: copies are O(1) and independent. Any thread may read a value that no thread changes.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/core/value_cache.hpp"
#include "engine/models/ground/erosion.hpp"
#include "engine/models/ground/ground_edits.hpp"
#include "engine/models/kit/ground_detail.hpp"
#include "engine/models/network/network.hpp"

namespace psygen::models {

struct GroundStack {
  std::shared_ptr<const RiverNetwork> network;  // takes the place of the noise; null: none
  std::shared_ptr<const Erosion> erosion;       // of the world file; null: none
  GroundEdits shapes;  // of the world file; with the erosion part of the world's function
  GroundEdits edits;   // made by hand, over the shapes
  // Keeps the heights of blocks with a fixed part (terrain/ground.hpp), and squares of guide lines
  // of a network (terrain/shape.cpp); null: nothing does. It changes no height.
  std::shared_ptr<core::ValueCache> heights;

  // True if the ground is only noise.
  bool empty() const { return !has_fixed_part() && shapes.empty() && edits.empty(); }
  // True if it has layers that change the ground everywhere.
  bool has_fixed_part() const { return network != nullptr || erosion != nullptr; }
  // True if both have the same layers of the world file, or copies of them; and takes over those.
  bool has_function_of(const GroundStack& other) const {
    return same_fixed_part(*this, other) && shapes.is(other.shapes);
  }
  void take_function_of(const GroundStack& other) {
    network = other.network;
    erosion = other.erosion;
    shapes = other.shapes;
    heights = other.heights;
  }

  // Hash of all layers that can change the ground mesh of a node that needs heights `margin` blocks
  // beyond its border; 0: none. O(log n), and O(margin) for large nodes.
  std::uint64_t hash_of(const QuadCoord& node, double margin, double block_m) const;
  // True if both have the same layers there. May be false although they do; O(log n) after small
  // changes.
  static bool same_in(const GroundStack& a, const GroundStack& b, const QuadCoord& node,
                      double margin);
  // True if any layer may change heights within a node. May be true although none does.
  bool reaches(const QuadCoord& node, double block_m) const;
  // Returns the pieces of roads that may reach a node, each once.
  std::vector<const GroundEdit*> roads_in(const QuadCoord& node, double block_m,
                                          double margin = 0) const;
  // True if there is any river or lake. O(1).
  bool has_water() const { return network != nullptr || shapes.has_water() || edits.has_water(); }
  // The same for pieces of rivers and lakes made by hand; a network has none.
  std::vector<const GroundEdit*> water_in(const QuadCoord& node, double block_m) const;
  // Returns the surface of the river or lake that owns a place in a block; nothing: none reaches
  // it. The place must be normalised. Some hundred nanoseconds; 2 µs in the water of a network.
  std::optional<BodySurface> water_over(core::BlockCoord block, glm::dvec2 local_m,
                                        double block_m) const;
  // False if water_over() has nothing for any place in a block, or within `margin_m` along each
  // axis beyond it. May be true although it has nothing; always where the margin is much wider than
  // the patches of a network. Some hundred nanoseconds.
  bool may_have_water(core::BlockCoord block, double margin_m, double block_m) const;
  // The same within a distance of a place in the block, for the network only.
  bool may_have_network_water(core::BlockCoord block, glm::dvec2 local_m, double margin_m) const;
  // Largest distance between the ground and a mesh of the node with vertices `spacing_m` apart,
  // because of shapes and edits between them. An upper bound in metres; 0: neither.
  double error_m(const QuadCoord& node, double spacing_m, double block_m) const;
  // Estimate of the work of shapes and edits on a height, as a mean over the rectangle. It never
  // depends on a cache.
  HeightWork work_per_height(const GroundScale& scale, LatticeSpan x, LatticeSpan z) const;
  // Changes eroded heights at the lattice points (x[i], z[k]), values[k · stride + i], by shapes
  // and edits. x and z ascend. Masks read the guide of the ground below.
  void apply(const GroundScale& scale, std::span<const std::int64_t> x,
             std::span<const std::int64_t> z, std::span<float> values, std::size_t stride,
             GroundDetail detail, const ErosionGuide& guide) const;

 private:
  std::uint64_t fixed_identity() const;
  static bool same_fixed_part(const GroundStack& a, const GroundStack& b) {
    const auto network_of = [](const GroundStack& s) {
      return s.network ? s.network->identity() : 0;
    };
    if (network_of(a) != network_of(b)) return false;
    if (a.erosion == b.erosion) return true;
    return a.erosion != nullptr && b.erosion != nullptr && *a.erosion == *b.erosion;
  }
};

}  // namespace psygen::models
