#include "engine/frametest/judge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace psygen::frametest {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// What one made-up run measured.
struct Measured {
  double p99_ms = 20;
  double cpu_s = 2;
  double pair_s = 0.2;  // 0: no reference load
  double others_cores = 0;
};

RunFields fields_of(const Measured& measured) {
  telemetry::Summary summary;
  summary.frame_ms.p99 = measured.p99_ms;
  summary.low1_fps = 1000 / measured.p99_ms;
  summary.missing.frames = 2u;
  summary.load.cpu_seconds = measured.cpu_s;
  summary.load.others_cores = measured.others_cores;
  summary.machine.cores = 4;
  if (measured.pair_s > 0) summary.reference.pair = {measured.pair_s, 2 * measured.pair_s};
  summary.world.name = "paper";
  return telemetry::summary_fields(summary);
}

constexpr Relation kAtMost = Relation::kAtMost, kAtLeast = Relation::kAtLeast;

Budget p99_at_most(double limit) {
  return {"frame_ms.p99", kAtMost, limit, 1};
}

UsualLoad usual(double pair_s, double cpu_s) {
  UsualLoad load;
  if (pair_s > 0) load.pair_s = pair_s;
  if (cpu_s > 0) load.cpu_s = cpu_s;
  load.source = "the base";
  return load;
}

BudgetResult judged(const Budget& budget, const std::vector<Measured>& measured,
                    const UsualLoad& load = {}, std::size_t attempt_runs = 1) {
  std::vector<RunFields> runs;
  for (const Measured& each : measured)
    runs.push_back(fields_of(each));
  return judge({&budget, 1}, {runs, attempt_runs, false, load}).at(0);
}

TEST(JudgeRuns, TakesTheMedianAndShowsAllRuns) {
  const BudgetResult result =
      judged(p99_at_most(25), {{.p99_ms = 40}, {.p99_ms = 24}, {.p99_ms = 23}}, {}, 3);
  EXPECT_TRUE(result.holds);
  EXPECT_EQ(result.value, "24");
  EXPECT_THAT(result.runs, ElementsAre("40", "24", "23"));
  EXPECT_THAT(result.notes, IsEmpty());
  EXPECT_THAT(judged(p99_at_most(25), {{}}).runs, IsEmpty()) << "one run is the value";
}

TEST(JudgeRuns, NeedTheValueAndTheTextInEachRun) {
  std::vector<RunFields> runs{fields_of({}), fields_of({})};
  std::erase_if(runs[1], [](const auto& field) { return field.name == "frame_ms.p99"; });
  const std::vector<Budget> budgets{p99_at_most(1000),
                                    {"world.name", Relation::kEqual, "paper", 2},
                                    {"missing.frames", Relation::kEqual, 2.0, 3},
                                    {"missing.frames", Relation::kEqual, 3.0, 4}};
  const auto results = judge(budgets, {runs, 2, false, {}});
  EXPECT_FALSE(results[0].holds);
  EXPECT_EQ(results[0].value, "the run has no such field");
  EXPECT_TRUE(results[1].holds);
  EXPECT_TRUE(results[2].holds);
  EXPECT_TRUE(results[3].misses());
}

TEST(JudgeRuns, AnotherAttemptMayHold) {
  const std::vector<Measured> slow(3, {.p99_ms = 30}), fast(3, {.p99_ms = 20});
  std::vector<Measured> all = slow;
  all.insert(all.end(), fast.begin(), fast.end());
  const BudgetResult result = judged(p99_at_most(25), all, {}, 3);
  EXPECT_TRUE(result.holds);
  EXPECT_EQ(result.value, "20");
  EXPECT_EQ(result.runs.size(), 6u);
  const BudgetResult missed = judged(p99_at_most(15), all, {}, 3);
  EXPECT_TRUE(missed.misses());
  EXPECT_EQ(missed.value, "20") << "of the last attempt";
}

