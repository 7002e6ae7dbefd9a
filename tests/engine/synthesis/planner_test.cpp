#include "engine/synthesis/planner.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "engine/core/clock.hpp"
#include "engine/core/geometry_memory.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "tests/engine/synthesis/fake_models.hpp"

namespace psygen::synthesis {
namespace {
using testing::Gate;
using testing::hole;
using testing::key_of;
using testing::kMeshBytes;
using testing::parameters_of;
using testing::prefetch;
using testing::registry_of;
using testing::ScriptedModel;

constexpr models::ModelIndex kWild = 1;

// One modeler that works only while the gate is open. The main thread always works.
class PlannerTest : public ::testing::Test {
 protected:
  ~PlannerTest() override { gate.open(); }
  Want want(std::uint32_t index, Rank rank, float deadline_s = 0, std::uint32_t vertices = 80,
            models::ModelIndex model = 0) {
    parameters.push_back(std::make_unique<models::Parameters>(parameters_of(index, vertices)));
    return {key_of(index, *parameters.back(), model), parameters.back().get(), index, rank,
            deadline_s};
  }
  std::vector<Want> wants_of(std::initializer_list<std::uint32_t> indices) {
    std::vector<Want> wants;
    for (const std::uint32_t i : indices)
      wants.push_back(want(i, hole(static_cast<float>(i * 100))));
    return wants;
  }
  PlanReport plan(const std::vector<Want>& wants) {
    return planner.plan(wants, cache, cost, manager, limits, policy);
  }
  std::vector<std::uint64_t> unclaimed_owners() {
    std::vector<std::uint64_t> owners;
    std::vector<Request> back = manager.reclaim();
    for (const Request& r : back)
      owners.push_back(r.owner);
    manager.publish(std::move(back));
    return owners;
  }
  // Lets the modeler claim one request and hang on it, so that the rest of any plan stays
  // unclaimed.
  void block_modeler() {
    plan({want(9999, hole(0))});
    gate.await(1);
  }
  std::vector<Completion> completions() {
    manager.wait_all();
    std::vector<Completion> done;
    manager.collect(done);
    return done;
  }
  void finish_all() {
    gate.open();
    std::vector<Completion> done = completions();
    land(done, cache, &cost);
  }

  static void burn(double seconds) {
    const double start_s = core::thread_cpu_seconds();
    while (core::thread_cpu_seconds() - start_s < seconds) {
    }
  }

