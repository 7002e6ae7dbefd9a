// Whole games, played by the pilot without pictures.
#include <gtest/gtest.h>

#include <cstdio>

#include "game/pilot/pilot.hpp"

namespace cairns {
namespace {

constexpr double kStep = 1.0 / 60;
constexpr int kMostMinutes = 60;

class Autoplay : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, Autoplay, ::testing::Range<std::uint64_t>(1, 11));

TEST_P(Autoplay, FinishesTheGame) {
  const auto land = Land::load(GetParam());
  ASSERT_TRUE(land) << land.error().message;
  auto play = Play::create((*land)->world, (*land)->registry);
  ASSERT_TRUE(play) << play.error().message;
  Pilot pilot(**play);
  int counts[16] = {};
  int gaits[5] = {};
  for (int k = 0; k < kMostMinutes * 3600 && !(*play)->is_finished(); ++k) {
    (*play)->step(pilot.steer(kStep), kStep);
    ++gaits[static_cast<int>((*play)->walker().gait())];
    for (const Happening& h : (*play)->take_happenings()) {
      ++counts[static_cast<int>(h.kind)];
      if (h.kind == Happening::Kind::kFound)
        std::printf("%.0f s: cairn %zu, height %.0f m\n", k * kStep, h.number, h.at.local.y);
    }
    const auto& feet = (*play)->walker().feet();
    const auto ground = (*play)->query().ground(feet);
    ASSERT_TRUE(ground);
    ASSERT_GE(feet.local.y, ground->height_m - 1e-4);
  }
  std::printf(
      "gathered %d felled %d built %d lit %d slept %d landed %d splashed %d refused %d; way %.0f "
      "m; gaits",
      counts[1], counts[3], counts[4], counts[5], counts[6], counts[9], counts[10], counts[7],
      (*play)->walker().walked_m());
  for (int g : gaits)
    std::printf(" %.0f", g * kStep);
  std::printf("\n");
  EXPECT_TRUE((*play)->is_finished());
}

}  // namespace
}  // namespace cairns
