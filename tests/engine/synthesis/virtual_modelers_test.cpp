#include "engine/synthesis/virtual_modelers.hpp"

#include <gtest/gtest.h>

namespace psygen::synthesis {
namespace {

using Job = VirtualModelers::Job;

// Requests named by their slots, with the given durations.
std::vector<Request> plan_of(std::initializer_list<double> seconds, std::uint32_t first = 0) {
  std::vector<Request> plan;
  for (const double s : seconds) {
    Request request;
    request.handle = {first++, 1};
    request.cost.seconds.fill(s);
    plan.push_back(std::move(request));
  }
  return plan;
}

std::vector<std::uint32_t> slots_of(const std::vector<Job>& jobs) {
  std::vector<std::uint32_t> slots;
  for (const Job& job : jobs)
    slots.push_back(job.request.handle.slot);
  return slots;
}
std::vector<std::uint32_t> slots_of(const std::vector<Request>& requests) {
  std::vector<std::uint32_t> slots;
  for (const Request& request : requests)
    slots.push_back(request.handle.slot);
  return slots;
}

using Slots = std::vector<std::uint32_t>;

TEST(VirtualModelers, TheFirstFreeModelerClaimsNextAndTakesThePredictedTime) {
  VirtualModelers modelers(2);
  modelers.publish(plan_of({3, 1, 1, 1, 5}), 10);
  EXPECT_TRUE(modelers.take_finished(10.5).empty());
  const auto finished = modelers.take_finished(13);
  EXPECT_EQ(slots_of(finished), (Slots{1, 2, 0, 3}));
  EXPECT_EQ(finished[0].started_s, 10);
  EXPECT_EQ(finished[1].started_s, 11);
  EXPECT_EQ(finished[2].modeler, 0u);
  EXPECT_EQ(finished[3].finished_s, 13);
  EXPECT_EQ(modelers.outstanding(), 1u);
  EXPECT_EQ(slots_of(modelers.reclaim(13)), (Slots{4})) << "not begun at 13";
  EXPECT_EQ(modelers.outstanding(), 0u);
}

TEST(VirtualModelers, AClaimedRequestIsFinishedAfterThePlanIsReplaced) {
  VirtualModelers modelers(1);
  modelers.publish(plan_of({2, 2, 2}), 0);
  EXPECT_EQ(slots_of(modelers.reclaim(1)), (Slots{1, 2}));
  modelers.publish(plan_of({1}, 7), 1);
  EXPECT_TRUE(modelers.take_finished(1.5).empty());
  EXPECT_EQ(slots_of(modelers.take_finished(2)), (Slots{0}));
  EXPECT_EQ(slots_of(modelers.take_finished(3)), (Slots{7})) << "it began at 2";
}

TEST(VirtualModelers, AModelerThatWaitedStartsWhenThePlanComes) {
  VirtualModelers modelers(1);
  modelers.publish(plan_of({1}), 0);
  EXPECT_EQ(modelers.take_finished(5).size(), 1u);
  EXPECT_TRUE(modelers.reclaim(5).empty());
  modelers.publish(plan_of({1}), 5);
  const auto finished = modelers.take_finished(9);
  ASSERT_EQ(finished.size(), 1u);
  EXPECT_EQ(finished[0].started_s, 5);
}

TEST(VirtualModelers, WaitingForAllFinishesAllAndFreesEveryModeler) {
  VirtualModelers modelers(3);
  modelers.publish(plan_of({1, 2, 3, 4, 5, 6, 7}), 0);
  EXPECT_EQ(modelers.finish_all(0.5).size(), 7u);
  EXPECT_EQ(modelers.outstanding(), 0u);
  EXPECT_TRUE(modelers.reclaim(0.5).empty());
  modelers.publish(plan_of({1}), 0.5);
  EXPECT_EQ(modelers.take_finished(1.5).size(), 1u);
}

}  // namespace
}  // namespace psygen::synthesis