TEST(JudgeRuns, AnotherAttemptIsOnlyForValuesThatDependOnLoad) {
  const auto results = [](const char* field) {
    return std::vector{BudgetResult{{field, kAtMost, 1.0, 1}, "2", false}};
  };
  EXPECT_TRUE(may_change(results("frame_ms.p99"), false));
  EXPECT_TRUE(may_change(results("missing.frames"), false));
  EXPECT_FALSE(may_change(results("hash.world"), false));
  EXPECT_FALSE(may_change(results("frame_ms.p99"), true)) << "virtual runs are equal";
  EXPECT_TRUE(may_change(results("load.cpu_seconds"), true)) << "processor time is real";
}

TEST(JudgeRuns, ScaleLimitsOfTimesByTheReferenceLoad) {
  const UsualLoad load = usual(0.2, 0);
  const BudgetResult held = judged(p99_at_most(25), {{.p99_ms = 30, .pair_s = 0.25}}, load);
  EXPECT_TRUE(held.holds) << "1.25 × 25 = 31.25";
  EXPECT_THAT(held.notes,
              ElementsAre("Held by the scaled limit 31.25: the reference load took 1.25 "
                          "times its usual time (the base)."));
  EXPECT_TRUE(judged(p99_at_most(25), {{.p99_ms = 32, .pair_s = 0.25}}, load).misses());
  EXPECT_TRUE(judged(p99_at_most(25), {{.p99_ms = 26, .pair_s = 0.1}}, load).misses())
      << "a fast machine makes no limit smaller";
  EXPECT_TRUE(judged(p99_at_most(25), {{.p99_ms = 24, .pair_s = 0.1}}, load).holds);
  const Budget low{"low1_fps", kAtLeast, 40.0, 1};
  EXPECT_TRUE(judged(low, {{.p99_ms = 30, .pair_s = 0.25}}, load).holds) << "40 ÷ 1.25 = 32";
  const Budget holes{"missing.frames", kAtMost, 1.9, 1};
  EXPECT_TRUE(judged(holes, {{.pair_s = 0.25}}, load).misses()) << "no time: not scaled";
}

TEST(JudgeRuns, AreNotJudgedOnABusyMachine) {
  const UsualLoad load = usual(0.2, 2);
  const BudgetResult busy = judged(p99_at_most(25), {{.p99_ms = 30, .pair_s = 0.31}}, load);
  EXPECT_FALSE(busy.holds);
  EXPECT_FALSE(busy.judged);
  EXPECT_FALSE(busy.misses());
  EXPECT_THAT(busy.notes,
              ElementsAre("The machine was busy: the reference load took 1.55 times its "
                          "usual time (the base)."));
  EXPECT_TRUE(judged(p99_at_most(25), {{.p99_ms = 24, .pair_s = 0.9}}, load).holds)
      << "a limit that holds needs no excuse";
  const Budget holes{"missing.frames", kAtMost, 1.9, 1},
      hash{"hash.world", Relation::kEqual, "x", 1};
  EXPECT_FALSE(judged(holes, {{.pair_s = 0.31}}, load).judged);
  EXPECT_TRUE(judged(hash, {{.pair_s = 0.31}}, load).misses()) << "load changes no hash";
}

TEST(JudgeRuns, AJudgedMissOutweighsAnAttemptThatIsNotJudged) {
  const UsualLoad load = usual(0.2, 2);
  const Measured busy{.p99_ms = 60, .pair_s = 0.5}, calm{.p99_ms = 30, .pair_s = 0.2};
  EXPECT_TRUE(judged(p99_at_most(25), {busy, calm}, load).misses());
  EXPECT_TRUE(judged(p99_at_most(25), {calm, busy}, load).misses());
  EXPECT_FALSE(judged(p99_at_most(25), {busy, busy}, load).judged);
}

