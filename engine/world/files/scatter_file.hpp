// Reads the [[scatter]] tables of a world file: the models on each block. Internal to world.
// Writing is in write_world.cpp. Format: docs/world-files.md.
#pragma once

#include "engine/world/files/resource_loader.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

inline constexpr std::size_t kMaxScatters = 64;  // per file

// Reads the key "model" of a table: the index of the model type, or −1 after a problem. The terrain
// is not allowed.
int read_model_name(TableReader& reader, const World& world, const models::Registry& registry);

// Reads all tables into world.scatter. Adds problems for unknown models, for parameters that their
// types reject, and for too many models or triangles on a block. `world` must already have the
// values of [world] and its terrain.
void read_scatters(TableReader& root, const models::Registry& registry, const Beside& beside,
                   World& world, Problems& problems);

}  // namespace psygen::world
