// Faults that could drop a player out of the land or lose a save: drops, long runs, teleports, the
// edge of the coordinates, ten thousand edits in a block, and a full disk.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>

#include "tests/engine/save/file_faults.hpp"
#include "tests/game/saves_fixture.hpp"

namespace cairns {
namespace {

constexpr double kFaultStep = 1.0 / 60;

// Returns a number that the environment may raise for a longer run (docs/game.md).
int figure(const char* name, int usual) {
  const char* text = std::getenv(name);
  return text == nullptr ? usual : std::atoi(text);
}

// A player in a land without a game.
struct Body {
  std::unique_ptr<Land> land = *Land::load(3);
  query::World query{land->world, land->registry};
  physics::World physics = *physics::World::create(query);
  Abilities abilities{(1ULL << kCairns) - 1};

  double block_m() const { return land->world.block_size_m(); }
  // Returns true if the feet are on or above the ground.
  ::testing::AssertionResult is_above(const core::WorldPosition& feet) {
    const auto ground = query.ground(feet);
    if (!ground) return ::testing::AssertionFailure() << "no ground";
    if (feet.local.y >= ground->height_m - 1e-4) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure()
           << ground->height_m - feet.local.y << " m below the ground in block " << feet.block.x
           << ", " << feet.block.z << " at " << feet.local.x << ", " << feet.local.z;
  }
};

core::WorldPosition somewhere(core::RandomStream& random, core::BlockCoord block, double block_m) {
  core::WorldPosition at;
  at.block = block;
  at.local = {random.next_real(0, block_m), 0, random.next_real(0, block_m)};
  return at;
}

core::BlockCoord any_block(core::RandomStream& random, std::int64_t reach) {
  return {static_cast<std::int32_t>(random.next_integer(-reach, reach)),
          static_cast<std::int32_t>(random.next_integer(-reach, reach))};
}

// PSYGEN_DROPS=1000000 drops a million players.
TEST(Faults, APlayerDroppedAnywhereEndsOnTheGround) {
  Body body;
  core::RandomStream random(11, 0, 0, 0, core::Purpose::kStructure);
  auto walker = *Walker::create(body.physics, body.query, {});
  const int drops = figure("PSYGEN_DROPS", 2'000), in_a_block = 100;
  core::BlockCoord block;
  int came_down = 0, sail = 0;
  for (int i = 0; i < drops; ++i) {
    if (i % in_a_block == 0) block = any_block(random, 1 << 20);
    core::WorldPosition at = somewhere(random, block, body.block_m());
    const double high_m = random.next_real(-5, 15);
    at.local.y = body.query.ground(at)->height_m + high_m;
    ASSERT_TRUE(walker.put(at, random.next_real(0, 6)));
    Intent intent;
    intent.move = {random.next_real(-1, 1), random.next_real(-1, 1)};
    intent.run = random.next_unit() < 0.5;
    intent.jump_held = random.next_unit() < 0.2;
    sail += intent.jump_held ? 1 : 0;
    for (int k = 0; k < (intent.jump_held ? 60 : 300); ++k) {
      walker.decide(intent, body.abilities, {}, kFaultStep);
      ASSERT_TRUE(body.physics.step(kFaultStep));
      walker.follow();
      ASSERT_TRUE(body.is_above(walker.feet())) << "drop " << i << ", step " << k;
      if (k > 2 && (walker.gait() == Gait::kGround || walker.gait() == Gait::kSwim)) {
        came_down += intent.jump_held ? 0 : 1;
        break;
      }
    }
  }
  EXPECT_GT(came_down, 0.95 * (drops - sail)) << "others slide on";
}

// PSYGEN_FAR_BLOCKS=1000 runs across a thousand blocks.
TEST(Faults, APlayerAtTenTimesWalkingSpeedStaysOnTheGround) {
  Body body;
  const int blocks = figure("PSYGEN_FAR_BLOCKS", 60);
  const auto feet = body.query.ground({}).value();
  core::WorldPosition at;
  at.local.y = feet.height_m;
  const auto runner = *body.physics.add(physics::CharacterSettings{.feet = at});
  std::set<std::int32_t> crossed;
  int stuck = 0;
  double last_m = 0;
  for (int k = 0; static_cast<int>(crossed.size()) < blocks; ++k) {
    ASSERT_LT(k, blocks * 4'000) << crossed.size() << " blocks in all";
    physics::CharacterInput told;
    told.direction = {1, 0};
    told.speed = 22;
    // The player flies over obstacles that cannot be climbed, and lands behind them.
    if (stuck > 0) told.rise = 6;
    ASSERT_TRUE(body.physics.tell(runner, told));
    ASSERT_TRUE(body.physics.step(kFaultStep));
    const auto state = *body.physics.state(runner);
    ASSERT_TRUE(body.is_above(state.feet)) << "step " << k;
    crossed.insert(state.feet.block.x);
    const double way_m = state.feet.block.x * body.block_m() + state.feet.local.x;
    stuck = way_m - last_m < 0.1 ? 40 : std::max(stuck - 1, 0);
    last_m = way_m;
  }
}

TEST(Faults, ATeleportedPlayerHasGroundImmediately) {
  Body body;
  core::RandomStream random(12, 0, 0, 0, core::Purpose::kStructure);
  auto walker = *Walker::create(body.physics, body.query, {});
  for (int i = 0; i < 200; ++i) {
    const std::int64_t reach = i % 2 == 0 ? 40 : std::numeric_limits<std::int32_t>::max() - 4;
    const core::BlockCoord block = any_block(random, reach);
    core::WorldPosition at = somewhere(random, block, body.block_m());
    at.local.y = random.next_real(-1e4, 400);
    ASSERT_TRUE(walker.put(at, 0));
    for (int k = 0; k < 10; ++k) {
      walker.decide({.move = {0, 1}, .run = true}, body.abilities, {}, kFaultStep);
      ASSERT_TRUE(body.physics.step(kFaultStep));
      walker.follow();
      ASSERT_TRUE(body.is_above(walker.feet())) << "jump " << i;
    }
  }
}

// At the edge of the coordinates the land ends or the player stops.
TEST(Faults, APlayerAtTheEdgeOfTheCoordinatesStays) {
  Body body;
  constexpr std::int32_t kLast = std::numeric_limits<std::int32_t>::max();
  for (const bool positive : {true, false}) {
    auto physics = *physics::World::create(body.query);
    core::WorldPosition at;
    at.block = {positive ? kLast - 1 : -kLast, 0};
    at.local = {32, 500, 32};
    auto made = Walker::create(physics, body.query, at);
    ASSERT_TRUE(made) << made.error().message;
    Walker walker = std::move(*made);
    ASSERT_TRUE(walker.put(at, positive ? 1.5708 : -1.5708));  // faces the edge
    for (int k = 0; k < 1'500; ++k) {
      walker.decide({.move = {0, 1}, .run = true, .jump = k % 90 == 0}, body.abilities, {},
                    kFaultStep);
      ASSERT_TRUE(physics.step(kFaultStep));
      walker.follow();
      ASSERT_GE(std::abs(static_cast<double>(walker.feet().block.x)), kLast - 2.0) << k;
      if (body.query.ground(walker.feet())) {
        ASSERT_TRUE(body.is_above(walker.feet()));
      }
    }
  }
}

class GameFaults : public SavesFixture {};

TEST_F(GameFaults, ABlockWithTenThousandEditsIsPlayableAndSaved) {
  auto play = begin();
  world::Edits edits = play->edits();
  const std::uint64_t before = edits.counts().placed;
  world::NewModel stone;
  stone.model = static_cast<models::ModelIndex>(land_->registry.find("rock"));
  stone.parameters = models::default_parameters(land_->registry[stone.model]);
  core::RandomStream random(13, 0, 0, 0, core::Purpose::kStructure);
  std::string refused;
  for (int i = 0; i < 10'000; ++i) {
    stone.at = somewhere(random, play->route().start.block, play->block_m());
    stone.at.local.y = play->query().ground(stone.at)->height_m;
    const auto placed = edits.place(play->world(), land_->registry, stone);
    if (!placed) {
      refused = placed.error().message;
      break;
    }
  }
  ASSERT_EQ(refused, "");
  ASSERT_EQ(edits.counts().placed, before + 10'000);
  ASSERT_TRUE(play->resume(play->progress(), edits));
  for (int k = 0; k < 300; ++k)
    play->step({.move = {0, 1}, .run = true, .use = k % 20 == 0}, kFaultStep);
  {
    auto saved = Saved::open(file(), *play);
    ASSERT_TRUE(saved) << saved.error().message;
    ASSERT_TRUE(saved->put(*play));
    ASSERT_TRUE(saved->wait());
  }
  auto again = begin();
  auto saved = Saved::open(file(), *again);
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_EQ(again->edits().counts().placed, play->edits().counts().placed);
  EXPECT_EQ(again->progress().feet.local, play->progress().feet.local);
}

// On a disk with room for no write, for one write, and so on: a save is reported as failed or
// exists, and the previous save is never lost.
TEST_F(GameFaults, AFullDiskIsReportedAndKeepsThePreviousSave) {
  auto play = begin();
  int told = 0, stones = 0;
  for (std::size_t calls = 0;; ++calls) {
    {
      auto saved = Saved::open(file(), *play);
      ASSERT_TRUE(saved) << saved.error().message;
      Progress progress = play->progress();
      progress.stock.stones = static_cast<int>(calls) + 1;
      ASSERT_TRUE(play->resume(progress, play->edits()));
      bool met = false;
      core::Result<void> done;
      {
        const save::testing::FileFaults full(save::testing::Fault::kFullDisk, calls);
        done = saved->put(*play).and_then([&] { return saved->wait(); });
        met = full.was_met();
      }
      EXPECT_TRUE(done || met);
      if (done) stones = progress.stock.stones;
      if (!done) {
        ++told;
        EXPECT_NE(done.error().message.find("3.cairns"), std::string::npos) << done.error().message;
        // The next save succeeds once there is room.
        if (calls % 3 == 0) {
          ASSERT_TRUE(saved->put(*play).and_then([&] { return saved->wait(); }));
          stones = progress.stock.stones;
        }
      }
      if (!met) break;
    }
    auto again = begin();
    auto opened = Saved::open(file(), *again);
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_EQ(again->progress().stock.stones, stones) << "room for " << calls << " calls";
  }
  EXPECT_GT(told, 0);
}

}  // namespace
}  // namespace cairns
