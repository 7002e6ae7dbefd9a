// Tests a flight with modelers on other ranks.
#include "engine/cluster/remote_modeler_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>

#include "engine/models/edits.hpp"
#include "tests/engine/cluster/flight_ranks.hpp"

namespace psygen::cluster {
namespace {

using namespace flight;

TEST(RemoteModelerPool, CostlyRequestsGoToOtherRanksAndCheapOnesStay) {
  Gate gate;
  const models::Registry registry =
      registry_of([&](const models::Parameters&, int) { gate.wait(); });
  RemoteStats figures;
  const auto reports = run({}, [&](RemoteModelerPool& remote) {
    Jobs jobs;
    SynthesisManager manager(registry, options_with(remote));
    manager.publish({jobs.make(registry, 1, kBlocker)});
    gate.await(1);  // the only modeler that may make cheap meshes is busy now
    manager.publish({jobs.make(registry, 2, kCheap), jobs.make(registry, 3, kCostly),
                     jobs.make(registry, 4, kCostly), jobs.make(registry, 5, kCheap)});
    std::vector<Completion> done;
    collect(manager, 2, done);
    for (const Completion& c : done) {
      EXPECT_EQ(c.key.model, kCostly);
      EXPECT_TRUE(c.ok && c.remote) << c.error;
    }
    gate.open();
    ASSERT_TRUE(manager.wait_all());
    collect(manager, 5, done);
    EXPECT_EQ(std::ranges::count_if(done, [](const Completion& c) { return c.remote; }), 2);
    figures = remote.figures();
  });
  EXPECT_EQ(reports[kAnswerer].made, 2u);
  EXPECT_EQ(figures.meshes, 2u);
  EXPECT_EQ(figures.bytes, (43u + 44u) * 22u);
  EXPECT_EQ(figures.given_back, 0u);
  EXPECT_GT(figures.way.latency_s, 0.0);
}

TEST(RemoteModelerPool, TheWorldIsTheSameForAnyNumberOfRanks) {
  std::map<unsigned, std::uint64_t> hashes;
  const models::Registry registry = registry_of();
  for (const unsigned count : {1u, 2u, 4u}) {
    run({.count = count, .threads = 2}, [&](RemoteModelerPool& remote) {
      Jobs jobs;
      SynthesisManager manager(registry, options_with(remote));
      EXPECT_EQ(manager.remote_count(), (count - 1) * 2);
      std::vector<Request> plan;
      for (std::uint32_t i = 1; i <= 300; ++i)
        plan.push_back(jobs.make(registry, i, i % 3 == 0 ? kCheap : kCostly));
      manager.publish(std::move(plan));
      ASSERT_TRUE(manager.wait_all());
      std::vector<Completion> done;
      collect(manager, 300, done);
      hashes[count] = world_hash(done);
    });
  }
  EXPECT_EQ(hashes[2], hashes[1]);
  EXPECT_EQ(hashes[4], hashes[1]);
}

// A rank claims a costly mesh, while a blocker keeps the local modeler busy, and stalls. Then
// eleven seconds pass on the watchdog's clock, with `count` ranks. Calls after_it(manager, remote,
// done); `done` has the blocker.
template <class AfterIt>
void stall(unsigned count, const AfterIt& after_it) {
  Gate busy, stalled;
  std::atomic<double> now_s{0};
  const models::Registry registry =
      registry_of([&](const models::Parameters&, int) { busy.wait(); });
  run({.count = count, .costly_there = [&](const models::Parameters&, int) { stalled.wait(); }},
      [&](RemoteModelerPool& remote) {
        Jobs jobs;
        SynthesisOptions options = options_with(remote);
        options.watchdog_seconds = 10;
        options.clock = [&] { return now_s.load(); };
        SynthesisManager manager(registry, options);
        manager.publish({jobs.make(registry, 1, kBlocker)});
        busy.await(1);
        const Request costly = jobs.make(registry, 2, kCostly);
        EXPECT_TRUE(manager.is_offered_remotely(costly));
        manager.publish({costly});
        stalled.await(1);
        busy.open();
        std::vector<Completion> done;
        collect(manager, 1, done);
        now_s = 11;
        after_it(manager, remote, done);
        stalled.open();
      });
}

TEST(RemoteModelerPool, AStalledRankIsAbandonedAndItsMeshIsMadeHere) {
  stall(2, [](SynthesisManager& manager, RemoteModelerPool& remote, std::vector<Completion>& done) {
    manager.collect(done);
    EXPECT_EQ(done.size(), 1u) << "it has not failed";
    EXPECT_TRUE(manager.hung().empty());
    EXPECT_EQ(manager.remote_count(), 0u);
    std::vector<Request> again = manager.reclaim();
    ASSERT_EQ(again.size(), 1u);
    manager.publish(std::move(again));
    ASSERT_TRUE(manager.wait_all());
    collect(manager, 2, done);
    EXPECT_TRUE(done[1].ok && !done[1].remote && done[1].key.model == kCostly);
    EXPECT_EQ(manager.stats().failed, 0u);
    EXPECT_EQ(remote.figures().lost, 1u);
  });
}

// The same model could hang on every rank.
TEST(RemoteModelerPool, AnAbandonedRequestGoesToNoOtherRank) {
  stall(3, [](SynthesisManager& manager, RemoteModelerPool& remote, std::vector<Completion>& done) {
    std::vector<Request> again = manager.reclaim();
    ASSERT_EQ(again.size(), 1u);
    EXPECT_FALSE(manager.is_offered_remotely(again[0]));
    manager.publish(std::move(again));
    ASSERT_TRUE(manager.wait_all());
    collect(manager, 2, done);
    EXPECT_TRUE(done[1].ok && !done[1].remote);
    EXPECT_EQ(remote.figures().lost, 1u);
  });
}

TEST(RemoteModelerPool, TheyServeOneManager) {
  const models::Registry registry = registry_of();
  run({}, [&](RemoteModelerPool& remote) {
    EXPECT_EQ(SynthesisManager(registry, options_with(remote)).remote_count(), 1u);
    SynthesisManager second(registry, options_with(remote));
    EXPECT_EQ(second.remote_count(), 0u);
    Jobs jobs;
    second.publish({jobs.make(registry, 1, kCostly)});
    EXPECT_TRUE(second.wait_all());
  });
}

TEST(RemoteModelerPool, WaitingForAllMakesReturnedRequestsHere) {
  std::atomic<int> damaged{0};
  const models::Registry registry = registry_of();
  const auto reports =
      run({.count = 3,
           .on_send =
               [&](unsigned from, Bytes& bytes) {
                 const auto is_answer = bytes.front() == std::byte{3};
                 if (from != kAnswerer || !is_answer) return;
                 bytes[bytes.size() / 2] ^= std::byte{0x10};
                 ++damaged;
               }},
          [&](RemoteModelerPool& remote) {
            Jobs jobs;
            SynthesisManager manager(registry, options_with(remote));
            std::vector<Completion> done;
            // Until the damaged rank receives a request.
            for (std::uint32_t i = 0; damaged == 0; i += 100) {
              std::vector<Request> plan;
              for (std::uint32_t n = 1; n <= 100; ++n)
                plan.push_back(jobs.make(registry, i + n, kCostly));
              manager.publish(std::move(plan));
              ASSERT_TRUE(manager.wait_all());
              collect(manager, i + 100, done);
            }
            for (const Completion& c : done)
              EXPECT_TRUE(c.ok) << c.error;
            EXPECT_EQ(world_hash(done), [&] {
              synthesis::WorldHash alone;
              for (const Completion& c : done) {
                const auto p = synthesis::testing::parameters_of(c.key.index, 40 + c.key.index);
                const auto mesh = *HeapDestination::make(registry[kCostly], p, 0);
                (void)registry[kCostly].synthesise(p, 0, mesh.view());
                alone.add(synthesis::content_hash(c.key, mesh.view()));
              }
              return alone.value();
            }());
            EXPECT_EQ(remote.figures().lost, 1u);
            EXPECT_EQ(remote.figures().given_back, 1u);
          });
  EXPECT_EQ(reports[kAnswerer].made, 1u);
}

TEST(RemoteModelerPool, AFlightEndsWithPendingRequests) {
  Gate busy, gate;
  const models::Registry registry =
      registry_of([&](const models::Parameters&, int) { busy.wait(); });
  run({.count = 3, .costly_there = [&](const models::Parameters&, int) { gate.wait(); }},
      [&](RemoteModelerPool& remote) {
        Jobs jobs;
        {
          SynthesisManager manager(registry, options_with(remote));
          manager.publish({jobs.make(registry, 1, kBlocker)});
          busy.await(1);
          std::vector<Request> plan;
          for (std::uint32_t i = 2; i <= 9; ++i)
            plan.push_back(jobs.make(registry, i, kCostly));
          manager.publish(std::move(plan));
          gate.await(2);  // both ranks work; their answers arrive when nothing waits for them
          busy.open();
        }
        EXPECT_EQ(remote.figures().meshes, 0u);
        gate.open();
      });
}

TEST(RemoteModelerPool, RequestsWithTypesOrEditsThatOtherRanksLackStayHere) {
  models::Registry registry = registry_of();
  (void)registry.add(std::make_unique<FakeModel>("of_another_world"));
  const models::ModelIndex unknown = 3;
  run({}, [&](RemoteModelerPool& remote) {
    Jobs jobs;
    Request request = jobs.make(registry, 1, kCostly);
    EXPECT_TRUE(remote.takes(registry[kCostly], request));
    EXPECT_FALSE(remote.takes(registry[unknown], request));
    request.cost.seconds.fill(kSendAbove_s);
    EXPECT_FALSE(remote.takes(registry[kCostly], request)) << "not above the threshold";
    request.cost.seconds.fill(1);
    request.edits = std::make_shared<const models::EditLayer>();
    EXPECT_FALSE(remote.takes(registry[kCostly], request));
    // A rank rejects the request if it receives it nevertheless.
    request.edits = nullptr;
    const auto mesh = remote.make(0, registry[unknown], request);
    EXPECT_EQ(mesh.answer, synthesis::RemoteMesh::Answer::kNone);
    EXPECT_EQ(remote.figures().lost, 1u);
  });
}

}  // namespace
}  // namespace psygen::cluster
