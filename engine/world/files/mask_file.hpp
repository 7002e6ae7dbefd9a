// Reads and writes the mask keys of a [[scatter]]. It reads no images (files_beside.hpp). Internal
// to world; one thread per file. Format: docs/world-files.md.
#pragma once

#include <string>

#include "engine/world/files/resource_loader.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Reads the mask of a table and the image that it names. `world` must have its terrain and number
// of blocks. Adds problems to the reader's.
void read_mask(TableReader& reader, const World& world, const Beside& beside, ScatterMask& mask);

// Appends keys that read_mask() reads back as an equal mask.
void write_mask(const ScatterMask& mask, std::string& out);

// Allowed kinds of ground as TOML: ["grass", "dry"].
std::string toml_grounds(std::uint32_t grounds);

}  // namespace psygen::world
