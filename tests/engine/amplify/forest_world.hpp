// A desert with a dense forest in its corner: blocks whose costs differ by more than 100.
#pragma once

#include <memory>
#include <utility>

#include "engine/world/world.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world::testing {

// Bare ground of `blocks` × `blocks` blocks, with trees on a sixteenth of it.
inline World forest_in_a_desert(std::int64_t blocks = 32) {
  World world = parsed(R"(format = 1
[world]
name = "forest in a desert"
seed = 3
blocks = [32, 32]
block_vertices = 8
cell_m = 6
[terrain]
octaves = 1
[[scatter]]
model = "tree"
count = 20
iterations = 4
branches = 3
)");
  world.blocks_x = world.blocks_z = blocks;
  auto white = std::make_shared<GreyPicture>(GreyPicture{1, 1, {65535}, 0});
  white->hash = content_hash(*white);
  const double border_m = world.block_size_m() * static_cast<double>(blocks) / 4;
  world.scatter[0].mask.picture = std::move(white);
  world.scatter[0].mask.area_m = {0, 0, border_m, border_m};
  return world;
}

}  // namespace psygen::world::testing
