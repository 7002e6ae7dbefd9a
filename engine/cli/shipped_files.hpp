// The worlds and camera paths that come with psygen, found wherever it is installed or built and
// from whatever folder it is run. Files of people keep the names that they have.
#pragma once

#include <filesystem>
#include <string>

#include "engine/app/options.hpp"
#include "engine/world/world.hpp"

namespace psygen::cli {

inline constexpr const char* kDefaultWorld = "paper";

enum class Shipped : std::uint8_t { kWorld, kPath };

// The file that an option means: `name` as it is where there is such a file, else the shipped file
// of that name, with or without its ".toml". Names with a "/" are never those of shipped files.
// Fails with kIo, saying where was looked and what is shipped, where there is neither.
core::Result<std::filesystem::path> find_file(Shipped kind, const std::string& name);

// Reads the world that an option means. Fails as find_file() and world::load_world().
core::Result<world::World> load_world(const std::string& name, models::Registry& registry);

// The same for a world that is made into files: also reads what its own files hold
// (World::files_hash). Fails as load_world() and handmade::hash_of_files().
core::Result<world::World> load_world_and_files(const std::string& name,
                                                models::Registry& registry);

// Replace what was typed by the file that is meant. No path stays no path.
core::Result<void> find_world(app::SessionOptions& options);
core::Result<void> find_path(app::FlightOptions& options);

}  // namespace psygen::cli
