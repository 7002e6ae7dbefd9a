// The file of a save: makes a new one, and opens, locks and checks an existing one. What is inside
// is the business of SaveGame. Private to engine/save. One thread per file.
#pragma once

#include <filesystem>

#include "engine/core/error.hpp"
#include "engine/save/database.hpp"
#include "engine/save/world_identity.hpp"

namespace psygen::save {

// In the header of every save: "psyg".
inline constexpr std::int32_t kApplicationId = 0x70737967;

// Writes a new, empty save beside `file` and renames it: `file` is whole or absent. Leaves a file
// that exists meanwhile alone. Fails with kIo.
core::Result<void> create_file(const std::filesystem::path& file, const WorldIdentity& world);

// Opens a save, takes its lock until the connection is closed, and checks all of it. Fails with
// kParse (not a save, damaged, newer), kIo (missing, read-only, locked, unreadable) or
// kOutOfMemory, with a sentence; the file is as it was then. O(bytes).
core::Result<Database> open_file(const std::filesystem::path& file);

// Gives the lock back and removes the journal, so that one file is left.
void close_file(Database& database);

// Fails with kParse unless all tables are those of a save or belong to the game.
core::Result<void> check_tables(const Database& database);

// The world that the save was made for. Fails with kParse where the file does not say.
core::Result<WorldIdentity> read_world(const Database& database);

}  // namespace psygen::save
