// The file of a save: creates a new one, and opens, locks and checks an existing one. SaveGame
// handles the content. Private to engine/save. One thread per file.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/save/bound_value.hpp"
#include "engine/save/world_identity.hpp"

namespace psygen::save {

// The application id in the header of every save: "psyg".
inline constexpr std::int32_t kApplicationId = 0x70737967;

// The fact with the version of the game's data.
inline constexpr std::string_view kVersionFact = "game version";

// Writes a new, empty save next to `file` and renames it, so `file` is whole or absent. Returns
// false, and keeps the existing file, if another process has created it in the meantime. Fails with
// kIo.
core::Result<bool> create_file(const std::filesystem::path& file, const WorldIdentity& world,
                               std::uint32_t version = 0);

// Opens a save, locks it until the connection is closed, and checks all of it. Fails with kParse
// (not a save, damaged, newer), kIo (missing, read-only, locked, unreadable) or kOutOfMemory, with
// a message; the file is then unchanged. O(bytes).
core::Result<Database> open_file(const std::filesystem::path& file);

// Opens a save to read facts from it, without a lock and without reading its journal. Changes that
// another connection is writing may be visible in part. Fails with kParse (not a save, damaged,
// newer) and kIo. O(number of tables).
core::Result<Database> open_to_look(const std::filesystem::path& file);

// Releases the lock and removes the journal, so that one file is left.
void close_file(Database& database);

// Fails with kParse unless all tables are those of a save of its format or belong to the game.
core::Result<void> check_tables(const Database& database);

// The format of the file, 1 to kSaveFormat; 0 if its header cannot be read.
std::uint32_t format_of(const Database& database);
// Adds the tables of the newest format to a file of an older one, in the open transaction.
core::Result<void> upgrade_format(Database& database);

// The parts of a world as bytes, with a checksum; and parts from untrusted bytes. Fails with
// kParse.
Bytes encode_parts(const std::vector<WorldPart>& parts);
core::Result<std::vector<WorldPart>> decode_parts(std::span<const std::byte> bytes);

// The world of the save. Fails with kParse if the file does not name it.
core::Result<WorldIdentity> read_world(const Database& database);

}  // namespace psygen::save
