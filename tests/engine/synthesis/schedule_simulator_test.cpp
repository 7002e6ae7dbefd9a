#include <gtest/gtest.h>

#include "engine/core/hash.hpp"
#include "engine/synthesis/request_stream.hpp"

namespace psygen::synthesis {
namespace {

std::vector<SimulatedJob> jobs_of(std::initializer_list<double> seconds) {
  std::vector<SimulatedJob> jobs;
  for (const double s : seconds)
    jobs.push_back({0, s, 0, Rank::by_layer(RankGroup::kVisibleHole, 0, 0)});
  return jobs;
}

// Paper, section 4: ten models, the first and the sixth take 0.4 s, the others 0.1 s.
TEST(ScheduleSimulator, ThePapersTenJobsTakeEightTenthsOnTwoModelers) {
  const auto jobs = jobs_of({0.4, 0.1, 0.1, 0.1, 0.1, 0.4, 0.1, 0.1, 0.1, 0.1});
  EXPECT_NEAR(simulate(jobs, 2, Policy::kFifo).makespan_s, 0.8, 1e-9);
  EXPECT_NEAR(simulate(jobs, 2, Policy::kLongest).makespan_s, 0.8, 1e-9);
  EXPECT_NEAR(simulate(jobs, 1, Policy::kFifo).makespan_s, 1.6, 1e-9);
  // As the paper proposes: one modeler takes both long jobs and the other all short ones.
  const SimulationResult fifo = simulate(jobs, 2, Policy::kFifo);
  EXPECT_EQ(fifo.runs[0].modeler, fifo.runs[5].modeler);
  EXPECT_NEAR(fifo.idle_seconds, 0, 1e-9);
}

TEST(ScheduleSimulator, EightShortJobsAndALongOneDistinguishThePolicies) {
  const auto jobs = jobs_of({0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.8});
  EXPECT_NEAR(simulate(jobs, 2, Policy::kFifo).makespan_s, 1.2, 1e-9);
  EXPECT_NEAR(simulate(jobs, 2, Policy::kShortest).makespan_s, 1.2, 1e-9);
  EXPECT_NEAR(simulate(jobs, 2, Policy::kLongest).makespan_s, 0.8, 1e-9);
  EXPECT_NEAR(simulate(jobs, 2, Policy::kFifo).idle_seconds, 0.8, 1e-9);
  EXPECT_LT(simulate(jobs, 2, Policy::kShortest).mean_wait_s,
            simulate(jobs, 2, Policy::kLongest).mean_wait_s);
}

TEST(ScheduleSimulator, DeadlineIsLateLessThanFifoWhenTheUrgentComesLast) {
  std::vector<SimulatedJob> jobs;
  for (int i = 0; i < 10; ++i)
    jobs.push_back(
        {0, 0.1, 1.1 - 0.1 * i, Rank::by_deadline(static_cast<float>(1.1 - 0.1 * i), 0)});
  EXPECT_NEAR(simulate(jobs, 1, Policy::kDeadline).max_lateness_s, 0, 1e-6);
  EXPECT_GT(simulate(jobs, 1, Policy::kFifo).max_lateness_s, 0.5);
}

TEST(ScheduleSimulator, JobsAreNotServedBeforeTheyArrive) {
  auto jobs = jobs_of({0.1, 0.5, 0.1});
  jobs[1].arrival_s = 1.0;
  jobs[2].arrival_s = 1.2;
  const SimulationResult result = simulate(jobs, 2, Policy::kLongest);
  EXPECT_DOUBLE_EQ(result.runs[0].finish_s, 0.1);
  EXPECT_DOUBLE_EQ(result.runs[1].start_s, 1.0);
  EXPECT_DOUBLE_EQ(result.runs[2].start_s, 1.2);
  EXPECT_EQ(simulate({}, 3, Policy::kFifo).makespan_s, 0.0);
}

TEST(ScheduleSimulator, AModelerThatWasIdleDoesNotBeginBeforeTheJobArrives) {
  auto jobs = jobs_of({0.1, 0.1, 0.1});
  for (SimulatedJob& job : jobs)
    job.arrival_s = 5;
  const SimulationResult result = simulate(jobs, 3, Policy::kFifo);
  for (const SimulatedRun& run : result.runs)
    EXPECT_DOUBLE_EQ(run.start_s, 5);
  EXPECT_DOUBLE_EQ(result.makespan_s, 5.1);
}

TEST(ScheduleSimulator, AllPoliciesDoAllTheWorkAndNoModelerDoesTwoThingsAtOnce) {
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kParameters);
  std::vector<SimulatedJob> jobs;
  double work = 0;
  for (int i = 0; i < 200; ++i) {
    jobs.push_back({random.next_real(0, 2), random.next_real(0.001, 0.1), random.next_real(0, 3),
                    Rank::by_deadline(static_cast<float>(random.next_real(0, 3)), 0)});
    work += jobs.back().seconds;
  }
  for (const Policy policy : kAllPolicies) {
    const SimulationResult r = simulate(jobs, 3, policy);
    EXPECT_NEAR(r.makespan_s * 3 - r.idle_seconds, work, 1e-9);
    for (std::size_t a = 0; a < jobs.size(); ++a) {
      EXPECT_GE(r.runs[a].start_s, jobs[a].arrival_s);
      for (std::size_t b = 0; b < a; ++b) {
        if (r.runs[a].modeler != r.runs[b].modeler) continue;
        EXPECT_TRUE(r.runs[a].start_s >= r.runs[b].finish_s ||
                    r.runs[b].start_s >= r.runs[a].finish_s);
      }
    }
  }
}

}  // namespace
}  // namespace psygen::synthesis