  const std::thread::id main_thread = std::this_thread::get_id();
  double burned_seconds = 0;
  Gate gate;
  std::vector<std::unique_ptr<models::Parameters>> parameters;
  // Model 0 may run on the main thread, kWild must not.
  models::Registry gated_and_wild() {
    const auto script = [this](const models::Parameters& p, int) {
      if (p.integer(0) == 666) throw std::runtime_error("the beast");
      if (std::this_thread::get_id() != main_thread) gate.wait();
      burn(p.integer(0) == 888 ? burned_seconds : 0);
    };
    models::Registry both = registry_of(std::make_unique<ScriptedModel>("gated", script));
    EXPECT_EQ(both.add(std::make_unique<ScriptedModel>("wild", script)).value(), kWild);
    return both;
  }
  models::Registry registry = gated_and_wild();
  core::HeapGeometryMemory memory{1 << 20};
  GeometryCache cache{memory, registry, 6 * kMeshBytes};
  CostModel cost{registry};
  PlanLimits limits{1e9, 4096, 16};
  Policy policy = Policy::kDeadline;
  SynthesisManager manager{registry, {.modelers = 1, .watchdog_seconds = 0}};
  Planner planner;
};

TEST_F(PlannerTest, WantsBecomeRequestsInOrderAndThenReadyMeshes) {
  block_modeler();
  const PlanReport report = plan(wants_of({3, 1, 2}));
  EXPECT_EQ(report.published, 3u);
  EXPECT_EQ(report.reserved, 3u);
  EXPECT_GT(report.predicted_seconds, 0);
  EXPECT_EQ(unclaimed_owners(), (std::vector<std::uint64_t>{1, 2, 3}));
  finish_all();
  const PlanReport next = plan(wants_of({1, 2, 3}));
  EXPECT_EQ(next.ready, 3u);
  EXPECT_EQ(next.published, 0u);
}

TEST_F(PlannerTest, UnclaimedReservationsAreCarriedOverOrReleased) {
  block_modeler();
  plan(wants_of({1, 2, 3}));
  const PlanReport report = plan(wants_of({2, 3, 4}));
  EXPECT_EQ(report.carried, 2u);
  EXPECT_EQ(report.reserved, 1u);
  EXPECT_EQ(report.cancelled, 1u);
  EXPECT_EQ(unclaimed_owners(), (std::vector<std::uint64_t>{2, 3, 4}));
  EXPECT_FALSE(cache.find(want(1, hole(0)).key));
  EXPECT_EQ(memory.used_bytes(), 4 * kMeshBytes);  // the blocked one and three
}

TEST_F(PlannerTest, ACarriedRequestGetsRankAndOwnerOfItsNewWant) {
  block_modeler();
  plan({want(1, prefetch(5))});
  Want again = want(1, hole(2));
  again.owner = 55;
  plan({again});
  const MeshRecord* record = cache.get(cache.find(again.key));
  EXPECT_EQ(record->owner, 55u);
  EXPECT_EQ(record->rank, hole(2));
  EXPECT_EQ(unclaimed_owners(), (std::vector<std::uint64_t>{55}));
}

TEST_F(PlannerTest, AClaimedMeshIsNeitherCancelledNorRequestedAgain) {
  block_modeler();
  const PlanReport wanted = plan({want(9999, hole(0))});
  EXPECT_EQ(wanted.in_flight, 1u);
  EXPECT_EQ(wanted.published, 0u);
  const PlanReport unwanted = plan({});
  EXPECT_EQ(unwanted.cancelled, 0u);
  EXPECT_EQ(memory.used_bytes(), kMeshBytes);
}

TEST_F(PlannerTest, EnoughPredictedWorkEndsThePlanAndTheRestIsDeferred) {
  block_modeler();
  limits.seconds_ahead = 2.5 * cost.predict(0, parameters_of(1, 80), 0);
  const PlanReport report = plan(wants_of({1, 2, 3, 4, 5}));
  EXPECT_EQ(report.published, 3u);
  EXPECT_EQ(report.deferred, 2u);
  // Reservations of the last plan that fall behind the horizon are released.
  const PlanReport next = plan({want(10, hole(1)), want(11, hole(2)), want(12, hole(3)),
                                want(1, hole(4)), want(2, hole(5)), want(3, hole(6))});
  EXPECT_EQ(next.published, 3u);
  EXPECT_EQ(next.cancelled, 3u);
  EXPECT_EQ(next.carried, 0u);
  limits = {1e9, 2, 16};
  EXPECT_EQ(plan(wants_of({1, 2, 3})).published, 2u);
}

TEST_F(PlannerTest, OfManyNewWantsOnlyTheBestAreReservedInOnePlan) {
  block_modeler();
  limits.max_new = 3;
  limits.seconds_ahead = 1e9;
  const auto wants = wants_of({5, 1, 4, 2, 3});
  const PlanReport first = plan(wants);
  EXPECT_EQ(first.reserved, 3u);
  EXPECT_EQ(first.deferred, 2u);
  EXPECT_EQ(unclaimed_owners(), (std::vector<std::uint64_t>{1, 2, 3}));
  const PlanReport second = plan(wants);  // carried requests do not count
  EXPECT_EQ(second.carried, 3u);
  EXPECT_EQ(second.reserved, 2u);
  EXPECT_EQ(unclaimed_owners(), (std::vector<std::uint64_t>{1, 2, 3, 4, 5}));
}

TEST_F(PlannerTest, ABetterWantReplacesTheWorstUnclaimedReservation) {
  block_modeler();
  plan(wants_of({1, 2, 3, 4, 5}));  // requests in flight fill the cache
  auto wants = wants_of({1, 2, 3, 4, 5});
  wants.push_back(want(100, hole(0)));
  const PlanReport report = plan(wants);
  EXPECT_EQ(report.cancelled, 1u);
  EXPECT_EQ(report.refused, 1u);  // the fifth is now last and finds no memory
  EXPECT_EQ(unclaimed_owners(), (std::vector<std::uint64_t>{100, 1, 2, 3, 4}));
}

TEST_F(PlannerTest, AFullCacheRejectsAFewWantsAndStopsWithoutThrashing) {
  finish_all();
  for (const std::uint32_t i : {1u, 2u, 3u, 4u, 5u, 6u}) {
    plan({want(i, hole(static_cast<float>(i)))});
    finish_all();
  }
  limits.max_refusals = 3;
  std::vector<Want> wants;
  for (std::uint32_t i = 0; i < 50; ++i)
    wants.push_back(want(100 + i, prefetch(static_cast<float>(i))));
  const PlanReport report = plan(wants);
  EXPECT_EQ(report.refused, 3u);
  EXPECT_EQ(report.deferred, 47u);
  EXPECT_EQ(report.published, 0u);
  EXPECT_TRUE(cache.take_evictions().empty());
}

TEST_F(PlannerTest, RepeatedWantsMakeOneRequest) {
  block_modeler();
  const PlanReport fresh = plan({want(1, hole(1)), want(1, hole(2))});
  EXPECT_EQ(fresh.published, 1u);
  const PlanReport carried = plan({want(1, hole(1)), want(1, hole(2))});
  EXPECT_EQ(carried.published, 1u);
  EXPECT_EQ(carried.cancelled, 0u);
}

TEST_F(PlannerTest, AFailedMeshIsNotRequestedAgain) {
  finish_all();
  plan({want(666, hole(1))});
  finish_all();
  const Want beast = want(666, hole(1));
  EXPECT_EQ(cache.get(cache.find(beast.key))->state, MeshState::kFailed);
  EXPECT_EQ(cache.failure_reason(cache.find(beast.key)), "gated level 0 threw: the beast");
  const PlanReport report = plan({beast});
  EXPECT_EQ(report.failed, 1u);
  EXPECT_EQ(report.published, 0u);
}

TEST_F(PlannerTest, FifoServesEarlierRequestsFirst) {
  policy = Policy::kFifo;
  block_modeler();
  plan(wants_of({5, 4}));
  plan(wants_of({1, 4, 5}));
  EXPECT_EQ(unclaimed_owners(), (std::vector<std::uint64_t>{5, 4, 1}));
}

TEST_F(PlannerTest, DeadlinesOrderPredictedMeshes) {
  block_modeler();
  plan({want(1, Rank::by_deadline(3, 1), 3), want(2, Rank::by_deadline(1, 9), 1), want(3, hole(7)),
        want(4, prefetch(0), 9)});
  EXPECT_EQ(unclaimed_owners(), (std::vector<std::uint64_t>{3, 2, 1, 4}));
}

TEST_F(PlannerTest, LandingDropsStaleHandlesAndKeepsHungDestinations) {
  const auto p = parameters_of(1, 80);
  const MeshHandle hung = *cache.reserve(key_of(1, p), p, 1, hole(1));
  const MeshHandle stale = *cache.reserve(key_of(2, p), p, 2, hole(1));
  const MeshHandle fine = *cache.reserve(key_of(3, p), p, 3, hole(1));
  cache.cancel(stale);
  std::vector<Completion> done(4);
  done[0].handle = hung;
  done[0].abandoned = true;
  done[1].handle = stale;
  done[1].ok = true;
  done[2].handle = fine;
  done[2].ok = true;
  done[3].handle = hung;
  done[3].late = true;
  const LandingReport first = land({done.data(), 3}, cache, nullptr);
  EXPECT_EQ(first.ready, 1u);
  EXPECT_EQ(first.failed, 1u);
  EXPECT_EQ(first.bytes, kMeshBytes);
  EXPECT_EQ(memory.used_bytes(), 2 * kMeshBytes);
  EXPECT_EQ(land({done.data() + 3, 1}, cache, nullptr).settled, 1u);
  EXPECT_EQ(memory.used_bytes(), kMeshBytes);
}

TEST_F(PlannerTest, OnlyVisibleHolesAreMadeAtOnceWithinTheirTime) {
  gate.open();
  limits.seconds_here = 10;
  const PlanReport report = plan({want(1, hole(10)), want(2, prefetch(10)), want(3, hole(20))});
  EXPECT_EQ(report.executed, 2u);
  EXPECT_EQ(report.published, 1u);
  std::vector<Completion> done = completions();
  ASSERT_EQ(done.size(), 3u);
  EXPECT_EQ(done[0].owner, 1u);
  EXPECT_EQ(done[0].modeler, kMainThreadModeler);
  EXPECT_EQ(done[1].owner, 3u);
  EXPECT_EQ(done[2].owner, 2u);
  EXPECT_NE(done[2].modeler, kMainThreadModeler);
  EXPECT_EQ(land(done, cache, &cost).ready, 3u);
}

TEST_F(PlannerTest, TheCallerMayHaveMoreVisibleMeshesMadeAtOnceInOrder) {
  gate.open();
  limits.seconds_here = 10;
  const std::vector<Want> wants{
      want(1, prefetch(10)), want(2, Rank::by_layer(RankGroup::kVisibleCoarse, 3, 10)),
      want(3, hole(20)), want(4, Rank::by_layer(RankGroup::kDrawn, 0, 10))};
  limits.here_up_to = RankGroup::kVisibleCoarse;
  const PlanReport report = plan(wants);
  EXPECT_EQ(report.executed, 2u);
  EXPECT_EQ(report.published, 2u);
  std::vector<Completion> done = completions();
  ASSERT_EQ(done.size(), 4u);
  EXPECT_EQ(done[0].owner, 3u);
  EXPECT_EQ(done[1].owner, 2u);
  EXPECT_EQ(done[1].modeler, kMainThreadModeler);
  EXPECT_NE(done[2].modeler, kMainThreadModeler);
  EXPECT_NE(done[3].modeler, kMainThreadModeler);
}

TEST_F(PlannerTest, AMeshPredictedToTakeTooLongDoesNotDelayTheNext) {
  gate.open();
  const std::vector<Want> wants{want(1, hole(10), 0, 800), want(2, hole(20), 0, 8)};
  const double large_s = cost.predict(wants[0].key.model, *wants[0].parameters, 0);
  const double small_s = cost.predict(wants[1].key.model, *wants[1].parameters, 0);
  ASSERT_LT(small_s, large_s);
  limits.seconds_here = (small_s + large_s) / 2;
  GeometryCache roomy{memory, registry, 1 << 18};
  const PlanReport report = planner.plan(wants, roomy, cost, manager, limits, policy);
  EXPECT_EQ(report.executed, 1u);
  std::vector<Completion> done = completions();
  ASSERT_EQ(done.size(), 2u);
  EXPECT_EQ(done[0].owner, 2u);
  EXPECT_EQ(done[0].modeler, kMainThreadModeler);
  EXPECT_EQ(done[1].owner, 1u);
  EXPECT_EQ(land(done, roomy, &cost).ready, 2u);
}

TEST_F(PlannerTest, AHolePredictedToTakeTooLongIsLeftToTheModelers) {
  gate.open();
  limits.seconds_here = 1e-12;
  const PlanReport report = plan({want(1, hole(10))});
  EXPECT_EQ(report.executed, 0u);
  EXPECT_EQ(report.published, 1u);
}

// First access to memory is slow whatever the prediction says. The next hole must not stay open
// because of it.
TEST_F(PlannerTest, AHoleThatTookLongerThanPredictedDoesNotDelayTheNext) {
  gate.open();
  const std::vector<Want> wants{want(888, hole(10)), want(2, hole(20))};
  limits.seconds_here =
      3 * cost.predict_request(0, 0, cost.work(0, *wants[0].parameters, 0)).of(Warmth::kAfterSleep);
  burned_seconds = 2 * limits.seconds_here;
  EXPECT_EQ(plan(wants).executed, 2u);
}

// A modeler that has claimed the mesh of a hole may not get a processor for a long time.
TEST_F(PlannerTest, AHoleIsFilledHereAlthoughAModelerHoldsItsMesh) {
  block_modeler();
  const Want held = want(9999, hole(0));
  EXPECT_EQ(plan({held}).executed, 0u) << "this thread has no time";
  limits.seconds_here = 10;
  const PlanReport report = plan({held});
  EXPECT_EQ(report.in_flight, 1u);
  EXPECT_EQ(report.executed, 1u);
  std::vector<Completion> done;
  manager.collect(done);
  ASSERT_EQ(done.size(), 1u);
  EXPECT_EQ(done[0].modeler, kMainThreadModeler);
  EXPECT_EQ(done[0].owner, held.owner);
  EXPECT_NE(done[0].handle, cache.find(held.key)) << "the modeler fills that one";
  EXPECT_EQ(land(done, cache, &cost).ready, 1u);
  EXPECT_EQ(plan({held}).executed, 0u) << "the mesh is ready";
  finish_all();
  EXPECT_EQ(cache.get(cache.find(held.key))->state, MeshState::kReady);
}

TEST_F(PlannerTest, AMeshThatAModelerFinishedIsNotMadeAgain) {
  gate.open();
  const Want want_it = want(1, hole(0));
  plan({want_it});
  manager.wait_all();
  limits.seconds_here = 10;
  const PlanReport report = plan({want_it});
  EXPECT_EQ(report.in_flight, 1u);
  EXPECT_EQ(report.executed, 0u);
}

// A hole that only a modeler may fill is not delayed by requests that this thread had no time for.
TEST_F(PlannerTest, ARequestNotMadeAtOnceKeepsItsPlaceInThePlan) {
  block_modeler();
  limits.seconds_here = 1e-12;
  limits.here_up_to = RankGroup::kVisibleCoarse;
  const PlanReport report = plan({want(1, Rank::by_layer(RankGroup::kVisibleCoarse, 0, 5)),
                                  want(2, hole(30), 0, 80, kWild), want(3, hole(10))});
  EXPECT_EQ(report.executed, 0u);
  EXPECT_EQ(unclaimed_owners(), (std::vector<std::uint64_t>{3, 2, 1}));
}

TEST_F(PlannerTest, AMeshWantedAtOnceIsMadeHereHoweverLongItTakes) {
  limits.seconds_here = 1e-12;
  std::vector<Want> wants = wants_of({1, 2, 3});
  wants[1].at_once = true;
  EXPECT_EQ(plan(wants).executed, 1u);
  std::vector<Completion> done;
  manager.collect(done);
  ASSERT_EQ(done.size(), 1u);
  EXPECT_EQ(done[0].owner, 2u);
  limits.seconds_here = 0;
  wants = wants_of({4});
  wants[0].at_once = true;
  EXPECT_EQ(plan(wants).executed, 0u) << "this thread makes nothing";
}

// Counts the calls of mesh_size(), which hashes every branch of a tree.
class AskedModel : public testing::FakeModel {
 public:
  explicit AskedModel(int& asked) : asked_(asked) {}
  models::MeshSize mesh_size(const models::Parameters& p, int level) const override {
    ++asked_;
    return FakeModel::mesh_size(p, level);
  }

