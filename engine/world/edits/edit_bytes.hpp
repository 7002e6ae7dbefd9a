// The edits of one block as bytes, to be stored: a versioned little-endian format in which model
// types have names, not numbers. Decoding trusts nothing: every size is checked before memory is
// taken, and every value as if it came from a user. Knows no files. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/models/registry.hpp"
#include "engine/world/edits/edits.hpp"

namespace psygen::world {

// The version of the bytes, for whoever stores them (save::SaveGame::put_edits); they have it too.
inline constexpr std::uint16_t kEditFormat = 1;

// All edits of a block; no bytes where there are none, which is what to delete from a store.
std::vector<std::byte> encode_block(const Edits& edits, const models::Registry& registry,
                                    core::BlockCoord block);

// Replaces the edits of a block by those in the bytes. Blocks may be loaded in any order. Fails
// with kParse for bytes of another kind, a newer version, a broken content or values that Edits
// would refuse in `world`. On failure `edits` stays as it was.
core::Result<void> load_block(Edits& edits, const World& world, const models::Registry& registry,
                              core::BlockCoord block, std::span<const std::byte> bytes);

}  // namespace psygen::world
