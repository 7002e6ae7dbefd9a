// A flight whose meshes other ranks make, without MPI: ranks are threads.
#include "engine/cluster/remote_models.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <map>

#include "engine/cluster/mesh_messages.hpp"
#include "engine/cluster/serve_models.hpp"
#include "engine/models/edits.hpp"
#include "engine/synthesis/content_hash.hpp"
#include "engine/synthesis/synthesis_manager.hpp"
#include "engine/synthesis/synthesize.hpp"
#include "tests/engine/cluster/threads_as_ranks.hpp"
#include "tests/engine/synthesis/fake_models.hpp"
#include "tests/engine/world/shipped.hpp"
#include "tests/faults.hpp"

namespace psygen::cluster {
namespace {

using synthesis::Completion;
using synthesis::HeapDestination;
using synthesis::Request;
using synthesis::SynthesisManager;
using synthesis::SynthesisOptions;
using synthesis::testing::FakeModel;
using synthesis::testing::Gate;
using synthesis::testing::ScriptedModel;
using Script = ScriptedModel::Script;

constexpr models::ModelIndex kBlocker = 0, kCheap = 1, kCostly = 2;
constexpr unsigned kAnswerer = 1;  // a rank
constexpr double kSendAbove_s = 1e-3;

FlightKey key_of(const models::Registry& registry) {
  FlightKey key{"0.1.0", "fake", 1, {}};
  for (models::ModelIndex i = 0; i < registry.size(); ++i)
    key.types.push_back({std::string(registry[i].name()), 0, registry[i].level_count(), 1});
  return key;
}

models::Registry registry_of(
    const Script& blocker = [](const models::Parameters&, int) {},
    const Script& costly = [](const models::Parameters&, int) {}) {
  models::Registry registry;
  (void)registry.add(std::make_unique<ScriptedModel>("blocker", blocker));
  (void)registry.add(std::make_unique<FakeModel>("cheap"));
  (void)registry.add(std::make_unique<ScriptedModel>("costly", costly));
  return registry;
}

// Requests with destinations of their own, without a cache.
class Jobs {
 public:
  Request make(const models::Registry& registry, std::uint32_t index, models::ModelIndex model) {
    const auto p = synthesis::testing::parameters_of(index, 40 + index);
    places_.push_back(*HeapDestination::make(registry[model], p, 0));
    Request r;
    r.handle = {index, 1};
    r.key = synthesis::testing::key_of(index, p, model, 0);
    r.parameters = p;
    r.destination = places_.back().view();
    r.size = places_.back().size();
    r.cost.seconds.fill(model == kCostly ? 20e-3 : 10e-6);
    return r;
  }

