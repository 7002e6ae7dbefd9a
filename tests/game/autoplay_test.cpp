// Whole games, played by the autopilot without a renderer: each game ends, is the same every time,
// and the player never falls through the ground.
#include <gtest/gtest.h>

#include <array>

#include "game/pilot/pilot.hpp"

namespace cairns {
namespace {

constexpr double kStep = 1.0 / 60;
constexpr int kMaxSteps = 40 * 3600;
constexpr std::size_t kHappenings = static_cast<std::size_t>(Happening::Kind::kSplashed) + 1;
constexpr std::size_t kGaits = static_cast<std::size_t>(Gait::kClimb) + 1;

// A game with its autopilot.
struct Played {
  std::unique_ptr<Land> land;
  std::unique_ptr<Play> play;
  std::unique_ptr<Pilot> pilot;
  std::array<int, kHappenings> happened{};
  std::array<int, kGaits> gaits{};

  explicit Played(std::uint64_t seed, double start_hour = 8.5) : land(*Land::load(seed)) {
    land->world.sky.start_hour = start_hour;
    play = *Play::create(land->world, land->registry);
    pilot = std::make_unique<Pilot>(*play);
  }
  void step() {
    play->step(pilot->steer(kStep), kStep);
    ++gaits[static_cast<std::size_t>(play->walker().gait())];
    for (const Happening& happening : play->take_happenings())
      ++happened[static_cast<std::size_t>(happening.kind)];
  }
  int count(Happening::Kind kind) const { return happened[static_cast<std::size_t>(kind)]; }
  int count(Gait gait) const { return gaits[static_cast<std::size_t>(gait)]; }
};

class Autoplay : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, Autoplay, ::testing::Range<std::uint64_t>(1, 11));

TEST_P(Autoplay, FinishesTheGameOnTheGround) {
  Played game(GetParam());
  for (int k = 0; k < kMaxSteps && !game.play->is_finished(); ++k) {
    game.step();
    const core::WorldPosition& feet = game.play->walker().feet();
    const auto ground = game.play->query().ground(feet);
    ASSERT_TRUE(ground);
    ASSERT_GE(feet.local.y, ground->height_m - 1e-4) << "step " << k;
  }
  EXPECT_TRUE(game.play->is_finished()) << game.play->progress().found.count() << " cairns found";
  EXPECT_EQ(game.count(Happening::Kind::kFound), 12);
  EXPECT_GE(game.count(Happening::Kind::kGathered), kStonesOfCairn);
  EXPECT_GE(game.count(Happening::Kind::kBuilt), 1);
  EXPECT_GE(game.count(Happening::Kind::kFelled), 1);
  EXPECT_GT(game.count(Gait::kGlide), 60);
}

// The ten games together use every ability of the player. They last ten minutes and begin in the
// afternoon, so that night falls.
TEST(Autoplay, SwimsClimbsAndSleeps) {
  bool swum = false, climbed = false, slept = false;
  for (std::uint64_t seed = 1; seed <= 10 && !(swum && climbed && slept); ++seed) {
    Played game(seed, 15);
    for (int k = 0; k < kMaxSteps && !game.play->is_finished(); ++k)
      game.step();
    swum |= game.count(Gait::kSwim) > 0;
    climbed |= game.count(Gait::kClimb) > 0;
    slept |= game.count(Happening::Kind::kSlept) > 0;
  }
  EXPECT_TRUE(swum);
  EXPECT_TRUE(climbed);
  EXPECT_TRUE(slept);
}

TEST(Autoplay, IsTheSameEveryTime) {
  Played first(2), second(2);
  for (int k = 0; k < 90 * 60; ++k) {
    first.step();
    second.step();
    const core::WorldPosition &a = first.play->walker().feet(), &b = second.play->walker().feet();
    ASSERT_EQ(a.block, b.block) << "step " << k;
    ASSERT_EQ(a.local, b.local) << "step " << k;
  }
  EXPECT_EQ(first.happened, second.happened);
  EXPECT_GT(first.play->walker().walked_m(), 100);
}

}  // namespace
}  // namespace cairns
