#include "engine/history/scan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "engine/history/check.hpp"
#include "tests/engine/history/corpus.hpp"

namespace psygen::history {
namespace {

using Random = std::mt19937_64;

// std::normal_distribution differs between libraries.
double normal(Random& random) {
  const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53; };
  const double radius = std::sqrt(-2 * std::log(uniform()));
  return radius * std::cos(2 * 3.14159265358979323846 * uniform());
}
double uniform(Random& random) {
  return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53;
}

using Maker = std::function<double(Random&, std::size_t run)>;

// Series of 1,000 that have a change.
int alarms(const std::function<Maker()>& make, std::size_t runs, double floor = 0) {
  Random random(42);
  RankTails tails;
  int count = 0;
  for (int i = 0; i < 1000; ++i) {
    std::vector<double> series;
    const Maker next = make();
    for (std::size_t run = 0; run < runs; ++run)
      series.push_back(next(random, run));
    count += change_points(series, floor, tails).empty() ? 0 : 1;
  }
  return count;
}

Maker normals() {
  return [](Random& random, std::size_t) { return normal(random); };
}
// Student's t with 3 degrees of freedom.
Maker tailed() {
  return [](Random& random, std::size_t) {
    double squares = 0;
    for (int i = 0; i < 3; ++i)
      squares += std::pow(normal(random), 2);
    return normal(random) / std::sqrt(squares / 3);
  };
}
Maker delayed() {
  return [](Random& random, std::size_t) {
    const double delay = uniform(random) < 0.08 ? -2.5 * std::log(uniform(random)) : 0;
    return 0.6 * normal(random) + delay;
  };
}
// Two levels 1.7 apart that change with 0.2 a run.
Maker spells() {
  return [level = -1](Random& random, std::size_t) mutable {
    if (level < 0)
      level = uniform(random) < 0.5 ? 1 : 0;
    else if (uniform(random) < 0.2)
      level = 1 - level;
    return 0.5 * normal(random) + 1.7 * level;
  };
}
Maker correlated() {
  return [last = 0.0](Random& random, std::size_t run) mutable {
    return last = run == 0 ? normal(random) : 0.6 * last + 0.8 * normal(random);
  };
}
Maker drift() {
  return [](Random& random, std::size_t run) {
    return normal(random) + 2 * static_cast<double>(run) / 39;
  };
}

TEST(Scan, ExchangeableSeriesHaveAChangeInOneOfAHundredAtMost) {
  for (const std::size_t runs : {40U, 60U}) {
    EXPECT_LE(alarms(normals, runs), 10) << runs;
    EXPECT_LE(alarms(tailed, runs), 10) << runs;
    EXPECT_LE(alarms(delayed, runs), 10) << runs;
  }
}

// The limits that docs/frame-tests.md states.
TEST(Scan, SpellsCorrelationAndDriftAreLimits) {
  const int of_spells = alarms(spells, 40), of_correlated = alarms(correlated, 40),
            of_drift = alarms(drift, 40);
  EXPECT_NEAR(of_spells, 120, 30);
  EXPECT_NEAR(of_correlated, 90, 30);
  EXPECT_NEAR(of_drift, 340, 60);
}

TEST(Scan, TooFewRunsHaveNoChange) {
  RankTails tails;
  EXPECT_TRUE(change_points(std::vector<double>{1, 1, 1, 1, 9, 9, 9, 9, 9}, 0.1, tails).empty());
  EXPECT_TRUE(change_points({}, 0.1, tails).empty());
}

TEST(Scan, SeriesWithoutScatterHaveNoChangeAndClearSteps) {
  RankTails tails;
  std::vector<double> values(30, 5.0);
  EXPECT_TRUE(change_points(values, 0.01, tails).empty());
  std::fill(values.begin() + 12, values.end(), 6.0);
  const auto changes = change_points(values, 0.01, tails);
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].at, 12U);
  EXPECT_DOUBLE_EQ(changes[0].effect, 1);
}

TEST(Scan, LongSeriesAreScannedInWindowsWithoutSeams) {
  Random random(7);
  RankTails tails;
  for (const std::size_t step : {300U, 315U, 330U, 345U, 359U}) {
    std::vector<double> values;
    for (std::size_t run = 0; run < 1000; ++run)
      values.push_back(0.1 * normal(random) + (run >= step ? 1 : 0));
    const auto changes = change_points(values, 0.5, tails);
    ASSERT_EQ(changes.size(), 1U) << step;
    EXPECT_NEAR(static_cast<double>(changes[0].at), static_cast<double>(step), 2);
    EXPECT_NEAR(changes[0].effect, 1, 0.1);
  }
}

