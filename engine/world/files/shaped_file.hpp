// Reads and writes the tables [[stamp]], [[road]], [[lake]] and [[river]] of a world file. Internal
// to world; one thread per file. Format: docs/world-files.md.
#pragma once

#include <string>

#include "engine/world/files/resource_loader.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Reads all tables and the images of stamps.
ShapedGround read_shaped(TableReader& root, const Beside& beside);

// Calls shape_ground() for a world that was read from this file. Errors become problems.
void shape_world(TableReader& root, World& world);

// Appends tables to `out` that read_shaped() reads back as equal ground.
void write_shaped(const ShapedGround& shaped, std::string& out);

// Points as TOML: [[1, 2], [3, 4]]. Numbers as TOML: 1, or [1, 2].
std::string toml_points(const std::vector<glm::dvec2>& points);
std::string toml_numbers(const std::vector<double>& numbers);

}  // namespace psygen::world
