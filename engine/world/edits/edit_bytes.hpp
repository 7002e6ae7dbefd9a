// The edits of one block as bytes for storage: a versioned little-endian format in which model
// types have names, not numbers. Decoding trusts nothing: it checks every size before it allocates,
// and every value as if it came from a user. Placed models whose type is missing are kept hidden.
// Knows no files. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
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

// The same for edits outside a layer, such as those of decode_block().
std::vector<std::byte> encode_block(const models::BlockEdits& edits);

// Replaces the edits of a block by those in the bytes. Blocks may be loaded in any order. A placed
// model is kept hidden (hidden_models()) if the registry lacks its type, or if the type does not
// allow its parameters. Fails with kParse for bytes of another format or a newer version, for
// corrupt contents and for other values that Edits would reject in `world`. On failure `edits` does
// not change.
core::Result<void> load_block(Edits& edits, const World& world, const models::Registry& registry,
                              core::BlockCoord block, std::span<const std::byte> bytes);

// Decodes edits of a block without a world, for programs that examine edits of a world that they
// lack. Checks the format and its sizes; placed models and ground edits are not bound and sealed.
// Fails with kParse.
core::Result<models::BlockEdits> decode_block(core::BlockCoord block,
                                              std::span<const std::byte> bytes);

// Kinds of edits.
enum class EditKind : std::uint8_t { kRemoved, kPlaced, kGround };

// An edit that a world does not allow.
struct UnfitEdit {
  EditKind kind = EditKind::kRemoved;
  std::uint32_t id = 0;  // of the edit; for kRemoved the index of the model
  bool hidden = false;   // a placed model that load_block() keeps hidden
  std::string reason;
};

// Checks decoded edits of a block in a world, and binds and seals those that it allows. Returns the
// others, in the order of the edits.
std::vector<UnfitEdit> unfit_edits(models::BlockEdits& edits, const World& world,
                                   const models::Registry& registry, core::BlockCoord block);

}  // namespace psygen::world
