#include "engine/synthesis/request_stream.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/source_file.hpp"

namespace psygen::synthesis {
namespace {

SimulatedJob job(double arrival_s, double seconds, double deadline_s, RankGroup group) {
  return {arrival_s, seconds, deadline_s, Rank::by_layer(group, 3, 20)};
}

// Flights over the paper's world, recorded by psygen fly --headless --size 160x90 and
// walk: --path game/paths/walk27.toml --fixed-step 60 --frames 30 --view-distance 80
// dash: --path game/paths/dash.toml   --fixed-step 60 --frames 60 --view-distance 80
// leap: --path game/paths/leaps.toml  --fixed-step 10 --frames 75 --view-distance 60
// with --record-requests NAME.requests; of the leap, the requests from 4.9 to 6.2 s, between two
// places. Every synthesis takes 200 times as long, so that modelers have to choose.
std::vector<SimulatedJob> recorded(const std::string& name) {
  std::ifstream file(source_file("tests/engine/synthesis/data/") + name + ".requests");
  std::stringstream text;
  text << file.rdbuf();
  auto jobs = parse_stream(text.str(), name);
  if (!jobs) {
    ADD_FAILURE() << jobs.error().message;
    return {};
  }
  for (SimulatedJob& j : *jobs)
    j.seconds *= 200;
  return *jobs;
}

const PolicyStats& row_of(const std::vector<PolicyStats>& rows, Policy policy) {
  return rows[static_cast<std::size_t>(policy)];
}

TEST(RequestStream, IsReadAsItWasWritten) {
  const std::vector<SimulatedJob> jobs{job(0.25, 1e-5, kNoDeadline, RankGroup::kPrefetch),
                                       job(0, 3.25e-6, 0, RankGroup::kVisibleHole),
                                       job(0.5, 2e-3, 1.125, RankGroup::kPredicted)};
  const auto read = parse_stream(stream_text(jobs), "a");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 3u);
  EXPECT_EQ((*read)[0].seconds, 3.25e-6);  // by arrival
  EXPECT_EQ((*read)[1].deadline_s, kNoDeadline);
  EXPECT_EQ((*read)[2].deadline_s, 1.125);
  EXPECT_EQ((*read)[2].rank, jobs[2].rank);
  EXPECT_EQ(stream_text(*read), stream_text(jobs));
}

TEST(RequestStream, AnInvalidStreamIsRejectedWithItsLine) {
  const std::string head = "psygen requests 2\n";
  const std::pair<std::string, std::string> cases[] = {{"", "a:1"},
                                                       {"psygen requests 1\n", "a:1"},
                                                       {head, "a:1"},
                                                       {head + "0 1 - 0\n0 1 -\n", "a:3"},
                                                       {head + "0 1 - 0 0\n", "a:2"},
                                                       {head + "0 nan - 0\n", "a:2"},
                                                       {head + "-1 1 - 0\n", "a:2"},
                                                       {head + "0 1 x 0\n", "a:2"},
                                                       {head + "0 1 - zz\n", "a:2"},
                                                       {head + "0 inf - 0\n", "a:2"}};
  for (const auto& [text, where] : cases) {
    const auto jobs = parse_stream(text, "a");
    ASSERT_FALSE(jobs) << text;
    EXPECT_EQ(jobs.error().message.find(where + ":"), 0u) << jobs.error().message;
  }
}

// Results computed by hand: one modeler, a long prefetch and a short hole at 0, a predicted mesh
// later.
TEST(RequestStream, StatisticsMatchTheSchedule) {
  const std::vector<SimulatedJob> jobs{job(0, 0.4, kNoDeadline, RankGroup::kPrefetch),
                                       job(0, 0.1, 0, RankGroup::kVisibleHole),
                                       job(0.2, 0.2, 0.3, RankGroup::kPredicted)};
  const auto rows = compare_policies(jobs, 1);
  ASSERT_EQ(rows.size(), 5u);
  const PolicyStats& fifo = row_of(rows, Policy::kFifo);
  EXPECT_NEAR(fifo.fill_s, 0.5, 1e-12);
  EXPECT_NEAR(fifo.visible_max_s, 0.5, 1e-12);
  EXPECT_NEAR(fifo.lateness_max_s, 0.4, 1e-12);
  EXPECT_NEAR(fifo.late_percent, 100, 1e-12);
  const PolicyStats& deadline = row_of(rows, Policy::kDeadline);
  EXPECT_NEAR(deadline.visible_max_s, 0.1, 1e-12);
  EXPECT_NEAR(deadline.fill_idle_percent, 0, 1e-9);
}

// A request that is due on arrival is late in any order, and does not distinguish the policies.
TEST(RequestStream, OnlyRequestsThatCouldBeInTimeCountAsLate) {
  const std::vector<SimulatedJob> jobs{job(0, 0.1, 0, RankGroup::kPredicted),
                                       job(0, 0.1, 0.15, RankGroup::kPredicted),
                                       job(0, 0.1, 0.25, RankGroup::kPredicted)};
  for (const PolicyStats& row : compare_policies(jobs, 3)) {
    EXPECT_EQ(row.late_percent, 0) << name_of(row.policy);
    EXPECT_EQ(row.lateness_mean_s, 0);
    EXPECT_EQ(row.lateness_max_s, 0);
  }
  const auto rows = compare_policies(jobs, 1);
  const PolicyStats& due = row_of(rows, Policy::kDeadline);
  EXPECT_EQ(due.late_percent, 100);
  EXPECT_NEAR(due.lateness_mean_s, 0.05, 1e-9);
  EXPECT_NEAR(due.lateness_max_s, 0.05, 1e-9);
}

TEST(RequestStream, ItsLoadIsTheWorkOverTheTimeOfTheModelers) {
  const std::vector<SimulatedJob> jobs{job(1, 0.5, kNoDeadline, RankGroup::kPrefetch),
                                       job(3, 0.5, 0, RankGroup::kVisibleHole)};
  const StreamLoad load = load_of(jobs, 2);
  EXPECT_EQ(load.requests, 2u);
  EXPECT_NEAR(load.span_s, 2, 1e-12);
  EXPECT_NEAR(load.work_s, 1, 1e-12);
  EXPECT_NEAR(load.percent, 25, 1e-9);
  EXPECT_EQ(load_of(std::span(jobs).first(1), 2).percent, 0);
}

// A feasible stream on one modeler has a largest lateness of zero, which earliest deadline first
// reaches (Jackson's rule). For infeasible streams, shortest first has less mean lateness.
TEST(RequestStream, EarliestDeadlineFirstIsInTimeIfAnyOrderIsUnlikeShortestFirst) {
  std::vector<SimulatedJob> jobs;
  for (int i = 0; i < 8; ++i)  // the longest is due first
    jobs.push_back(job(0, 0.08 - 0.01 * i, 0.36 - 0.01 * (7 - i) * (6 - i) / 2.0 + 1e-6,
                       RankGroup::kPredicted));
  const auto rows = compare_policies(jobs, 1);
  EXPECT_EQ(row_of(rows, Policy::kDeadline).late_percent, 0);
  EXPECT_GT(row_of(rows, Policy::kShortest).late_percent, 0);
}

class RecordedFlight : public ::testing::TestWithParam<std::string> {
 protected:
  const std::vector<SimulatedJob> jobs_ = recorded(GetParam());
  const std::vector<PolicyStats> rows_ = compare_policies(jobs_, 2);
};

TEST_P(RecordedFlight, TheDeadlinePolicyFillsHolesSoonerThanPoliciesThatIgnoreTheView) {
  ASSERT_GT(jobs_.size(), 1000u);
  const PolicyStats& due = row_of(rows_, Policy::kDeadline);
  for (const Policy other : {Policy::kFifo, Policy::kShortest, Policy::kLongest}) {
    EXPECT_LT(due.visible_p99_s, 0.5 * row_of(rows_, other).visible_p99_s) << name_of(other);
    EXPECT_LT(due.visible_max_s, 0.5 * row_of(rows_, other).visible_max_s) << name_of(other);
  }
}

// One modeler has to choose; two finish the walk and the dash in time in any order.
TEST_P(RecordedFlight, TheDeadlinePolicyIsNeverLaterThanTheOthers) {
  const auto rows = compare_policies(jobs_, 1);
  const PolicyStats& due = row_of(rows, Policy::kDeadline);
  EXPECT_LE(due.lateness_max_s, row_of(rows, Policy::kPlp).lateness_max_s);
  for (const Policy other : {Policy::kFifo, Policy::kShortest, Policy::kLongest})
    EXPECT_LT(due.lateness_max_s, row_of(rows, other).lateness_max_s) << name_of(other);
}

// Flights that begin with an empty cache.
class RecordedStart : public RecordedFlight {};

TEST_P(RecordedStart, ModelersAreRarelyIdleDuringTheFillAndLongestFirstEndsSooner) {
  for (const PolicyStats& row : rows_) {
    EXPECT_GE(row.visible_p50_s, 0);
    EXPECT_GT(row.fill_s, 0.05);
    EXPECT_LT(row.fill_idle_percent, 5);
  }
  EXPECT_LT(row_of(rows_, Policy::kLongest).fill_s, row_of(rows_, Policy::kShortest).fill_s);
}

INSTANTIATE_TEST_SUITE_P(Paths, RecordedStart, ::testing::Values("walk", "dash"),
                         [](const auto& name) { return name.param; });
INSTANTIATE_TEST_SUITE_P(Paths, RecordedFlight, ::testing::Values("walk", "dash", "leap"),
                         [](const auto& name) { return name.param; });

}  // namespace
}  // namespace psygen::synthesis
