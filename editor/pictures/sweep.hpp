// What a contact sheet shows: a world with other values of one or two of its fields, and in which
// order its pictures are made. It draws nothing. Pure functions, any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/world/files/world_schema.hpp"

namespace psygen::editor {

// Whether a field can be swept: numbers, ranges, choices, switches and seeds.
bool can_sweep(const world::WorldField& field);

// `count` values of a field as TOML, or as many different ones as there are: over the soft range,
// evenly on its scale, with three digits; of seeds the present one and then others, of each page
// other ones. Ranges move as a whole. All are within the hard range.
std::vector<std::string> sweep_values(const world::WorldField& field, std::size_t count,
                                      std::uint64_t page = 0);

// One picture of a sheet.
struct SweepCell {
  std::vector<std::string> values;  // one for each field, TOML
  std::string text;                 // the world with them
  bool is_present = false;          // all values are those of the world
};

// A sheet of a world text: one field fills it row by row; of two the first changes along the
// columns, the second along the rows. Fails like world::with_value().
core::Result<std::vector<SweepCell>> sweep_cells(const std::string& text,
                                                 const std::vector<world::WorldField>& fields,
                                                 std::size_t rows, std::size_t columns,
                                                 std::uint64_t page = 0);

// The order in which cells are drawn: what costs least first, then what is unknown; equal ones as
// they stand.
std::vector<std::size_t> cheapest_first(const std::vector<std::optional<double>>& costs);

}  // namespace psygen::editor