 private:
  int& asked_;
};

TEST(PlannerSizes, ANewRequestComputesEachSizeOnce) {
  int asked = 0;
  const models::Registry registry = registry_of(std::make_unique<AskedModel>(asked));
  core::HeapGeometryMemory memory(1 << 20);
  GeometryCache cache(memory, registry, 2 * kMeshBytes);
  const CostModel cost(registry);
  SynthesisManager manager(registry, {.modelers = 1, .watchdog_seconds = 0});
  Planner planner;
  const models::Parameters p = parameters_of(1, 80), q = parameters_of(2, 80),
                           r = parameters_of(3, 80), s = parameters_of(4, 80);
  const std::vector<Want> full{{key_of(1, p), &p, 1, hole(1)}, {key_of(2, q), &q, 2, hole(2)}};
  planner.plan(full, cache, cost, manager, PlanLimits{1e9, 4096, 16}, Policy::kDeadline);
  EXPECT_EQ(asked, 2) << "full detail";
  EXPECT_TRUE(manager.wait_all());
  asked = 0;
  const std::vector<Want> coarse{{key_of(3, r, 0, 2), &r, 3, hole(3)}};
  planner.plan(coarse, cache, cost, manager, PlanLimits{1e9, 4096, 16}, Policy::kDeadline);
  EXPECT_EQ(asked, 2) << "the sizes of the coarse level and of full detail";
  asked = 0;
  const std::vector<Want> refused{{key_of(4, s), &s, 4, prefetch(9)}};
  planner.plan(refused, cache, cost, manager, PlanLimits{1e9, 4096, 16}, Policy::kDeadline);
  EXPECT_EQ(asked, 1) << "also without free memory";
}

}  // namespace
}  // namespace psygen::synthesis