TEST(JudgeRuns, WithoutAReferenceLoadNeedProcessorTimeAsAWitness) {
  const Measured slow{.p99_ms = 30, .cpu_s = 2.05, .pair_s = 0},
      heavy{.p99_ms = 30, .cpu_s = 2.2, .pair_s = 0};
  const UsualLoad load = usual(0, 2);
  const BudgetResult waiting = judged(p99_at_most(25), {slow}, load);
  EXPECT_FALSE(waiting.judged);
  EXPECT_THAT(waiting.notes.at(0), HasSubstr("(+2.5 %; the base), reference load unknown."));
  EXPECT_TRUE(judged(p99_at_most(25), {heavy}, load).misses());
  Budget alone = p99_at_most(25);
  alone.needs_witness = false;
  EXPECT_TRUE(judged(alone, {slow}, load).misses());
  EXPECT_TRUE(judged(p99_at_most(25), {slow}).misses()) << "nothing is known of the machine";
}

TEST(JudgeRuns, NeedProcessorTimeAsAWitnessWhereTheMachineWasSlower) {
  const UsualLoad load = usual(0.2, 2);
  const Measured slower{.p99_ms = 40, .cpu_s = 2, .pair_s = 0.25};
  const BudgetResult result = judged(p99_at_most(25), {slower}, load);
  EXPECT_FALSE(result.judged);
  EXPECT_THAT(result.notes,
              ElementsAre("Only the wall clock rose, and the machine may be to blame: processor "
                          "time 2 s, usually 2 s (+0.0 %; the base), reference load 1.25 times its "
                          "usual time."));
  Measured heavy = slower, calm = slower;
  heavy.cpu_s = 2.2;
  calm.pair_s = 0.21;
  EXPECT_TRUE(judged(p99_at_most(25), {heavy}, load).misses());
  EXPECT_TRUE(judged(p99_at_most(25), {calm}, load).misses()) << "waiting on a calm machine";
  Budget alone = p99_at_most(25);
  alone.needs_witness = false;
  EXPECT_TRUE(judged(alone, {slower}, load).misses());
}

TEST(JudgeRuns, NeedProcessorTimeAsAWitnessBesideOtherPrograms) {
  const UsualLoad load = usual(0.2, 2);
  const Measured beside{.p99_ms = 40, .cpu_s = 1.5, .pair_s = 0.21, .others_cores = 0.8};
  const BudgetResult result = judged(p99_at_most(25), {beside}, load);
  EXPECT_FALSE(result.judged);
  EXPECT_THAT(result.notes.at(0), HasSubstr("1.05 times its usual time, other programs used 20 % "
                                            "of the processors."));
  Measured heavy = beside, alone = beside;
  heavy.cpu_s = 2.2;
  alone.others_cores = 0.4;
  EXPECT_TRUE(judged(p99_at_most(25), {heavy}, load).misses());
  EXPECT_TRUE(judged(p99_at_most(25), {alone}, load).misses()) << "a tenth of four processors";
  const RunFields busy_run = fields_of(beside), calm_run = fields_of(alone);
  EXPECT_FALSE(is_calm({&busy_run, 1}, load));
  EXPECT_TRUE(is_calm({&calm_run, 1}, load));
}

TEST(JudgeRuns, AreNotJudgedIfABusyMachineLeftTooFewFrames) {
  const auto with_few_frames = [](double pair_s) {
    RunFields fields = fields_of({.pair_s = pair_s});
    const auto field =
        std::ranges::find(fields, std::string("frame_ms.p99"), &telemetry::SummaryField::name);
    field->value = std::monostate();
    field->reason = "needs at least 100 values, there are 97";
    return fields;
  };
  const Budget budget = p99_at_most(25);
  const auto result = [&](double pair_s) {
    const std::vector<RunFields> runs{with_few_frames(pair_s)};
    return judge({&budget, 1}, {runs, 1, false, usual(0.2, 2)}).at(0);
  };
  EXPECT_FALSE(result(0.4).judged);
  EXPECT_TRUE(result(0.2).misses()) << "on a calm machine the flight is too short";
}

