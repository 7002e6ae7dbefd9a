// The tables [[species]] of world files (docs/species.md): reading and writing. Internal to world.
#pragma once

#include <string>
#include <vector>

#include "engine/models/tree/species.hpp"
#include "engine/world/files/table_reader.hpp"

namespace psygen::world {

inline constexpr std::size_t kMaxSpecies = 32;

// All species of a file whose root is being read. What is wrong is added to the problems, with the
// line of the field; such species are left out.
std::vector<models::Species> read_species(TableReader& root, Problems& problems);

// Appends the tables that read_species() turns into equal species.
void write_species(const std::vector<models::Species>& species, std::string& out);

}  // namespace psygen::world
