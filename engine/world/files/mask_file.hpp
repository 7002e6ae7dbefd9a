// Reads and writes the keys of a [[scatter]] that are its mask. It reads no pictures
// (files_beside.hpp). Internal to world; one thread per file. Format: docs/world-files.md.
#pragma once

#include <string>

#include "engine/world/files/files_beside.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Reads the mask of a table, and the picture that it names. `world` has its terrain and number of
// blocks. Faults are problems of the reader.
void read_mask(TableReader& reader, const World& world, const Beside& beside, ScatterMask& mask);

// Appends the keys from which read_mask() makes an equal mask.
void write_mask(const ScatterMask& mask, std::string& out);

// Allowed kinds of ground as TOML: ["grass", "dry"].
std::string toml_grounds(std::uint32_t grounds);

}  // namespace psygen::world
