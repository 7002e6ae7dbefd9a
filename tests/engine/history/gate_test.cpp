#include "engine/history/gate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/engine/history/corpus.hpp"

namespace psygen::history {
namespace {

using ::testing::HasSubstr;

const FigureRule kCpu = rule_of("load.cpu_seconds", "s");
const FigureRule kInstructions = rule_of("instructions", "");

std::vector<Observation> runs(const std::vector<double>& values) {
  std::vector<Observation> result;
  for (const double value : values)
    result.push_back({.value = value, .reference = {}, .work = {}});
  return result;
}

// `count` values about `middle` that differ by thousandths.
std::vector<Observation> quiet(double middle, std::size_t count, double reference = 0) {
  std::vector<Observation> result;
  for (std::size_t i = 0; i < count; ++i) {
    const double noise = 1 + 0.001 * static_cast<double>(i * 7 % 5);
    result.push_back({.value = middle * noise, .reference = {}, .work = {}});
    if (reference > 0)
      result.back().reference = reference * (1 + 0.0001 * static_cast<double>(i % 3));
  }
  return result;
}

GateVerdict judged(const FigureRule& rule, const std::vector<Observation>& before,
                   const std::vector<Observation>& after, std::size_t figures = 1) {
  RankTails tails;
  return judge(rule, before, after, figures, tails);
}

TEST(Gate, FiveRunsOfEachFindFivePercentOfInstructions) {
  std::mt19937_64 random(3);
  int worse = 0, alarms = 0;
  for (int i = 0; i < 100; ++i) {
    // callgrind's runs of one program differ by 0.005 %.
    const auto count = [&](double change) {
      std::vector<double> values;
      for (int run = 0; run < 5; ++run)
        values.push_back(67.8e6 * change *
                         (1 + 5e-5 * (static_cast<double>(random() % 2001) / 1000 - 1)));
      return runs(values);
    };
    worse += judged(kInstructions, count(1), count(1.05)).outcome == Outcome::kWorse ? 1 : 0;
    alarms += judged(kInstructions, count(1), count(1)).outcome != Outcome::kSame ? 1 : 0;
  }
  EXPECT_GE(worse, 99);
  EXPECT_EQ(alarms, 0);
}

// Entries of 3 runs apart, resampled from runs of identical bytes; both witnesses.
struct Rates {
  int worse = 0, checks = 0;
};
Rates resampled(const std::map<std::string, std::vector<double>>& columns, double step) {
  std::mt19937_64 random(5);
  const auto& cpu = columns.at("cpu_s");
  RankTails tails;
  Rates rates;
  for (; rates.checks < 500; ++rates.checks) {
    const auto entry = [&](double change) {
      std::vector<double> values, references;
      for (int run = 0; run < 3; ++run) {
        const std::size_t i = random() % cpu.size();
        values.push_back(cpu[i] * change);
        references.push_back(columns.at("ref_arith_cpu")[i] + columns.at("ref_stream_cpu")[i] +
                             columns.at("ref_pair_cpu")[i]);
      }
      return Observation{.value = median(values), .reference = median(references), .work = {}};
    };
    std::vector<Observation> before, after;
    for (int i = 0; i < 20; ++i)
      before.push_back(entry(1));
    for (int i = 0; i < 5; ++i)
      after.push_back(entry(1 + step));
    rates.worse += judge(kCpu, before, after, 1, tails).outcome == Outcome::kWorse ? 1 : 0;
  }
  return rates;
}

TEST(Gate, TwentyEntriesBeforeFindTenPercentOfProcessorTime) {
  const auto loads = testing::real_runs();
  for (const char* load : {"quiet-virtual", "busy-virtual"}) {
    const Rates changed = resampled(loads.at(load), 0.10), same = resampled(loads.at(load), 0);
    EXPECT_GE(changed.worse * 100, 80 * changed.checks) << load;
    EXPECT_LE(same.worse * 100, same.checks) << load;
  }
}

TEST(Gate, ASlowerMachineIsNotWorse) {
  // The figure and the reference load rise together.
  const GateVerdict verdict = judged(kCpu, quiet(1, 20, 0.5), quiet(1.2, 5, 0.6));
  EXPECT_EQ(verdict.outcome, Outcome::kUndecided);
  EXPECT_THAT(verdict.reason, HasSubstr("not as ratio to the reference load"));
}

TEST(Gate, ARatioAloneIsNotWorse) {
  const GateVerdict verdict = judged(kCpu, quiet(1, 20, 0.6), quiet(1, 5, 0.5));
  EXPECT_EQ(verdict.outcome, Outcome::kUndecided);
  EXPECT_THAT(verdict.reason, HasSubstr("only the ratio to the reference load changed"));
}

TEST(Gate, TwoWitnessesAreWorse) {
  const GateVerdict verdict = judged(kCpu, quiet(1, 20, 0.5), quiet(1.2, 5, 0.5));
  EXPECT_EQ(verdict.outcome, Outcome::kWorse);
  EXPECT_THAT(verdict.reason, HasSubstr("+20.0 %"));
  EXPECT_THAT(verdict.reason, HasSubstr("one look"));
}

TEST(Gate, AMissingReferenceIsSaid) {
  const GateVerdict none = judged(kCpu, quiet(1, 20), quiet(1.2, 5));
  EXPECT_EQ(none.outcome, Outcome::kWorse);
  EXPECT_THAT(none.reason, HasSubstr("no reference load was recorded"));
  const GateVerdict some = judged(kCpu, quiet(1, 20), quiet(1.2, 5, 0.5));
  EXPECT_EQ(some.outcome, Outcome::kUndecided) << "references of one side confirm nothing";
}

TEST(Gate, FasterIsBetter) {
  EXPECT_EQ(judged(kCpu, quiet(1, 20, 0.5), quiet(0.8, 5, 0.5)).outcome, Outcome::kBetter);
  const FigureRule rate = rule_of("low1_fps", "frames/s");
  EXPECT_EQ(judged(rate, quiet(60, 20), quiet(40, 5)).outcome, Outcome::kWorse);
  EXPECT_EQ(judged(rate, quiet(60, 20), quiet(90, 5)).outcome, Outcome::kBetter);
}

TEST(Gate, FewRunsAreTooFew) {
  const GateVerdict verdict = judged(kCpu, quiet(1, 20), quiet(2, 4));
  EXPECT_EQ(verdict.outcome, Outcome::kTooFew);
  EXPECT_THAT(verdict.reason, HasSubstr("20 before and 4 of this revision; each side needs 5"));
}

TEST(Gate, OtherWorkIsNotCompared) {
  auto before = quiet(1, 10), after = quiet(1.5, 5);
  for (auto& run : before)
    run.work = 1000;
  for (auto& run : after)
    run.work = 1030;
  EXPECT_EQ(judged(kCpu, before, after).outcome, Outcome::kDifferentWork);
  for (auto& run : after)
    run.work = 1015;
  EXPECT_EQ(judged(kCpu, before, after).outcome, Outcome::kWorse);
}

TEST(Gate, ASecondLookMustAgree) {
  auto after = quiet(1.2, 5);
  const auto back = quiet(1, 5);
  after.insert(after.end(), back.begin(), back.end());
  const GateVerdict verdict = judged(kInstructions, quiet(1, 20), after);
  EXPECT_EQ(verdict.outcome, Outcome::kUndecided);
  EXPECT_EQ(verdict.looks, 2);
  EXPECT_THAT(verdict.reason, HasSubstr("do not agree"));
  EXPECT_EQ(judged(kInstructions, quiet(1, 20), quiet(1.2, 10)).outcome, Outcome::kWorse);
}

TEST(Gate, OnlyEntriesAfterTheLastChangeCount) {
  auto before = quiet(1.3, 15);
  const auto recent = quiet(1, 15);
  before.insert(before.end(), recent.begin(), recent.end());
  const GateVerdict verdict = judged(kInstructions, before, quiet(1.1, 5));
  EXPECT_EQ(verdict.outcome, Outcome::kWorse) << "1.1 is below the median of all";
  EXPECT_EQ(verdict.before, 15U);
}

TEST(Gate, NoiseIsUndecidedWithTheStepThatWouldStayUnseen) {
  const FigureRule wall = rule_of("frame_ms.p99", "ms");
  const GateVerdict noisy = judged(wall, runs({9, 11, 8, 12, 10, 9.5, 12.5, 7.5, 10.5, 11.5}),
                                   runs({10, 12, 8.5, 9, 11}));
  EXPECT_EQ(noisy.outcome, Outcome::kUndecided);
  EXPECT_THAT(noisy.reason, HasSubstr("would stay unseen"));
  EXPECT_EQ(judged(wall, quiet(10, 10), quiet(10, 5)).outcome, Outcome::kSame);
}

TEST(Gate, ManyFiguresNeedSmallerP) {
  // 25 runs, the new ones above all but one old one: p = 4 / 53130.
  auto before = quiet(1, 20);
  before[3].value = 1.3;
  EXPECT_EQ(judged(kInstructions, before, quiet(1.2, 5), 1).outcome, Outcome::kWorse);
  EXPECT_NE(judged(kInstructions, before, quiet(1.2, 5), 2000).outcome, Outcome::kWorse);
}

}  // namespace
}  // namespace psygen::history
