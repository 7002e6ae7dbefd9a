// World files: TOML text to World and back (docs/world-files.md).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Reads a world file. Errors name file, line and field and say what is allowed: kParse for texts
// that are no world file, kInvalidArgument and kOverBudget for parameters that a model refuses
// (with the predicted cost), kOverBudget for files above 1 MiB, kIo for files that cannot be read.
// The species of the file become model types of the registry, unless it has equal ones already; if
// anything fails, the registry is as it was.
core::Result<World> load_world(const std::filesystem::path& file, models::Registry& registry);

// The same for a text in memory; `file_name` is for messages only.
core::Result<World> parse_world(std::string_view text, std::string_view file_name,
                                models::Registry& registry);
// With a registry that cannot grow: worlds with species that it lacks are refused.
core::Result<World> load_world(const std::filesystem::path& file, const models::Registry& registry);
core::Result<World> parse_world(std::string_view text, std::string_view file_name,
                                const models::Registry& registry);

// The text of a world file that parse_world() turns into an equal world.
std::string write_world(const World& world, const models::Registry& registry);

}  // namespace psygen::world
