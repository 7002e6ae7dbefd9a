// Finds the shipped worlds and camera paths from any folder, in an installation or a build. Users'
// files keep their names.
#pragma once

#include <filesystem>
#include <string>

#include "engine/world/world.hpp"

namespace psygen::cli {

inline constexpr const char* kDefaultWorld = "paper";

// Kind of a shipped file.
enum class Shipped : std::uint8_t { kWorld, kPath };

// Resolves the value of an option: the file `name` if it exists, else the shipped file of that
// name, with or without ".toml". A name with a "/" never means a shipped file. Fails with kIo if
// neither exists; the message lists the searched folders and the shipped files.
core::Result<std::filesystem::path> find_file(Shipped kind, const std::string& name);

// Reads the world that an option names, and logs its warnings unless `quiet`. Fails as find_file()
// and world::load_world().
core::Result<world::World> load_world(const std::string& name, models::Registry& registry,
                                      bool quiet = false);

// Reads a world whose output goes to files: also hashes the contents of the files that it names
// (World::files_hash). Fails as load_world() and handmade::hash_of_files().
core::Result<world::World> load_world_and_files(const std::string& name, models::Registry& registry,
                                                bool quiet = false);

}  // namespace psygen::cli
