// Reads and writes [[place]] of a world file. Internal to world; one thread per file. Format:
// docs/world-files.md.
#pragma once

#include <string>

#include "engine/world/files/table_reader.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Reads all tables. Faults are problems. Requires world.terrain and world.seed.
std::vector<Place> read_places(TableReader& root, const models::Registry& registry,
                               const World& world, Problems& problems);

// Appends tables to `out` from which read_places() makes equal ones.
void write_places(const World& world, const models::Registry& registry, std::string& out);

}  // namespace psygen::world