 private:
  std::vector<HeapDestination> places_;
};

// What differs between ranks: what a costly model does on other ranks than the first.
struct Ranks {
  unsigned count = 2, threads = 1;
  Script costly_there = [](const models::Parameters&, int) {};
  std::function<void(unsigned, Bytes&)> on_send = {};
};

// Rank 0 calls `fly` with its peers; the others serve. Returns what they did.
std::vector<ServeReport> run(const Ranks& ranks, const std::function<void(RemoteModels&)>& fly) {
  std::vector<ServeReport> reports(ranks.count);
  ThreadsAsRanks all(ranks.count);
  all.on_send = ranks.on_send;
  const models::Registry here = registry_of();
  const models::Registry there =
      registry_of([](const models::Parameters&, int) {}, ranks.costly_there);
  all.run([&](Peers& peers) {
    const FlightKey key = key_of(here);
    const auto threads = meet(key, ranks.threads, peers);
    ASSERT_TRUE(threads.has_value());
    if (peers.rank() > 0) {
      reports[peers.rank()] = serve_models(there, ranks.threads, peers).value();
      return;
    }
    const auto remote =
        RemoteModels::start(key, *threads, peers, {.send_above_s = kSendAbove_s}).value();
    fly(*remote);
    EXPECT_TRUE(remote->end());
  });
  for (const ServeReport& report : reports)
    EXPECT_FALSE(report.hangs);
  return reports;
}

SynthesisOptions options_with(RemoteModels& remote) {
  SynthesisOptions options;
  options.modelers = 1;
  options.hash_content = true;
  options.watchdog_seconds = 0;
  options.remote = &remote;
  return options;
}

// Until so many have been collected in all.
void collect(SynthesisManager& manager, std::size_t count, std::vector<Completion>& done) {
  while (done.size() < count) {
    manager.collect(done);
    std::this_thread::yield();
  }
}

std::uint64_t world_hash(const std::vector<Completion>& done) {
  synthesis::WorldHash hash;
  for (const Completion& c : done)
    hash.add(c.content_hash);
  return hash.value();
}

TEST(RemoteModels, CostlyRequestsGoAndCheapOnesStay) {
  Gate gate;
  const models::Registry registry =
      registry_of([&](const models::Parameters&, int) { gate.wait(); });
  RemoteFigures figures;
  const auto reports = run({}, [&](RemoteModels& remote) {
    Jobs jobs;
    SynthesisManager manager(registry, options_with(remote));
    manager.publish({jobs.make(registry, 1, kBlocker)});
    gate.await(1);  // the only modeler that may make cheap ones is busy now
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

TEST(RemoteModels, TheWorldIsTheSameForAnyNumberOfRanks) {
  std::map<unsigned, std::uint64_t> hashes;
  const models::Registry registry = registry_of();
  for (const unsigned count : {1u, 2u, 4u}) {
    run({.count = count, .threads = 2}, [&](RemoteModels& remote) {
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

TEST(RemoteModels, AStalledRankIsGivenUpAndItsMeshIsMadeHere) {
  Gate busy, stalled;
  std::atomic<double> now_s{0};
  const models::Registry registry =
      registry_of([&](const models::Parameters&, int) { busy.wait(); });
  run({.costly_there = [&](const models::Parameters&, int) { stalled.wait(); }},
      [&](RemoteModels& remote) {
        Jobs jobs;
        SynthesisOptions options = options_with(remote);
        options.watchdog_seconds = 10;
        options.clock = [&] { return now_s.load(); };
        SynthesisManager manager(registry, options);
        manager.publish({jobs.make(registry, 1, kBlocker)});
        busy.await(1);
        manager.publish({jobs.make(registry, 2, kCostly)});
        stalled.await(1);
        busy.open();
        std::vector<Completion> done;
        collect(manager, 1, done);
        now_s = 11;
        manager.collect(done);
        EXPECT_EQ(done.size(), 1u) << "it is not failed";
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
        stalled.open();
      });
}

// It would hang at every one of them.
TEST(RemoteModels, WhatARankWasGivenUpWithGoesToNoOther) {
  Gate busy, stalled;
  std::atomic<double> now_s{0};
  const models::Registry registry =
      registry_of([&](const models::Parameters&, int) { busy.wait(); });
  run({.count = 3, .costly_there = [&](const models::Parameters&, int) { stalled.wait(); }},
      [&](RemoteModels& remote) {
        Jobs jobs;
        SynthesisOptions options = options_with(remote);
        options.watchdog_seconds = 10;
        options.clock = [&] { return now_s.load(); };
        SynthesisManager manager(registry, options);
        manager.publish({jobs.make(registry, 1, kBlocker)});
        busy.await(1);
        const Request costly = jobs.make(registry, 2, kCostly);
        EXPECT_TRUE(manager.may_go(costly));
        manager.publish({costly});
        stalled.await(1);
        busy.open();
        std::vector<Completion> done;
        collect(manager, 1, done);
        now_s = 11;
        std::vector<Request> again = manager.reclaim();
        ASSERT_EQ(again.size(), 1u);
        EXPECT_FALSE(manager.may_go(again[0]));
        manager.publish(std::move(again));
        ASSERT_TRUE(manager.wait_all());
        collect(manager, 2, done);
        EXPECT_TRUE(done[1].ok && !done[1].remote);
        EXPECT_EQ(remote.figures().lost, 1u);
        stalled.open();
      });
}

TEST(RemoteModels, TheyServeOneManager) {
  const models::Registry registry = registry_of();
  run({}, [&](RemoteModels& remote) {
    EXPECT_EQ(SynthesisManager(registry, options_with(remote)).remote_count(), 1u);
    SynthesisManager second(registry, options_with(remote));
    EXPECT_EQ(second.remote_count(), 0u);
    Jobs jobs;
    second.publish({jobs.make(registry, 1, kCostly)});
    EXPECT_TRUE(second.wait_all());
  });
}

TEST(RemoteModels, WaitingForAllMakesHereWhatCameBackWithoutAMesh) {
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
          [&](RemoteModels& remote) {
            Jobs jobs;
            SynthesisManager manager(registry, options_with(remote));
            std::vector<Completion> done;
            // Until the damaged rank got one.
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
                (void)registry[kCostly].synthesize(p, 0, mesh.view());
                alone.add(synthesis::content_hash(c.key, mesh.view()));
              }
              return alone.value();
            }());
            EXPECT_EQ(remote.figures().lost, 1u);
            EXPECT_EQ(remote.figures().given_back, 1u);
          });
  EXPECT_EQ(reports[kAnswerer].made, 1u);
}

TEST(RemoteModels, ARequestThatComesDamagedGoesBack) {
  const models::Registry registry = registry_of();
  std::atomic<int> damaged{0};
  const auto reports = run({.on_send =
                                [&](unsigned from, Bytes& bytes) {
                                  const auto is_request = bytes.front() == std::byte{2};
                                  if (from == 0 && is_request && damaged++ == 0)
                                    bytes[20] ^= std::byte{1};
                                }},
                           [&](RemoteModels& remote) {
                             Jobs jobs;
                             synthesis::RemoteMesh mesh =
                                 remote.make(0, registry[kCostly], jobs.make(registry, 1, kCostly));
                             EXPECT_EQ(mesh.answer, synthesis::RemoteMesh::Answer::kNone);
                             EXPECT_FALSE(remote.is_usable(0));
                           });
  EXPECT_EQ(reports[kAnswerer].refused, 1u);
}

TEST(RemoteModels, AFailureThereIsTheSameSentenceAsHere) {
  const auto fails = [](const models::Parameters&, int) { throw std::runtime_error("too steep"); };
  const models::Registry registry = registry_of([](const models::Parameters&, int) {}, fails);
  const auto reports = run({.costly_there = fails}, [&](RemoteModels& remote) {
    Jobs jobs;
    const auto mesh = remote.make(0, registry[kCostly], jobs.make(registry, 1, kCostly));
    EXPECT_EQ(mesh.answer, synthesis::RemoteMesh::Answer::kFailed);
    const auto p = synthesis::testing::parameters_of(1, 41);
    const auto place = *HeapDestination::make(registry[kCostly], p, 0);
    EXPECT_EQ(mesh.error,
              synthesis::synthesize_guarded(registry[kCostly], p, 0, place.view()).error);
    EXPECT_TRUE(remote.is_usable(0));
  });
  EXPECT_EQ(reports[kAnswerer].failed, 1u);
}

TEST(RemoteModels, WhereMemoryRunsOutThereTheRequestComesBack) {
  const auto reports =
      run({.costly_there = [](const models::Parameters&, int) { throw std::bad_alloc(); }},
          [](RemoteModels& remote) {
            const models::Registry registry = registry_of();
            Jobs jobs;
            const auto mesh = remote.make(0, registry[kCostly], jobs.make(registry, 1, kCostly));
            EXPECT_EQ(mesh.answer, synthesis::RemoteMesh::Answer::kNone);
            EXPECT_FALSE(remote.is_usable(0));
          });
  EXPECT_EQ(reports[kAnswerer].failed, 1u);
}

TEST(RemoteModels, ARankThatGetsFewerThreadsThanItToldSaysSo) {
  const models::Registry registry = registry_of();
  ThreadsAsRanks(1).run([&](Peers& peers) {
    peers.send(0, plain_message(MessageKind::kEnd));
    const FewThreads few(1);
    const auto served = serve_models(registry, 2, peers);
    ASSERT_FALSE(served.has_value());
    EXPECT_TRUE(served.error().message.starts_with(
        "only 1 of 2 threads that make meshes were started: the system gives no more threads"))
        << served.error().message;
  });
}

TEST(RemoteModels, AFlightEndsWithRequestsInTheAir) {
  Gate busy, gate;
  const models::Registry registry =
      registry_of([&](const models::Parameters&, int) { busy.wait(); });
  run({.count = 3, .costly_there = [&](const models::Parameters&, int) { gate.wait(); }},
      [&](RemoteModels& remote) {
        Jobs jobs;
        {
          SynthesisManager manager(registry, options_with(remote));
          manager.publish({jobs.make(registry, 1, kBlocker)});
          busy.await(1);
          std::vector<Request> plan;
          for (std::uint32_t i = 2; i <= 9; ++i)
            plan.push_back(jobs.make(registry, i, kCostly));
          manager.publish(std::move(plan));
          gate.await(2);  // both ranks work, and the answers come when nobody waits any more
          busy.open();
        }
        EXPECT_EQ(remote.figures().meshes, 0u);
        gate.open();
      });
}

// What a thread that was left to itself uses lives on.
TEST(RemoteModels, AModelThatHangsAtAnotherRankHoldsUpNoEnd) {
  static Gate hangs;
  static const models::Registry there = registry_of(
      [](const models::Parameters&, int) {}, [](const models::Parameters&, int) { hangs.wait(); });
  bool noticed = false;
  ThreadsAsRanks(2).run([&](Peers& peers) {
    const FlightKey key = key_of(there);
    const auto threads = meet(key, 1, peers).value();
    if (peers.rank() > 0) {
      noticed = serve_models(there, 1, peers, 0).value().hangs;
      return;
    }
    const auto remote =
        RemoteModels::start(key, threads, peers, {.send_above_s = kSendAbove_s}).value();
    Jobs jobs;
    const Request request = jobs.make(there, 1, kCostly);
    std::jthread waits([&] {
      EXPECT_EQ(remote->make(0, there[kCostly], request).answer,
                synthesis::RemoteMesh::Answer::kNone);
    });
    hangs.await(1);
    remote->cancel(0, true);
    EXPECT_TRUE(remote->end());
  });
  EXPECT_TRUE(noticed);
  hangs.open();
}

TEST(RemoteModels, TypesAndEditsThatOtherRanksDoNotHaveStayHere) {
  models::Registry registry = registry_of();
  (void)registry.add(std::make_unique<FakeModel>("of_another_world"));
  const models::ModelIndex unknown = 3;
  run({}, [&](RemoteModels& remote) {
    Jobs jobs;
    Request request = jobs.make(registry, 1, kCostly);
    EXPECT_TRUE(remote.takes(registry[kCostly], request));
    EXPECT_FALSE(remote.takes(registry[unknown], request));
    request.cost.seconds.fill(kSendAbove_s);
    EXPECT_FALSE(remote.takes(registry[kCostly], request)) << "not above";
    request.cost.seconds.fill(1);
    request.edits = std::make_shared<const models::EditLayer>();
    EXPECT_FALSE(remote.takes(registry[kCostly], request));
    // Should it be asked all the same, a rank refuses.
    request.edits = nullptr;
    const auto mesh = remote.make(0, registry[unknown], request);
    EXPECT_EQ(mesh.answer, synthesis::RemoteMesh::Answer::kNone);
    EXPECT_EQ(remote.figures().lost, 1u);
  });
}

TEST(Meeting, RanksThatMakeOtherMeshesAreRefusedWithTheirNumberAndMachine) {
  const models::Registry standard = models::make_standard_registry();
  const world::World world = world::testing::parsed(world::testing::kSmallWorld);
  const auto sentence = [&](const std::function<void(FlightKey&)>& change) {
    std::string said;
    ThreadsAsRanks(3).run([&](Peers& peers) {
      FlightKey key = flight_key(world, standard, "0.1.0");
      if (peers.rank() == 2) change(key);
      const auto met = meet(key, peers.rank() + 1, peers);
      if (peers.rank() == 1) said = met ? std::string() : met.error().message;
      if (met) {
        EXPECT_EQ(*met, (std::vector<unsigned>{1, 2, 3}));
      }
    });
    return said;
  };
  EXPECT_EQ(sentence([](FlightKey&) {}), "");
  EXPECT_EQ(sentence([](FlightKey& key) { key.version = "0.2.0"; }),
            "rank 2 (host2) does not fit rank 0 (host0): it has psygen 0.2.0 instead of 0.1.0");
  EXPECT_EQ(sentence([](FlightKey& key) { key.types.pop_back(); }),
            "rank 2 (host2) does not fit rank 0 (host0): it has 3 model types instead of 4");
  EXPECT_EQ(sentence([](FlightKey& key) { key.types[2].sample_hash ^= 1; }),
            "rank 2 (host2) does not fit rank 0 (host0): it has another edition of the model type "
            "tree, which makes other meshes");
  EXPECT_EQ(
      sentence([](FlightKey& key) { key.world_hash ^= 1; }),
      "rank 2 (host2) does not fit rank 0 (host0): it has another version of the world small");
}

}  // namespace
}  // namespace psygen::cluster
