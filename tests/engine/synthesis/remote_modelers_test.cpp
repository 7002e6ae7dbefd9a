// Tests the plan, the manager and the planner with modelers outside this process. Here these make
// their meshes at once, in the calling thread.
#include "engine/synthesis/remote_modelers.hpp"

#include <gtest/gtest.h>

#include <any>
#include <atomic>
#include <map>
#include <thread>

#include "engine/core/geometry_memory.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/synthesis/planner.hpp"
#include "engine/synthesis/synthesis_manager.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "tests/engine/synthesis/fake_models.hpp"

namespace psygen::synthesis {
namespace {

using testing::FakeModel;
using testing::key_of;
using testing::parameters_of;
using testing::registry_of;

constexpr double kTakesAbove_s = 1e-3;

class MadeAtOnce final : public RemoteModelers {
 public:
  explicit MadeAtOnce(unsigned places) : places_(places) {}
  unsigned count() const override { return places_; }
  bool takes(const models::ModelType&, const Request& request) const override {
    return request.cost.warm_s() > kTakesAbove_s;
  }
  RemoteMesh make(unsigned, const models::ModelType& type, const Request& request) override {
    made_.fetch_add(1);
    RemoteMesh mesh;
    if (answers_nothing) return mesh;
    const auto place = HeapDestination::make(type, request.parameters, request.key.level).value();
    const SynthesisOutcome outcome =
        synthesise_guarded(type, request.parameters, request.key.level, place.view());
    for (const std::byte byte : place.view().vertices)
      mesh.storage.push_back(byte);
    for (const std::byte byte : std::as_bytes(place.view().indices))
      mesh.storage.push_back(byte);
    mesh.answer = RemoteMesh::Answer::kMade;
    mesh.bytes = mesh.storage;
    mesh.tight = outcome.tight;
    mesh.seconds = 0.5;
    return mesh;
  }
  bool is_usable(unsigned) const override { return !answers_nothing || made_ == 0; }
  void cancel(unsigned, bool) override {}
  unsigned made() const { return made_; }

  bool answers_nothing = false;

 private:
  const unsigned places_;
  std::atomic<unsigned> made_{0};
};

Request request_of(std::uint32_t index, double cost_s) {
  Request request;
  request.handle = {index, 1};
  request.parameters = parameters_of(index, 40);
  request.key = key_of(index, request.parameters);
  request.cost.seconds.fill(cost_s);
  return request;
}

TEST(PlanQueue, EveryRequestIsClaimedOnceFromEitherSideOrReturned) {
  constexpr std::uint32_t kRequests = 64;
  constexpr int kRounds = 400;
  PlanQueue board;
  std::atomic<bool> stop{false};
  std::vector<std::vector<std::uint32_t>> claimed(4);
  std::vector<std::jthread> claimers;
  for (unsigned i = 0; i < 4; ++i) {
    const auto side = i % 2 == 1 ? PlanQueue::Side::kRemote : PlanQueue::Side::kLocal;
    claimers.emplace_back([&, i, reader = board.add_reader(side)] {
      Request request;
      std::uint64_t retries = 0;
      while (!stop) {
        if (board.claim(*reader, request, retries))
          claimed[i].push_back(request.handle.slot);
        else
          std::this_thread::yield();
      }
    });
  }
  std::vector<Request> unclaimed;
  std::uint64_t told = 0;
  for (std::uint32_t round = 0; round < kRounds; ++round) {
    std::vector<Request> plan;
    std::vector<std::uint32_t> offered;
    for (std::uint32_t i = 0; i < kRequests; ++i) {
      plan.push_back(request_of(round * kRequests + i, 0));
      if (i % 3 != 0) offered.push_back(i);
    }
    board.publish(std::move(plan), std::move(offered));
    if (round % 4 != 0) std::this_thread::yield();
    told += board.close(unclaimed);
  }
  stop = true;
  claimers.clear();
  std::map<std::uint32_t, int> seen;
  for (unsigned i = 0; i < 4; ++i) {
    for (const std::uint32_t slot : claimed[i]) {
      ++seen[slot];
      const bool was_offered = slot % kRequests % 3 != 0;
      EXPECT_TRUE(i % 2 == 0 || was_offered) << slot;
    }
  }
  EXPECT_EQ(told, seen.size());
  for (const Request& request : unclaimed)
    ++seen[request.handle.slot];
  EXPECT_EQ(seen.size(), std::size_t{kRounds} * kRequests);
  for (const auto& [slot, times] : seen)
    ASSERT_EQ(times, 1) << slot;
}

TEST(PlanQueue, RemoteModelersAreWokenOnlyIfSomethingIsOffered) {
  PlanQueue board;
  std::vector<Request> unclaimed;
  const auto here = board.add_reader(), there = board.add_reader(PlanQueue::Side::kRemote);
  const std::uint32_t before = board.epoch(*there), plans = board.epoch(*here);
  board.publish({request_of(0, 0)});
  EXPECT_EQ(board.epoch(*there), before);
  EXPECT_NE(board.epoch(*here), plans);
  board.close(unclaimed);
  board.publish({request_of(0, 0)}, {0});
  const std::uint32_t offered = board.epoch(*there);
  EXPECT_NE(offered, before);
  board.wake(PlanQueue::Side::kRemote);
  EXPECT_NE(board.epoch(*there), offered) << "as at the end of the manager";
}

TEST(PlanQueue, ARemotelyClaimedRequestIsNotReturned) {
  PlanQueue board;
  const auto here = board.add_reader(), there = board.add_reader(PlanQueue::Side::kRemote);
  board.publish({request_of(0, 0), request_of(1, 0), request_of(2, 0), request_of(3, 0)}, {1, 3});
  Request request;
  std::uint64_t retries = 0;
  ASSERT_TRUE(board.claim(*there, request, retries));
  EXPECT_EQ(request.handle.slot, 1u);
  ASSERT_TRUE(board.claim(*here, request, retries));
  EXPECT_EQ(request.handle.slot, 0u);
  ASSERT_TRUE(board.claim(*here, request, retries));
  EXPECT_EQ(request.handle.slot, 2u) << "the one before was claimed";
  std::vector<Request> unclaimed;
  EXPECT_EQ(board.close(unclaimed), 3u);
  ASSERT_EQ(unclaimed.size(), 1u);
  EXPECT_EQ(unclaimed[0].handle.slot, 3u);
  EXPECT_FALSE(board.claim(*there, request, retries));
}

// Wanted meshes of one cache, planned with remote modelers.
class Planned : public ::testing::Test {
 protected:
  PlanReport plan(unsigned places, std::vector<Annotate> annotate = {},
                  bool answers_nothing = false) {
    remote_ = std::make_unique<MadeAtOnce>(places);
    remote_->answers_nothing = answers_nothing;
    for (std::uint32_t i = 0; i < 100; ++i)
      parameters_.push_back(parameters_of(i, 40));
    std::vector<Want> wants;
    for (std::uint32_t i = 0; i < 100; ++i)
      wants.push_back(
          {key_of(i, parameters_[i]), &parameters_[i], i, testing::hole(static_cast<float>(i)), 0});
    SynthesisOptions options;
    options.modelers = 1;
    options.remote = remote_.get();
    options.annotate = std::move(annotate);
    manager_.emplace(registry_, options);
    return planner_.plan(wants, cache_, cost_, *manager_, {.seconds_ahead = 0.05});
  }
  std::vector<Completion> land_all() {
    std::vector<Completion> done;
    EXPECT_TRUE(manager_->wait_all());
    manager_->collect(done);
    land(done, cache_, &cost_);
    return done;
  }

