// Tests the failures of a rank that serves meshes.
#include "engine/cluster/model_server.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <stdexcept>
#include <thread>

#include "engine/cluster/mesh_messages.hpp"
#include "tests/engine/cluster/flight_ranks.hpp"
#include "tests/faults.hpp"

namespace psygen::cluster {
namespace {

using namespace flight;

TEST(ServeModels, ADamagedRequestGoesBack) {
  const models::Registry registry = registry_of();
  std::atomic<int> damaged{0};
  const auto reports = run({.on_send =
                                [&](unsigned from, Bytes& bytes) {
                                  const auto is_request = bytes.front() == std::byte{2};
                                  if (from == 0 && is_request && damaged++ == 0)
                                    bytes[20] ^= std::byte{1};
                                }},
                           [&](RemoteModelerPool& remote) {
                             Jobs jobs;
                             synthesis::RemoteMesh mesh =
                                 remote.make(0, registry[kCostly], jobs.make(registry, 1, kCostly));
                             EXPECT_EQ(mesh.answer, synthesis::RemoteMesh::Answer::kNone);
                             EXPECT_FALSE(remote.is_usable(0));
                           });
  EXPECT_EQ(reports[kAnswerer].refused, 1u);
}

TEST(ServeModels, ARemoteFailureHasTheSameMessageAsALocalOne) {
  const auto fails = [](const models::Parameters&, int) { throw std::runtime_error("too steep"); };
  const models::Registry registry = registry_of([](const models::Parameters&, int) {}, fails);
  const auto reports = run({.costly_there = fails}, [&](RemoteModelerPool& remote) {
    Jobs jobs;
    const auto mesh = remote.make(0, registry[kCostly], jobs.make(registry, 1, kCostly));
    EXPECT_EQ(mesh.answer, synthesis::RemoteMesh::Answer::kFailed);
    const auto p = synthesis::testing::parameters_of(1, 41);
    const auto place = *HeapDestination::make(registry[kCostly], p, 0);
    EXPECT_EQ(mesh.error,
              synthesis::synthesise_guarded(registry[kCostly], p, 0, place.view()).error);
    EXPECT_TRUE(remote.is_usable(0));
  });
  EXPECT_EQ(reports[kAnswerer].failed, 1u);
}

TEST(ServeModels, ARankWithoutMemoryReturnsTheRequest) {
  const auto reports =
      run({.costly_there = [](const models::Parameters&, int) { throw std::bad_alloc(); }},
          [](RemoteModelerPool& remote) {
            const models::Registry registry = registry_of();
            Jobs jobs;
            const auto mesh = remote.make(0, registry[kCostly], jobs.make(registry, 1, kCostly));
            EXPECT_EQ(mesh.answer, synthesis::RemoteMesh::Answer::kNone);
            EXPECT_FALSE(remote.is_usable(0));
          });
  EXPECT_EQ(reports[kAnswerer].failed, 1u);
}

TEST(ServeModels, ARankThatGetsFewerThreadsThanItAnnouncedFails) {
  const models::Registry registry = registry_of();
  ThreadsAsRanks(1).run([&](Peers& peers) {
    peers.send(0, plain_message(MessageKind::kEnd));
    const FewThreads few(1);
    const auto served = run_model_server(registry, 2, peers);
    ASSERT_FALSE(served.has_value());
    EXPECT_TRUE(served.error().message.starts_with(
        "started only 1 of 2 modeler threads: the system gives no more threads"))
        << served.error().message;
  });
}

// The hanging thread stays until this process ends, as in a real rank: if it continued, it would
// use models that no longer exist.
TEST(ServeModels, AModelThatHangsOnAnotherRankDoesNotDelayTheEnd) {
  static Gate hangs;
  static const models::Registry there = registry_of(
      [](const models::Parameters&, int) {}, [](const models::Parameters&, int) { hangs.wait(); });
  bool noticed = false;
  ThreadsAsRanks(2).run([&](Peers& peers) {
    const CompatibilityKey key = key_of(there);
    const auto threads = meet(key, 1, peers).value();
    if (peers.rank() > 0) {
      noticed = run_model_server(there, 1, peers, 0).value().hangs;
      return;
    }
    const auto remote =
        RemoteModelerPool::start(key, threads, peers, {.send_above_s = kSendAbove_s}).value();
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
}

}  // namespace
}  // namespace psygen::cluster
