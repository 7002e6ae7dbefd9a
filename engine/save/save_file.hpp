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

// Writes a new, empty save beside `file` and renames it: `file` is whole or absent. False where
// somebody else has made the file meanwhile, which stays as it is. Fails with kIo.
core::Result<bool> create_file(const std::filesystem::path& file, const WorldIdentity& world);

// Opens a save, takes its lock until the connection is closed, and checks all of it. Fails with
// kParse (not a save, damaged, newer), kIo (missing, read-only, locked, unreadable) or
// kOutOfMemory, with a sentence; the file is as it was then. O(bytes).
core::Result<Database> open_file(const std::filesystem::path& file);

// Opens a save to read facts from it, without a lock and without a look at its journal. What
// another connection writes meanwhile may be read in part. Fails with kParse (not a save, damaged,
// newer) and kIo. O(number of tables).
core::Result<Database> open_to_look(const std::filesystem::path& file);

// Gives the lock back and removes the journal, so that one file is left.
void close_file(Database& database);

// Fails with kParse unless all tables are those of a save or belong to the game.
core::Result<void> check_tables(const Database& database);

// The world that the save was made for. Fails with kParse where the file does not say.
core::Result<WorldIdentity> read_world(const Database& database);

}  // namespace psygen::save