// Resampled runs of identical bytes: each series is 40 runs apart.
TEST(Scan, RealRunsApartHaveAChangeInOneOfAHundredAtMost) {
  for (const auto& [load, columns] : testing::real_runs()) {
    const auto& cpu = columns.at("cpu_s");
    Random random(11);
    RankTails tails;
    int found = 0;
    for (int i = 0; i < 200; ++i) {
      std::vector<double> series;
      for (int run = 0; run < 40; ++run)
        series.push_back(std::log(cpu[random() % cpu.size()]));
      found += change_points(series, std::log(1.03), tails).empty() ? 0 : 1;
    }
    EXPECT_LE(found, 2) << load;
  }
}

// An answer of answers.csv: runs at which the figure changes, and by how many per cent.
struct Answer {
  std::string series, right;
  std::vector<std::pair<int, double>> changes;
};
const std::vector<Answer> kAnswers = {
    {"identical_normal", "none", {}},
    {"identical_tailed", "none", {}},
    {"identical_two_modes", "none", {}},
    {"machine_slows_with_reference", "none", {}},
    {"cpu_5_percent_20_and_5", "20 +5.0", {{20, 5}}},
    {"cpu_5_percent_5_and_5", "5 +5.0", {{5, 5}}},
    {"wall_15_percent_20_and_20", "20 +15.0", {{20, 15}}},
    {"wall_15_percent_lost_in_noise", "undecided", {}},
    {"better_10_percent", "25 -10.0", {{25, -10}}},
    {"two_steps", "20 +8.0; 40 +8.0", {{20, 8}, {40, 8}}},
    {"up_and_back", "15 +10.0; 35 -9.1", {{15, 10}, {35, -9.1}}},
    {"three_delayed_runs", "none", {}},
    {"too_few_4_and_4", "too few runs", {}},
    {"only_3_runs_after", "none yet: 3 runs after", {}},
    {"missing_values", "23 +10.0; 6 runs without a value", {{23, 10}}},
    {"two_machines", "none in m1; none in m2; never joined", {}},
    {"machine_replaced", "none in m1; none in m2; never joined", {}},
    {"instructions_constant", "none", {}},
    {"instructions_half_percent", "\"15 +0.5 shown, under the floor of 1 %: not red\"", {}},
    {"instructions_5_percent_5_and_5", "5 +5.0", {{5, 5}}},
    {"clock_goes_back", "12 +8.0 in the order of adding; the clock is named", {{12, 8}}},
    {"unit_changes", "\"refused: ms, then s\"", {}},
    {"counts_identical", "none", {}},
};

TEST(Scan, FindsTheRightChangesOfTheCorpus) {
  const std::vector<Entry> entries = testing::corpus();
  const std::vector<Series> all = series_of(entries);
  const std::string answers = testing::text_of("answers.csv");
  RankTails tails;
  for (const Answer& answer : kAnswers) {
    EXPECT_NE(answers.find("\n" + answer.series + ","), std::string::npos);
    EXPECT_NE(answers.find("," + answer.right + "\n"), std::string::npos) << answer.series;
    bool seen = false;
    for (const Series& series : all) {
      if (series.first->test != answer.series) continue;
      seen = true;
      const auto changes = changes_of(series, tails);
      ASSERT_EQ(changes.size(), answer.changes.size()) << answer.series;
      const std::int64_t first = std::ranges::min(entries, {}, [&](const Entry& e) {
                                   return e.test == answer.series ? e.order : INT64_MAX;
                                 }).order;
      for (std::size_t i = 0; i < changes.size(); ++i) {
        const auto run = series.entries[changes[i].at]->order - first;
        EXPECT_NEAR(static_cast<double>(run), answer.changes[i].first, 2) << answer.series;
        EXPECT_NEAR(100 * std::expm1(changes[i].effect), answer.changes[i].second, 3)
            << answer.series;
      }
    }
    EXPECT_TRUE(seen) << answer.series;
  }
}

TEST(Scan, ARampHasStepsUpwardOnly) {
  const std::vector<Entry> entries = testing::corpus();
  RankTails tails;
  for (const Series& series : series_of(entries)) {
    const bool counts = series.first->test == "counts_more";
    if (series.first->test != "slow_ramp" && !counts) continue;
    const auto changes = changes_of(series, tails);
    for (const ChangePoint& change : changes)
      EXPECT_GT(change.effect, 0);
    if (!counts) continue;
    ASSERT_EQ(changes.size(), 1U);
    EXPECT_EQ(changes[0].at, 20U);
    EXPECT_NEAR(changes[0].effect, 5, 1.5);
  }
}

}  // namespace
}  // namespace psygen::history
