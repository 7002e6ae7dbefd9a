// A flight with remote modelers for tests, without MPI: each rank is a thread. Costly meshes go to
// other ranks; cheap ones are made on rank 0.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "engine/cluster/model_server.hpp"
#include "engine/cluster/remote_modeler_pool.hpp"
#include "engine/synthesis/content_hash.hpp"
#include "engine/synthesis/synthesis_manager.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "tests/engine/cluster/threads_as_ranks.hpp"
#include "tests/engine/synthesis/fake_models.hpp"

namespace psygen::cluster::flight {

using synthesis::Completion;
using synthesis::HeapDestination;
using synthesis::Request;
using synthesis::SynthesisManager;
using synthesis::SynthesisOptions;
using synthesis::testing::FakeModel;
using synthesis::testing::Gate;
using synthesis::testing::ScriptedModel;
using Script = ScriptedModel::Script;

inline constexpr models::ModelIndex kBlocker = 0, kCheap = 1, kCostly = 2;
inline constexpr unsigned kAnswerer = 1;  // a rank
inline constexpr double kSendAbove_s = 1e-3;

inline CompatibilityKey key_of(const models::Registry& registry) {
  CompatibilityKey key{"0.1.0", "fake", 1, {}};
  for (models::ModelIndex i = 0; i < registry.size(); ++i)
    key.types.push_back({std::string(registry[i].name()), 0, registry[i].level_count(), 1});
  return key;
}

inline models::Registry registry_of(
    const Script& blocker = [](const models::Parameters&, int) {},
    const Script& costly = [](const models::Parameters&, int) {}) {
  models::Registry registry;
  (void)registry.add(std::make_unique<ScriptedModel>("blocker", blocker));
  (void)registry.add(std::make_unique<FakeModel>("cheap"));
  (void)registry.add(std::make_unique<ScriptedModel>("costly", costly));
  return registry;
}

// Makes requests, each with a destination in its memory, without a cache.
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

// Differences between ranks: the behaviour of a costly model on ranks other than the first.
struct Ranks {
  unsigned count = 2, threads = 1;
  Script costly_there = [](const models::Parameters&, int) {};
  std::function<void(unsigned, Bytes&)> on_send = {};
};

// Runs `fly` on rank 0 with its communicator; the others serve. Returns the statistics of the
// others.
inline std::vector<ServeReport> run(const Ranks& ranks,
                                    const std::function<void(RemoteModelerPool&)>& fly) {
  std::vector<ServeReport> reports(ranks.count);
  ThreadsAsRanks all(ranks.count);
  all.on_send = ranks.on_send;
  const models::Registry here = registry_of();
  const models::Registry there =
      registry_of([](const models::Parameters&, int) {}, ranks.costly_there);
  all.run([&](Peers& peers) {
    const CompatibilityKey key = key_of(here);
    const auto threads = meet(key, ranks.threads, peers);
    ASSERT_TRUE(threads.has_value());
    if (peers.rank() > 0) {
      reports[peers.rank()] = run_model_server(there, ranks.threads, peers).value();
      return;
    }
    const auto remote =
        RemoteModelerPool::start(key, *threads, peers, {.send_above_s = kSendAbove_s}).value();
    fly(*remote);
    EXPECT_TRUE(remote->end());
  });
  for (const ServeReport& report : reports)
    EXPECT_FALSE(report.hangs);
  return reports;
}

inline SynthesisOptions options_with(RemoteModelerPool& remote) {
  SynthesisOptions options;
  options.modelers = 1;
  options.hash_content = true;
  options.watchdog_seconds = 0;
  options.remote = &remote;
  return options;
}

// Waits until `count` completions have been collected in total.
inline void collect(SynthesisManager& manager, std::size_t count, std::vector<Completion>& done) {
  while (done.size() < count) {
    manager.collect(done);
    std::this_thread::yield();
  }
}

inline std::uint64_t world_hash(const std::vector<Completion>& done) {
  synthesis::WorldHash hash;
  for (const Completion& c : done)
    hash.add(c.content_hash);
  return hash.value();
}

}  // namespace psygen::cluster::flight