TEST(JudgeRuns, SayWhetherProcessorTimeRoseToo) {
  const std::vector<Measured> heavy(3, {.p99_ms = 30, .cpu_s = 2.4});
  const std::vector<Measured> slow(3, {.p99_ms = 30, .cpu_s = 2.02});
  EXPECT_THAT(judged(p99_at_most(25), heavy, usual(0.2, 2), 3).notes.at(0),
              "Processor time rose too: processor time 2.4 s, usually 2 s (+20.0 %; the base).");
  EXPECT_THAT(judged(p99_at_most(25), slow, usual(0.2, 2), 3).notes.at(0),
              "Only the wall clock rose: processor time 2.02 s, usually 2 s (+1.0 %; the base).");
  EXPECT_THAT(judged(p99_at_most(25), slow, {}, 3).notes.at(0),
              HasSubstr("Whether processor time rose too is unknown"));
}

TEST(JudgeRuns, TellTheChanceOfAFalseAlarm) {
  const std::vector<Measured> runs{{.p99_ms = 29}, {.p99_ms = 30}, {.p99_ms = 31}};
  EXPECT_THAT(judged(p99_at_most(25), runs, {}, 3).notes.at(1),
              HasSubstr("Chance of a false alarm: 0.55 %, by a t test of 3 runs"));
  EXPECT_THAT(judged(p99_at_most(25), {{.p99_ms = 30}}).notes.at(1),
              "Chance of a false alarm: unknown; fewer than 3 runs show no scatter.");
}

// Values of P(T > t) from tables of Student's distribution.
TEST(FalseAlarms, HaveTheChanceOfStudentsTest) {
  const auto chance = [](std::vector<double> values, double limit) {
    return *false_alarm_chance(values, kAtMost, limit);
  };
  // Differences with mean m and error e: t = m / e. Not positive, so no logarithms.
  EXPECT_NEAR(chance({-1, 0, 1}, -1.0), 0.1127, 1e-4) << "t 1.732, 2 degrees";
  EXPECT_NEAR(chance({-2, 0, 0, 2}, -2.353 * std::sqrt(8.0 / 12)), 0.05, 1e-4) << "3 degrees";
  EXPECT_NEAR(chance({-2, -1, 0, 1, 2}, -2.132 * std::sqrt(0.5)), 0.05, 1e-4) << "4 degrees";
  EXPECT_NEAR(chance({-1, 0, 1}, 0.0), 0.5, 1e-12);
  EXPECT_GT(chance({-1, 0, 1}, 1.0), 0.5) << "the mean holds";
  EXPECT_EQ(chance({3, 3, 3}, 2.0), 0.0);
  EXPECT_NEAR(chance({std::exp(1.0), std::exp(2.0), std::exp(3.0)}, std::exp(1.0)), 0.1127, 1e-4)
      << "logarithms of positive values";
  EXPECT_NEAR(*false_alarm_chance(std::vector<double>{-1, 0, 1}, kAtLeast, 1.0), 0.1127, 1e-4);
  EXPECT_FALSE(false_alarm_chance(std::vector<double>{1, 2}, kAtMost, 0.5).has_value());
}

TEST(WallTimes, AreRecognisedByTheirNames) {
  for (const char* field :
       {"frame_ms.p99", "low1_fps", "system_ms.cache.p50", "wait_ms.p99",
        "missing.time_to_visible_ms.p99", "run.real_seconds", "sections.boss.low1_fps",
        "sections.boss.frame_ms.p99", "figures.pathfinding_ms.p99", "figures.gpu_ms.p50"})
    EXPECT_TRUE(is_wall_time(field)) << field;
  for (const char* field :
       {"gpu_ms.p99", "missing.frames", "hitches", "load.cpu_seconds", "frame_msx.p99",
        "memory.peak_rss_bytes", "sections.boss.gpu_ms.p99", "sections.boss.pass_ms.sky.max",
        "figures.pathfinding_ms.frames", "figures.units.p50"})
    EXPECT_FALSE(is_wall_time(field)) << field;
}

}  // namespace
}  // namespace psygen::frametest