  // Its mesh is predicted to take 10 ms.
  struct SlowModel : FakeModel {
    double steps(const models::Parameters&, int) const override { return 1; }
    double step_seconds() const override { return 10e-3; }
  };
  models::Registry registry_ = registry_of(std::make_unique<SlowModel>());
  core::HeapGeometryMemory memory_{64 << 20};
  GeometryCache cache_{memory_, registry_, 64 << 20};
  CostModel cost_{registry_};
  Planner planner_;
  std::vector<models::Parameters> parameters_;
  std::unique_ptr<MadeAtOnce> remote_;
  std::optional<SynthesisManager> manager_;
};

TEST_F(Planned, WithoutRemoteModelersThePlanIsEnoughForOne) {
  EXPECT_EQ(plan(0).published, 5u);
  EXPECT_EQ(manager_->remote_count(), 0u);
}

TEST_F(Planned, ThreeRemoteModelersExtendThePlanAccordingly) {
  EXPECT_EQ(plan(3).published, 20u);
  EXPECT_EQ(manager_->modeler_count(), 1u);
  EXPECT_EQ(manager_->remote_count(), 3u);
  const std::vector<Completion> done = land_all();
  EXPECT_EQ(done.size(), 20u);
  const auto there = std::ranges::count_if(done, [](const Completion& c) { return c.remote; });
  EXPECT_EQ(static_cast<unsigned>(there), remote_->made());
}

TEST_F(Planned, ReceivedMeshesAreAnnotatedHere) {
  plan(2, {[](const Request& request, const models::MeshView& mesh) {
         return std::any(mesh.vertices.size() + request.key.index);
       }});
  for (const Completion& c : land_all()) {
    const MeshRecord* record = cache_.get(c.handle);
    ASSERT_TRUE(record != nullptr && record->state == MeshState::kReady);
    EXPECT_EQ(std::any_cast<std::size_t>(record->note), 40 * 16 + std::size_t{c.key.index});
    const auto place = HeapDestination::make(registry_[0], parameters_[c.key.index], 0).value();
    (void)registry_[0].synthesise(parameters_[c.key.index], 0, place.view());
    EXPECT_TRUE(std::ranges::equal(memory_.vertex_bytes(record->range), place.view().vertices));
    EXPECT_TRUE(std::ranges::equal(memory_.indices(record->range), place.view().indices));
  }
}

TEST_F(Planned, TheCostModelLearnsNothingFromOtherMachines) {
  plan(1);
  std::vector<Completion> there, here;
  EXPECT_TRUE(manager_->wait_all());
  manager_->collect(there);
  ASSERT_GE(there.size(), 2U);
  here.push_back(there.back());
  there.pop_back();
  for (Completion& c : there)
    c.remote = true, c.seconds = 0.5;
  here[0].remote = false, here[0].seconds = 0.5;
  const auto predicted_s = [&] {
    return cost_.predict_request(0, 0, cost_.work(0, parameters_[0], 0)).warm_s();
  };
  const double before = predicted_s();
  land(there, cache_, &cost_);
  EXPECT_EQ(predicted_s(), before);
  land(here, cache_, &cost_);
  EXPECT_GT(predicted_s(), before);
}

TEST_F(Planned, WaitingForAllMakesReturnedRequestsHere) {
  EXPECT_EQ(plan(2, {}, true).published, 15u);
  const std::vector<Completion> done = land_all();
  EXPECT_EQ(done.size(), 15u);
  for (const Completion& c : done)
    EXPECT_TRUE(c.ok && !c.remote) << c.error;
}

}  // namespace
}  // namespace psygen::synthesis
