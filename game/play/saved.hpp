// A game in a save file: what the player has come to, and the edits of the land. What a save of
// another land, version or program says is refused with a sentence (save::SaveGame).
#pragma once

#include <filesystem>
#include <future>
#include <string>

#include "engine/save/save_game.hpp"
#include "game/play/play.hpp"

namespace cairns {

// The save of a land in a folder.
std::filesystem::path save_file(const std::filesystem::path& folder, std::uint64_t seed);
// The seed of the game that was opened last; nothing where there is none.
std::optional<std::uint64_t> last_seed(const std::filesystem::path& folder);

// The open save of a game. Only one process has it.
class Saved {
 public:
  // Opens or makes the save of a land, and goes on from what it holds. Fails as
  // save::SaveGame::open(), and with kParse for values that cannot be; the game is as it was then.
  static core::Result<Saved> open(const std::filesystem::path& file, Play& play);

  // Takes the state of the game and writes it behind the game's back. What is being written
  // already is waited for, so the disk may be slow but is never overtaken.
  core::Result<void> put(const Play& play);
  // Waits for what is being written. Fails as save::SaveGame::save(); the file then has the state
  // before, and the next put() tries again.
  core::Result<void> wait();
  // The same once it is done: nothing while it is being written or was told already.
  std::optional<core::Result<void>> outcome();

 private:
  explicit Saved(save::SaveGame save) : save_(std::make_unique<save::SaveGame>(std::move(save))) {}
  core::Result<void> resume(Play& play);

  std::unique_ptr<save::SaveGame> save_;  // at one address: another thread writes
  world::Edits stored_;
  std::future<core::Result<void>> writing_;
};

}  // namespace cairns
