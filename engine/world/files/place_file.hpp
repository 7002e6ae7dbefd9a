// Reads and writes the [[place]] tables of a world file. Internal to world; one thread per file.
// Format: docs/world-files.md.
#pragma once

#include <string>

#include "engine/world/files/table_reader.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Reads all tables and adds problems to `problems`. Requires world.terrain and world.seed.
std::vector<Place> read_places(TableReader& root, const models::Registry& registry,
                               const World& world, Problems& problems);

// Appends tables to `out` that read_places() reads back as equal places.
void write_places(const World& world, const models::Registry& registry, std::string& out);

}  // namespace psygen::world
