// Tests a mesh supply that quiesces while remote modelers work. Here these wait for a gate, which
// opens once the main thread waits for them: it then polls the clock.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <iterator>
#include <thread>

#include "engine/core/geometry_memory.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "tests/engine/synthesis/fake_models.hpp"

namespace psygen::synthesis {
namespace {

constexpr models::ModelIndex kNear = 0, kFar = 1;

// One slot, which takes all meshes of kFar.
class MadeBehindAGate final : public RemoteModelers {
 public:
  unsigned count() const override { return 1; }
  bool takes(const models::ModelType&, const Request& request) const override {
    return request.key.model == kFar;
  }
  RemoteMesh make(unsigned, const models::ModelType& type, const Request& request) override {
    gate.wait();
    RemoteMesh mesh;
    if (!answers) return mesh;
    const auto place = HeapDestination::make(type, request.parameters, request.key.level).value();
    mesh.tight =
        synthesise_guarded(type, request.parameters, request.key.level, place.view()).tight;
    std::ranges::copy(place.view().vertices, std::back_inserter(mesh.storage));
    std::ranges::copy(std::as_bytes(place.view().indices), std::back_inserter(mesh.storage));
    mesh.answer = RemoteMesh::Answer::kMade;
    mesh.bytes = mesh.storage;
    return mesh;
  }
  bool is_usable(unsigned) const override { return true; }
  void cancel(unsigned, bool) override { gate.open(); }

  testing::Gate gate;
  bool answers = true;
};

class RemoteRest : public ::testing::Test {
 protected:
  RemoteRest() {
    (void)registry_.add(std::make_unique<testing::ScriptedModel>(
        "near", [this](const models::Parameters&, int) { near_.wait(); }));
    (void)registry_.add(std::make_unique<testing::ScriptedModel>(
        "far", [this](const models::Parameters&, int) { ++made_far_; }));
    meshes_.open(registry_, memory_, 1 << 20);
    SynthesisOptions options;
    options.modelers = 1;
    options.max_replacements = 0;
    options.clock = [this] {
      if (is_resting_ && ++looks_ > 5) remote_.gate.open();
      return now_s_.load();
    };
    options.remote = &remote_;
    EXPECT_EQ(meshes_.start_modelers(options), 1u);
  }
  ~RemoteRest() override {
    near_.open();
    while (!meshes_.quiesce())
      std::this_thread::yield();
  }

  void want(std::initializer_list<models::ModelIndex> models) {
    meshes_.begin_wants();
    for (const models::ModelIndex model : models)
      meshes_.want({key_of(model), &parameters_, model, testing::hole(1), 0});
    PlanLimits limits;
    limits.seconds_ahead = 1e6;
    EXPECT_EQ(meshes_.plan(limits, Policy::kFifo).published, models.size());
  }
  MeshKey key_of(models::ModelIndex model) const {
    return testing::key_of(model, parameters_, model);
  }
  bool quiesce() {
    is_resting_ = true;
    return meshes_.quiesce();
  }

  std::atomic<double> now_s_{0};
  std::atomic<bool> is_resting_{false};
  std::atomic<int> looks_{0}, made_far_{0};
  testing::Gate near_;
  MadeBehindAGate remote_;
  models::Registry registry_;
  core::HeapGeometryMemory memory_{1 << 20};
  const models::Parameters parameters_ = testing::parameters_of(1, 40);
  MeshSupply meshes_;
};

TEST_F(RemoteRest, WithoutALocalModelerItWaitsForRemoteOnes) {
  want({kNear});
  near_.await(1);
  now_s_ = 11;
  meshes_.collect();  // the only local modeler is abandoned
  want({kFar});
  remote_.gate.await(1);
  EXPECT_FALSE(quiesce()) << "one modeler hangs";
  EXPECT_EQ(meshes_.outstanding(), 0u);
  EXPECT_NE(meshes_.ready(meshes_.find(key_of(kFar))), nullptr);
}

TEST_F(RemoteRest, AReturnedRequestIsNotMade) {
  remote_.answers = false;
  want({kNear, kFar});
  near_.await(1);
  remote_.gate.await(1);
  near_.open();
  EXPECT_TRUE(quiesce());
  EXPECT_EQ(meshes_.outstanding(), 0u);
  EXPECT_EQ(made_far_, 0);
  EXPECT_FALSE(meshes_.find(key_of(kFar)));
  // The mesh may be requested again.
  want({kFar});
  EXPECT_TRUE(meshes_.wait());
  EXPECT_EQ(made_far_, 1);
}

}  // namespace
}  // namespace psygen::synthesis
