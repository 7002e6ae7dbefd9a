// The [[scatter]] tables of a world file: which models stand on each block.
#pragma once

#include "engine/world/files/table_reader.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Reads all of them into world.scatter. Refuses unknown models, parameters that their types do not
// allow, and more models or triangles on a block than there may be. world.terrain_model is set.
void read_scatters(TableReader& root, const models::Registry& registry, World& world,
                   Problems& problems);

}  // namespace psygen::world
