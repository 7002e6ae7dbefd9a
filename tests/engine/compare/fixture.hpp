// Synthetic runs of two sides, the same each time, for the tests of comparisons.
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "engine/compare/compare.hpp"

namespace psygen::compare {

using Runs = std::vector<RecordedRun>;

// A run of 120 frames whose times have noise of up to `noise`, as from other programs.
inline RecordedRun make_run(std::mt19937& random, double factor = 1, double noise = 0.3) {
  RecordedRun run;
  run.folder = "run";
  run.required = {{"world hash", "00ab"}, {"size", "640x360"}, {"CPU", "old"}};
  run.shown = {{"revision", "1234"}, {"load before", "0.5"}};
  run.fixed_step = 30;
  run.width = 640;
  run.height = 360;
  run.error_pixels = 4;
  for (int k = 0; k < 120; ++k) {
    const double share = static_cast<double>(random() % 1000) / 1000;
    run.time_s.push_back(k / 30.0);
    run.frame_ms.push_back(factor * (10 + k % 5) * (1 + noise * share * share));
    run.cpu_ms.push_back(0.7 * factor * (10 + k % 5) * (1 + 0.02 * share));
    run.lacking.push_back(0);
    run.error.push_back(4);
    run.left_out.push_back(false);
  }
  return run;
}

struct Sets {
  Runs a, b;
};

template <class Change>
Sets make_sets(std::size_t pairs, const Change& change, double factor = 1, double noise = 0.3) {
  std::mt19937 random(7);
  Sets sets;
  for (std::size_t i = 0; i < pairs; ++i) {
    sets.a.push_back(make_run(random, 1, noise));
    sets.b.push_back(make_run(random, factor, noise));
    change(sets.b.back(), random);
  }
  return sets;
}

inline constexpr auto kNothing = [](RecordedRun&, std::mt19937&) {};

inline Comparison judged(const Sets& sets) {
  const auto result = compare(sets.a, sets.b);
  EXPECT_TRUE(result) << result.error().message;
  return result ? *result : Comparison{};
}

}  // namespace psygen::compare
