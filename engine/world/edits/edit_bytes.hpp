// The edits of one block as bytes for storage: a versioned little-endian format in which model
// types have names, not numbers. Decoding trusts nothing: it checks every size before it allocates,
// and every value as if it came from a user. Knows no files. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/models/registry.hpp"
#include "engine/world/edits/edits.hpp"

namespace psygen::world {

// The version of the bytes. It is also in the bytes; stores keep it too
// (save::SaveGame::put_edits).
inline constexpr std::uint16_t kEditFormat = 1;

// All edits of a block, also of models whose types the registry lacks. Empty if there are none;
// then delete the block from the store.
std::vector<std::byte> encode_block(const Edits& edits, const models::Registry& registry,
                                    core::BlockCoord block);

// Replaces the edits of a block by those in the bytes. Blocks may be loaded in any order. Fails
// with kParse for bytes of another format or a newer version, for corrupt contents and for values
// that Edits would reject in `world`. On failure `edits` does not change.
core::Result<void> load_block(Edits& edits, const World& world, const models::Registry& registry,
                              core::BlockCoord block, std::span<const std::byte> bytes);

}  // namespace psygen::world
