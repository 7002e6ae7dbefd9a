// psygen schedule --ranks: simulates a cluster.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/engine/cli/psygen_process.hpp"

namespace psygen::cli {
namespace {

nlohmann::json simulated(const std::string& options) {
  const Outcome outcome = run_psygen("schedule --json " + options);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out);
}

TEST(ScheduleCluster, OfAThousandRanksIsEfficientIfNothingSaturates) {
  const auto job = simulated("--ranks 1024 --threads 2");
  EXPECT_GE(job["efficiency"], 0.95);
  EXPECT_LE(job["worst_rank_idle"], 0.05);
  EXPECT_LE(job["claims"].get<double>() / job["blocks"].get<double>(), 0.01);
  EXPECT_NEAR(job["bytes"].get<double>(), 8e12, 1e10);
  EXPECT_EQ(job, simulated("--ranks 1024 --threads 2"));
  // With one thread a core, the core waits for each of its files.
  EXPECT_LT(simulated("--ranks 1024")["efficiency"], 0.92);
}

TEST(ScheduleCluster, ReportsTheSaturatedResourceAndItsNumberOfRanks) {
  const auto job = simulated("--ranks 64 --threads 2 --storage-gb-per-s 4");
  EXPECT_GT(job["limits"]["storage bandwidth"]["busy"], 0.95);
  const double ranks = job["limits"]["storage bandwidth"]["ranks"];
  EXPECT_LT(ranks, 64);
  EXPECT_NEAR(job["efficiency"].get<double>(), ranks / 64, 0.03);
  const auto half = simulated("--ranks 64 --threads 2 --storage-gb-per-s 4 --terabytes 4");
  EXPECT_NEAR(half["makespan_seconds"].get<double>() / job["makespan_seconds"].get<double>(), 0.5,
              0.01);
}

TEST(ScheduleCluster, ClaimsEndRanksTogetherDespitePredictionErrors) {
  const std::string options = "--ranks 16 --terabytes 0.1 --error-percent 100 --share ";
  const double cost = simulated(options + "cost")["worst_rank_idle"],
               claims = simulated(options + "claims")["worst_rank_idle"];
  EXPECT_LE(claims, 0.05);
  EXPECT_GT(cost, 1.5 * claims);
}

TEST(ScheduleCluster, NeedsRanksOrRequests) {
  EXPECT_EQ(run_psygen("schedule").code, 2);
  EXPECT_EQ(run_psygen("schedule --cores 4").code, 2);
  EXPECT_EQ(run_psygen("schedule --ranks 4 --requests a").code, 2);
  EXPECT_EQ(run_psygen("schedule --ranks 4 --world nowhere").code, 1);
}

}  // namespace
}  // namespace psygen::cli
