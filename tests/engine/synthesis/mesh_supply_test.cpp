#include "engine/synthesis/mesh_supply.hpp"

#include <gtest/gtest.h>

#include "engine/core/geometry_memory.hpp"
#include "tests/engine/synthesis/fake_models.hpp"

namespace psygen::synthesis {
namespace {

using testing::FakeModel;
using testing::key_of;
using testing::kMeshBytes;
using testing::parameters_of;
using testing::registry_of;

class MeshSupplyTest : public ::testing::Test {
 protected:
  MeshSupplyTest() {
    meshes.open(registry, memory, 1 << 20);
    SynthesisOptions options;
    options.modelers = 1;
    EXPECT_EQ(meshes.start_modelers(options), 1u);
    EXPECT_EQ(meshes.shortage(), "");
  }
  // Requests meshes 0 … n − 1 in this order and waits until they are synthesised.
  void make(std::uint32_t n) {
    meshes.begin_wants();
    for (std::uint32_t i = 0; i < n; ++i) {
      parameters.push_back(std::make_unique<models::Parameters>(parameters_of(i, 80)));
      keys.push_back(key_of(i, *parameters.back(), 0));
      meshes.want({keys.back(), parameters.back().get(), i,
                   Rank::by_layer(RankGroup::kVisibleHole, 0, static_cast<float>(i)), 0});
    }
    PlanLimits limits;
    limits.seconds_ahead = 1e6;
    EXPECT_EQ(meshes.plan(limits, Policy::kFifo).published, n);
    EXPECT_TRUE(meshes.wait());
    EXPECT_EQ(meshes.outstanding(), 0u);
  }

  models::Registry registry = registry_of(std::make_unique<FakeModel>());
  core::HeapGeometryMemory memory{1 << 20};
  std::vector<std::unique_ptr<models::Parameters>> parameters;
  std::vector<MeshKey> keys;
  MeshSupply meshes;
};

TEST_F(MeshSupplyTest, AWantedMeshIsReadyOnceItHasLanded) {
  make(3);
  EXPECT_EQ(meshes.wants().size(), 3u);
  EXPECT_FALSE(meshes.has_arrived()) << "not collected";
  EXPECT_EQ(meshes.collect().size(), 3u);
  EXPECT_TRUE(meshes.has_arrived());
  EXPECT_EQ(meshes.ready(meshes.find(keys[0])), nullptr) << "synthesised, but not made ready";
  const MeshSupply::Landed landed = meshes.land(UINT64_MAX);
  EXPECT_EQ(landed.completions.size(), 3u);
  EXPECT_EQ(landed.bytes, 3 * kMeshBytes);
  EXPECT_FALSE(meshes.has_arrived());
  for (const MeshKey& key : keys)
    ASSERT_NE(meshes.ready(meshes.find(key)), nullptr);
  meshes.begin_wants();
  EXPECT_TRUE(meshes.wants().empty());
}

TEST_F(MeshSupplyTest, LandsTheOldestFirstUntilTheBudgetOfATickIsReached) {
  make(5);
  meshes.collect();
  std::vector<std::uint64_t> owners;
  const auto land = [&](std::uint64_t max_bytes) {
    const MeshSupply::Landed landed = meshes.land(max_bytes);
    for (const Completion& c : landed.completions)
      owners.push_back(c.owner);
    return landed.completions.size();
  };
  EXPECT_EQ(land(0), 0u);
  EXPECT_EQ(land(1), 1u) << "at least one, however large";
  EXPECT_EQ(land(kMeshBytes + 1), 2u);
  EXPECT_EQ(land(UINT64_MAX), 2u);
  EXPECT_EQ(owners, (std::vector<std::uint64_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(land(UINT64_MAX), 0u);
}

TEST_F(MeshSupplyTest, AForgottenOrEvictedMeshIsNotReady) {
  make(2);
  meshes.collect();
  meshes.land(UINT64_MAX);
  const MeshHandle first = meshes.find(keys[0]), second = meshes.find(keys[1]);
  meshes.forget(first);
  EXPECT_EQ(meshes.ready(first), nullptr);
  EXPECT_TRUE(meshes.take_evictions().empty()) << "the caller freed the mesh itself";
  meshes.rank(second, Rank::unwanted());
  meshes.set_budget(1);
  EXPECT_EQ(meshes.ready(second), nullptr);
  const auto evicted = meshes.take_evictions();
  ASSERT_EQ(evicted.size(), 1u);
  EXPECT_EQ(evicted[0].owner, 1u);
}

TEST_F(MeshSupplyTest, EndsWhileModelersWorkAndNothingHasLanded) {
  parameters.push_back(std::make_unique<models::Parameters>(parameters_of(1, 60000)));
  meshes.want({key_of(1, *parameters.back(), 0), parameters.back().get(), 1,
               Rank::by_layer(RankGroup::kVisibleHole, 0, 0), 0});
  meshes.plan({}, Policy::kDeadline);
}

}  // namespace
}  // namespace psygen::synthesis
