#include "engine/telemetry/reference_load.hpp"

#include <gtest/gtest.h>

#include "engine/telemetry/summary.hpp"
#include "tests/engine/telemetry/synthetic_flight.hpp"

namespace psygen::telemetry {
namespace {

// Times depend on the machine, so tests only expect that they were measured.
TEST(ReferenceLoad, MeasuresWallAndProcessorTimeOfThreeParts) {
  const ReferenceLoad load = measure_reference_load(
      {.steps = 2'000'000, .copy_bytes = 1 << 20, .copies = 4, .threads = 8});
  for (const LoadTimes& part : {load.arith, load.stream, load.pair}) {
    ASSERT_TRUE(part.wall_s.has_value()) << part.wall_s.reason;
    EXPECT_GT(*part.wall_s, 0);
    EXPECT_GT(*part.cpu_s, 0);
  }
  EXPECT_GT(*load.pair.cpu_s, *load.arith.cpu_s) << "eight threads do the work eight times";
  EXPECT_DOUBLE_EQ(*cpu_seconds_of(load),
                   *load.arith.cpu_s + *load.stream.cpu_s + *load.pair.cpu_s);
}

TEST(ReferenceLoad, IsMissingWithAReasonIfThereIsNoMemory) {
  const ReferenceLoad load = measure_reference_load(
      {.steps = 1, .copy_bytes = std::uint64_t{1} << 60, .copies = 1, .threads = 1});
  EXPECT_EQ(load.stream.wall_s.reason, "memory ran out");
  EXPECT_TRUE(load.arith.wall_s.has_value());
  EXPECT_EQ(cpu_seconds_of(load).reason, "memory ran out");
}

TEST(ReferenceLoad, IsTheMeanOfBeforeAndAfter) {
  ReferenceLoad before, after;
  before.pair = {1.0, 2.0};
  after.pair = {2.0, 2.5};
  after.arith = {1.0, 1.0};
  const ReferenceLoad mean = mean_of(before, after);
  EXPECT_EQ(*mean.pair.wall_s, 1.5);
  EXPECT_EQ(*mean.pair.cpu_s, 2.25);
  EXPECT_FALSE(mean.arith.wall_s.has_value()) << "not measured before";
}

TEST(ReferenceLoad, GivesRatiosOfFigures) {
  RunFacts facts = synthetic_facts();
  facts.load.cpu_seconds = 6.0;
  Summary summary = summarise(synthetic_flight(), facts, 1.0);
  EXPECT_EQ(reference_ratios(summary).cpu.reason, "not measured in this run");
  EXPECT_EQ(to_text(summary).find("\nreference "), std::string::npos);
  facts.reference.arith = {0.5, 0.5};
  facts.reference.stream = {0.25, 0.25};
  facts.reference.pair = {0.6, 1.25};
  summary = summarise(synthetic_flight(), facts, 1.0);
  const ReferenceRatios ratios = reference_ratios(summary);
  EXPECT_DOUBLE_EQ(*ratios.cpu, 3.0);
  EXPECT_DOUBLE_EQ(*ratios.frame_p50, *summary.frame_ms.p50 * 1e-3 / 0.6);
  EXPECT_DOUBLE_EQ(*ratios.frame_p99, *summary.frame_ms.p99 * 1e-3 / 0.6);
  EXPECT_NE(to_text(summary).find("arithmetic 0.500 s, memory 0.250 s"), std::string::npos)
      << to_text(summary);
  summary.frame_ms.p99 = Figure::missing("too few");
  EXPECT_EQ(reference_ratios(summary).frame_p99.reason, "too few");
}

}  // namespace
}  // namespace psygen::telemetry
