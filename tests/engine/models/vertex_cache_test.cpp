// Order of indices in meshes: GPUs and lavapipe keep the last few shaded vertices, and shade a
// vertex again that recurs too late.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <span>

#include "engine/models/registry.hpp"
#include "engine/models/terrain/tiles.hpp"
#include "tests/engine/models/mesh_helpers.hpp"

namespace psygen::models {
namespace {

// Mean number of times that a used vertex is shaded, with a cache of the last 32 vertices, first
// in, first out. 1 is optimal.
double shaded_per_vertex(std::span<const std::uint16_t> indices) {
  constexpr std::size_t kKept = 32;
  std::array<int, kKept> kept;
  kept.fill(-1);
  std::size_t shaded = 0;
  std::set<std::uint16_t> named;
  for (const std::uint16_t index : indices) {
    named.insert(index);
    if (std::ranges::find(kept, int{index}) != kept.end()) continue;
    kept[shaded++ % kKept] = index;
  }
  return static_cast<double>(shaded) / static_cast<double>(named.size());
}

TEST(VertexCache, CountsVerticesThatAreShadedAgain) {
  std::vector<std::uint16_t> near, far;
  for (std::uint16_t i = 0; i < 100; ++i) {
    for (const int corner : {0, 1, 2})
      near.push_back(static_cast<std::uint16_t>(i + corner));
  }
  for (int again = 0; again < 2; ++again) {
    for (std::uint16_t i = 0; i < 99; ++i)
      far.push_back(i);
  }
  EXPECT_EQ(shaded_per_vertex(near), 1);
  EXPECT_EQ(shaded_per_vertex(far), 2);
}

TEST(VertexCache, OrderOfIndicesOfEveryTypeSuitsIt) {
  const Registry registry = make_standard_registry();
  for (ModelIndex m = 0; m < registry.size(); ++m) {
    const ModelType& type = registry[m];
    const Parameters p = default_parameters(type);
    for (int level = 0; level < type.level_count_of(p); ++level) {
      const test::Mesh mesh = test::synthesise(type, p, level);
      // Ground in tiles shades the vertices between tiles twice.
      EXPECT_LT(shaded_per_vertex(mesh.indices), 1.35) << type.name() << " level " << level;
    }
  }
}

TEST(VertexCache, OrderOfIndicesOfGroundTilesSuitsIt) {
  for (const int size : {8, 64, 97, 128}) {
    const TerrainTiles tiles(size);
    std::vector<std::uint16_t> indices(tiles.index_count());
    tiles.write_indices(indices);
    const auto shaded = [&](core::IndexPart part) {
      return shaded_per_vertex(std::span(indices).subspan(part.first, part.count));
    };
    for (int row = 0; row < tiles.grid().tiles_per_side(); ++row) {
      for (int column = 0; column < tiles.grid().tiles_per_side(); ++column) {
        EXPECT_LT(shaded(tiles.fine(column, row)), 1.12) << size << " vertices";
        for (const std::uint8_t divided : {TerrainTiles::kNone, TerrainTiles::kAll})
          EXPECT_LT(shaded(tiles.coarse(column, row, divided)), 1.12) << size << " vertices";
      }
    }
  }
}

}  // namespace
}  // namespace psygen::models
