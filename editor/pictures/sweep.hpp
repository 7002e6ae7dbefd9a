// The cells of a contact sheet: a world with other values of one or two fields. It draws nothing.
// Pure functions; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "editor/document/parsed_world.hpp"
#include "engine/core/error.hpp"
#include "engine/world/files/world_schema.hpp"

namespace psygen::editor {

// True for fields that can be swept: numbers, ranges, choices, booleans and seeds.
bool can_sweep(const world::WorldField& field);

// Returns at most `count` different values of a field as TOML: over the soft range, evenly spaced
// on its scale, with three digits. Seeds begin with the present one and differ between pages. Both
// ends of a range move. All values are within the hard range.
std::vector<std::string> sweep_values(const world::WorldField& field, std::size_t count,
                                      std::uint64_t page = 0);

// One cell of a sheet.
struct SweepCell {
  std::vector<std::string> values;  // one per field, TOML
  std::string text;                 // the world with these values
};

// The sheet of a world text; `world` is its world. One field fills it row by row; of two fields,
// the first varies along the columns and the second along the rows. Fails like with_field_value().
core::Result<std::vector<SweepCell>> sweep_cells(const std::string& text, const ParsedWorld& world,
                                                 const std::vector<world::WorldField>& fields,
                                                 std::size_t rows, std::size_t columns,
                                                 std::uint64_t page = 0);

}  // namespace psygen::editor
