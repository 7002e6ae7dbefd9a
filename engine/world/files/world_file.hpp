// Reads and writes world files: TOML text to World and back. Safe for hostile files. Any thread, if
// no other thread uses the same registry at the same time. It synthesises nothing. Format:
// docs/world-files.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/world/files/resource_loader.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Reads a world file. Messages name file, line, field and allowed values. Fails with kParse for
// texts that are not world files, with kOverBudget for files above 1 MiB, and with kIo for files
// that cannot be read. Parameters that a model type rejects give kInvalidArgument or kOverBudget
// (with the predicted cost). The registry gets the file's species as model types, unless it already
// has equal ones, and also the handmade models, which `beside` reads. Without `beside`, worlds with
// such models are rejected. After an error the registry is unchanged.
core::Result<World> load_world(const std::filesystem::path& file, models::Registry& registry,
                               const ResourceLoader* beside = nullptr);

// The same for a text in memory. `file_name` is for messages; its folder has the files that it
// names.
core::Result<World> parse_world(std::string_view text, std::string_view file_name,
                                models::Registry& registry, const ResourceLoader* beside = nullptr);
// The same with a registry that cannot grow: worlds with models that it lacks are rejected.
core::Result<World> load_world(const std::filesystem::path& file, const models::Registry& registry,
                               const ResourceLoader* beside = nullptr);
core::Result<World> parse_world(std::string_view text, std::string_view file_name,
                                const models::Registry& registry,
                                const ResourceLoader* beside = nullptr);

// Logs the warnings about a world's rivers, lakes and roads, each after the name of its file.
void log_warnings(const World& world, std::string_view file_name);

// The text of a world file that parse_world() reads back as an equal world.
std::string write_world(const World& world, const models::Registry& registry);
// A hash of that text and of World::files_hash.
std::uint64_t world_hash(const World& world, const models::Registry& registry);

}  // namespace psygen::world
