// A game in a save file: its progress and the edits of the land. A land that a newer version of the
// game has changed is accepted. Saves of another land, newer version or program are rejected with
// an error message (save::SaveGame).
#pragma once

#include <filesystem>
#include <future>

#include "engine/save/save_game.hpp"
#include "game/play/play.hpp"

namespace cairns {

// Returns the save file of a land in a folder.
std::filesystem::path save_file(const std::filesystem::path& folder, std::uint64_t seed);
// Returns the seed of the last opened game, or nullopt if there is none.
std::optional<std::uint64_t> last_seed(const std::filesystem::path& folder);

// The open save of a game. Only one process can hold it.
class Saved {
 public:
  // Opens or creates the save of a land, and resumes the game that it holds. Fails like
  // save::SaveGame::open(), or with kParse for impossible values, and then changes nothing.
  static core::Result<Saved> open(const std::filesystem::path& file, Play& play);

  // A sentence and its explanation for the player, if the land has changed since the last visit.
  struct Notice {
    std::string line, help;
  };
  const std::optional<Notice>& notice() const { return notice_; }

  // Copies the state of the game and writes it on another thread. Waits for an unfinished write
  // first, so writes never overtake each other.
  core::Result<void> put(const Play& play);
  // Waits for an unfinished write. Fails like save::SaveGame::save(); the file then keeps the
  // previous state, and the next put() tries again.
  core::Result<void> wait();
  // Returns the result of a finished write once, else nullopt.
  std::optional<core::Result<void>> outcome();

 private:
  explicit Saved(save::SaveGame save) : save_(std::make_unique<save::SaveGame>(std::move(save))) {}
  core::Result<void> resume(Play& play);
  void note_changes();

  std::unique_ptr<save::SaveGame> save_;  // stable address, because another thread writes
  world::Edits stored_;
  std::optional<Notice> notice_;
  std::future<core::Result<void>> writing_;
};

}  // namespace cairns
