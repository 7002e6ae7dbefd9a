// Reads and writes the [[species]] tables of world files. Rules for species are in
// engine/models/tree/species.hpp. Internal to world. Format: docs/species.md.
#pragma once

#include <string>
#include <vector>

#include "engine/models/tree/species.hpp"
#include "engine/world/files/table_reader.hpp"

namespace psygen::world {

inline constexpr std::size_t kMaxSpecies = 32;  // per file

// Reads all species from the root table. After a problem, do not use the result.
std::vector<models::Species> read_species(TableReader& root);

// Appends tables to `out` that read_species() reads back as equal species.
void write_species(const std::vector<models::Species>& species, std::string& out);

}  // namespace psygen::world
