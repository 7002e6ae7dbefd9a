// Reads and writes world files: TOML text to World and back. Safe for hostile files. Any thread, if
// no other thread uses the same registry meanwhile. It synthesises nothing. Format:
// docs/world-files.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/world/files/files_beside.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Reads a world file. Errors name file, line and field and say what is allowed. Fails with kParse
// for texts that are not world files, with kOverBudget for files above 1 MiB, and with kIo for
// files that cannot be read. Parameters that a model refuses give kInvalidArgument or kOverBudget
// (with the predicted cost). The species of the file are added to the registry as model types,
// unless it already has equal ones, and so are its handmade models, which `beside` reads. Without
// it worlds with such models are refused. After an error the registry is unchanged.
core::Result<World> load_world(const std::filesystem::path& file, models::Registry& registry,
                               const FilesBeside* beside = nullptr);

// The same for a text in memory; `file_name` is for messages, and its folder for files beside it.
core::Result<World> parse_world(std::string_view text, std::string_view file_name,
                                models::Registry& registry, const FilesBeside* beside = nullptr);
// The same with a registry that cannot grow: worlds with models that it lacks are refused.
core::Result<World> load_world(const std::filesystem::path& file, const models::Registry& registry,
                               const FilesBeside* beside = nullptr);
core::Result<World> parse_world(std::string_view text, std::string_view file_name,
                                const models::Registry& registry,
                                const FilesBeside* beside = nullptr);

// The text of a world file from which parse_world() makes an equal world.
std::string write_world(const World& world, const models::Registry& registry);
// Of that text, and of World::files_hash.
std::uint64_t world_hash(const World& world, const models::Registry& registry);

}  // namespace psygen::world
