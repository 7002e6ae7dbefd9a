// Saves of a game: round trips, rejected files, and saves of killed processes.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>

#include "engine/models/terrain/terrain.hpp"
#include "engine/world/edits/edit_bytes.hpp"
#include "engine/world/files/world_file.hpp"
#include "game/pilot/pilot.hpp"
#include "game/play/cairn_type.hpp"
#include "tests/game/saves_fixture.hpp"

namespace cairns {
namespace {

constexpr double kSavedStep = 1.0 / 60;

class Saves : public SavesFixture {};

TEST_F(Saves, RestoreTheWholeGame) {
  auto play = begin();
  {
    auto saved = Saved::open(file(), *play);
    ASSERT_TRUE(saved) << saved.error().message;
    Pilot pilot(*play);
    for (int k = 0; k < 240 * 60; ++k)
      play->step(pilot.steer(kSavedStep), kSavedStep);
    ASSERT_TRUE(saved->put(*play));
    ASSERT_TRUE(saved->wait());
  }
  ASSERT_GT(play->progress().found.count(), 0U);
  ASSERT_GT(play->edits().counts().removed, 0U);
  auto again = begin();
  auto saved = Saved::open(file(), *again);
  ASSERT_TRUE(saved) << saved.error().message;
  const Progress &a = play->progress(), &b = again->progress();
  EXPECT_EQ(a.feet.block, b.feet.block);
  EXPECT_EQ(a.feet.local, b.feet.local);
  EXPECT_EQ(a.yaw, b.yaw);
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.found, b.found);
  EXPECT_EQ(a.stock.stones, b.stock.stones);
  EXPECT_EQ(a.stock.wood, b.stock.wood);
  EXPECT_EQ(a.seen, b.seen);
  EXPECT_EQ(a.waymarks.size(), b.waymarks.size());
  const world::Edits none;
  const auto blocks = world::changed_blocks(none, play->edits());
  EXPECT_EQ(blocks.size(), world::changed_blocks(none, again->edits()).size());
  for (const core::BlockCoord block : blocks)
    EXPECT_EQ(world::encode_block(play->edits(), land_->registry, block),
              world::encode_block(again->edits(), land_->registry, block));
  EXPECT_EQ(last_seed(folder_), std::optional<std::uint64_t>(3));
}

TEST_F(Saves, TheLastSaveIsKnownAfterTheClockWasSetBack) {
  auto play = begin();
  { ASSERT_TRUE(Saved::open(file(), *play)); }
  // Another land, saved while the clock was far ahead.
  const std::filesystem::path other = save_file(folder_, 4);
  std::ofstream(other) << "later";
  std::filesystem::last_write_time(
      other, std::filesystem::last_write_time(file()) + std::chrono::hours(1000));
  EXPECT_EQ(last_seed(folder_), std::optional<std::uint64_t>(3));
  std::filesystem::remove(file());
  EXPECT_EQ(last_seed(folder_), std::nullopt);
  EXPECT_EQ(last_seed(folder_ / "none"), std::nullopt);
}

TEST_F(Saves, TheLastSaveIsUnknownIfItsNoteIsNoShortFile) {
  auto play = begin();
  { ASSERT_TRUE(Saved::open(file(), *play)); }
  const std::filesystem::path note = folder_ / "last.txt";
  std::ofstream(note) << std::string(100, '3');
  EXPECT_EQ(last_seed(folder_), std::nullopt);
  std::filesystem::remove(note);
  std::filesystem::create_symlink("/dev/zero", note);
  EXPECT_EQ(last_seed(folder_), std::nullopt) << "a device without an end";
  std::filesystem::remove(note);
  ASSERT_EQ(mkfifo(note.c_str(), 0600), 0);
  EXPECT_EQ(last_seed(folder_), std::nullopt) << "a pipe that nobody writes to";
}

// A game that is quit and resumed can be finished.
TEST_F(Saves, AGameThatIsResumedEveryMinuteCanBeFinished) {
  for (int minute = 0; minute < 40; ++minute) {
    auto play = begin();
    auto saved = Saved::open(file(), *play);
    ASSERT_TRUE(saved) << saved.error().message;
    Pilot pilot(*play);
    for (int k = 0; k < 3600 && !play->is_finished(); ++k)
      play->step(pilot.steer(kSavedStep), kSavedStep);
    ASSERT_TRUE(saved->put(*play));
    ASSERT_TRUE(saved->wait());
    if (play->is_finished()) return;
  }
  FAIL() << "not finished in 40 minutes";
}

TEST_F(Saves, AreRejectedWithAMessageAndStayUnchanged) {
  {
    auto play = begin();
    auto saved = Saved::open(file(), *play);
    ASSERT_TRUE(saved);
    ASSERT_TRUE(saved->put(*play));
    ASSERT_TRUE(saved->wait());
    // An open save is locked.
    auto other = begin();
    const auto second = Saved::open(file(), *other);
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find(file().string()), std::string::npos);
  }
  const auto land = Land::load(4);
  auto foreign = *Play::create((*land)->world, (*land)->registry);
  const auto refused = Saved::open(file(), *foreign);
  ASSERT_FALSE(refused);
  const auto size = std::filesystem::file_size(file());
  auto play = begin();
  const core::WorldPosition feet = play->progress().feet;
  for (const std::uintmax_t cut : {std::uintmax_t{0}, std::uintmax_t{1}, size / 2, size - 1}) {
    const std::filesystem::path broken = folder_ / "broken.cairns";
    std::filesystem::copy_file(file(), broken, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(broken, cut);
    const auto opened = Saved::open(broken, *play);
    EXPECT_FALSE(opened) << cut;
    EXPECT_EQ(play->progress().feet.local, feet.local);
  }
}

// Plays four minutes and saves them.
void play_and_save(const std::filesystem::path& file, Play& play) {
  auto saved = Saved::open(file, play);
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_FALSE(saved->notice());
  Pilot pilot(play);
  for (int k = 0; k < 240 * 60; ++k)
    play.step(pilot.steer(kSavedStep), kSavedStep);
  ASSERT_TRUE(saved->put(play));
  ASSERT_TRUE(saved->wait());
}

TEST_F(Saves, AChangedLandKeepsTheGameAndSaysSo) {
  auto play = begin();
  play_and_save(file(), *play);
  const auto removed = play->edits().counts().removed;
  ASSERT_GT(removed, 0U);
  // A newer version without boulders, in which small stones have other indices.
  const auto land = *Land::load(3);
  auto& scatter = land->world.scatter;
  ASSERT_EQ(scatter.size(), 12U);
  scatter.erase(scatter.begin() + 7);
  {
    auto again = *Play::create(land->world, land->registry);
    auto saved = Saved::open(file(), *again);
    ASSERT_TRUE(saved) << saved.error().message;
    ASSERT_TRUE(saved->notice());
    EXPECT_EQ(saved->notice()->line, "The land has changed since your last visit.");
    const auto lost = removed - again->edits().counts().removed;
    EXPECT_GT(lost, 0U);
    EXPECT_EQ(saved->notice()->help,
              std::to_string(lost) + " of your changes no longer fit. The save keeps them.");
    EXPECT_EQ(again->progress().found, play->progress().found);
    EXPECT_EQ(again->progress().stock.stones, play->progress().stock.stones);
    EXPECT_EQ(again->edits().counts().placed, play->edits().counts().placed);
    ASSERT_TRUE(saved->put(*again));
    ASSERT_TRUE(saved->wait());
  }
  // The old version has everything again.
  auto before = begin();
  const auto saved = Saved::open(file(), *before);
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_EQ(before->edits().counts().removed, removed);
  ASSERT_TRUE(saved->notice());
  EXPECT_EQ(saved->notice()->help, "Everything that you changed is still here.");
}

TEST_F(Saves, OnRisenGroundThePlayerStandsOnItAndTheHiddenCairnsMove) {
  auto play = begin();
  play_and_save(file(), *play);
  std::string steeper = *land_text(3);
  const std::string slopes = "steepness = 1.4";
  ASSERT_NE(steeper.find(slopes), std::string::npos);
  steeper.replace(steeper.find(slopes), slopes.size(), "steepness = 1.7");
  const auto land = *Land::load(3);
  land->world = *world::parse_world(steeper, "steeper.toml", land->registry);
  auto again = *Play::create(land->world, land->registry);
  const auto saved = Saved::open(file(), *again);
  ASSERT_TRUE(saved) << saved.error().message;
  ASSERT_TRUE(saved->notice());
  const core::WorldPosition feet = again->progress().feet;
  EXPECT_GT(feet.local.y, play->progress().feet.local.y + 1);
  EXPECT_GE(feet.local.y, again->query().ground(feet)->height_m - 0.5);
  EXPECT_GT(distance_m(again->route().cairns[11], play->route().cairns[11], again->block_m()), 1);
  std::size_t hidden = 0;
  for (const core::BlockCoord block : world::changed_blocks({}, again->edits())) {
    for (const models::PlacedModel& model : again->edits().layer()->block(block)->placed) {
      if (model.parameters.integer(kCairnStones) != 11) continue;
      ++hidden;
      const core::WorldPosition at{block, {model.local_m.x, 0, model.local_m.y}};
      EXPECT_TRUE(std::ranges::any_of(again->route().cairns, [&](const auto& cairn) {
        return distance_m(at, cairn, again->block_m()) < 0.01;
      }));
    }
  }
  EXPECT_EQ(hidden, kCairns);
}

TEST_F(Saves, OfANewerFormatOrWithInvalidNumbersAreRejected) {
  // A position in a save: a block, metres in it, and a time.
  const auto place = [](std::int32_t block_x, double x, double until_s) {
    const std::int32_t block[] = {block_x, 0};
    const double numbers[] = {x, 0, 0, until_s};
    save::Bytes bytes(sizeof(block) + sizeof(numbers));
    std::memcpy(bytes.data(), block, sizeof(block));
    std::memcpy(bytes.data() + sizeof(block), numbers, sizeof(numbers));
    return bytes;
  };
  const std::pair<const char*, save::Value> wrong[] = {
      {"format", std::int64_t{2}},
      {"time_s", -5.0},
      {"stones", std::int64_t{-1}},
      {"wood", std::int64_t{1} << 40},
      {"feet", save::Bytes(7)},
      {"feet", place(68'174'085, 0, 0)},  // 2^31 cells of paths from the origin
      {"feet", place(0, std::nan(""), 0)},
      {"waymarks", place(INT32_MIN, 0, 0)},
      {"fires", place(0, 0, std::nan(""))},
      {"yaw", std::string("n")},
      {"found", save::Value()}};
  for (const auto& [name, value] : wrong) {
    std::filesystem::remove(file());
    {
      auto play = begin();
      auto saved = Saved::open(file(), *play);
      ASSERT_TRUE(saved->put(*play));
      ASSERT_TRUE(saved->wait());
    }
    {
      auto raw = save::SaveGame::open(file(), save::identity_of(land_->world, land_->registry));
      ASSERT_TRUE(raw);
      ASSERT_TRUE(raw->put_value(name, value));
      ASSERT_TRUE(raw->save());
    }
    auto play = begin();
    const auto opened = Saved::open(file(), *play);
    ASSERT_FALSE(opened) << name;
    EXPECT_NE(opened.error().message.find(file().string()), std::string::npos);
  }
}

// Kills a saving process 100 times in the middle of a write: the save then holds the previous or
// the new state, complete.
TEST_F(Saves, AKilledProcessLeavesACompleteSave) {
  auto play = begin();
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kStructure);
  int stones = 0;
  for (int kill = 0; kill < 100; ++kill) {
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      auto saved = Saved::open(file(), *play);
      if (!saved) ::_exit(3);
      Progress progress = play->progress();
      for (;;) {
        // Stones and wood grow together, so a mix of two saves would show.
        progress.stock = {progress.stock.stones + 1, progress.stock.stones + 1};
        progress.seen[cell_name(progress.stock.stones, 0)] = 1;
        if (!play->resume(progress, play->edits()) || !saved->put(*play) || !saved->wait())
          ::_exit(4);
        if (::write(ready[1], "x", 1) != 1) ::_exit(5);
      }
    }
    char byte;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);  // it has saved once
    ::usleep(static_cast<useconds_t>(random.next_integer(0, 9000)));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status)) << WEXITSTATUS(status);
    ::close(ready[0]);
    ::close(ready[1]);
    auto saved = Saved::open(file(), *play);
    ASSERT_TRUE(saved) << saved.error().message;
    const Stock stock = play->progress().stock;
    EXPECT_EQ(stock.stones, stock.wood);
    EXPECT_GT(stock.stones, stones);
    EXPECT_TRUE(play->progress().seen.contains(cell_name(stock.stones, 0)));
    EXPECT_FALSE(play->progress().seen.contains(cell_name(stock.stones + 1, 0)));
    stones = stock.stones;
  }
}

}  // namespace
}  // namespace cairns
