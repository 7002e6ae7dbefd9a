#include "engine/synthesis/geometry_cache.hpp"

#include <gtest/gtest.h>

#include "engine/core/geometry_memory.hpp"
#include "tests/engine/synthesis/fake_models.hpp"

namespace psygen::synthesis {
namespace {
using testing::drawn;
using testing::FakeModel;
using testing::hole;
using testing::key_of;
using testing::kMeshBytes;
using testing::parameters_of;
using testing::prefetch;
using testing::registry_of;

constexpr std::int64_t kVertices = 80;  // of a mesh of kMeshBytes

class GeometryCacheTest : public ::testing::Test {
 protected:
  MeshHandle reserve(std::uint32_t index, Rank rank) {
    const auto p = parameters_of(index, kVertices);
    return cache.reserve(key_of(index, p), p, index, rank).value_or(kNoMesh);
  }
  MeshHandle add(std::uint32_t index, Rank rank) {
    const MeshHandle handle = reserve(index, rank);
    cache.complete(handle, {});
    return handle;
  }
  MeshKey key(std::uint32_t index) const { return key_of(index, parameters_of(index, kVertices)); }

  models::Registry registry = registry_of(std::make_unique<FakeModel>());
  core::HeapGeometryMemory memory{1 << 20};
  GeometryCache cache{memory, registry, 4 * kMeshBytes};
};

TEST(MeshKey, KeysThatDifferInOneFieldHaveDifferentHashes) {
  const MeshKey key{{1, 2}, 3, 4, 5, 6};
  for (const MeshKey& other :
       {MeshKey{{2, 2}, 3, 4, 5, 6}, MeshKey{{1, 1}, 3, 4, 5, 6}, MeshKey{{1, 2}, 4, 4, 5, 6},
        MeshKey{{1, 2}, 3, 5, 5, 6}, MeshKey{{1, 2}, 3, 4, 4, 6}, MeshKey{{1, 2}, 3, 4, 5, 7}}) {
    EXPECT_NE(hash_of(key), hash_of(other));
    EXPECT_FALSE(key == other);
  }
}

TEST_F(GeometryCacheTest, AMeshGoesFromEmptyToRequestedToReady) {
  EXPECT_FALSE(cache.find(key(1)));
  const MeshHandle handle = reserve(1, hole(1));
  ASSERT_TRUE(handle);
  EXPECT_EQ(cache.find(key(1)), handle);
  const MeshRecord* record = cache.get(handle);
  EXPECT_EQ(record->state, MeshState::kRequested);
  EXPECT_EQ(record->destination.vertices.size(), kVertices * 16u);
  EXPECT_EQ(record->destination.indices.size(), kVertices * 3u);
  EXPECT_EQ(record->range.bytes, kMeshBytes);
  cache.complete(handle, {glm::vec3(-1), glm::vec3(2)});
  EXPECT_EQ(record->state, MeshState::kReady);
  EXPECT_EQ(record->tight.max, glm::vec3(2));
  EXPECT_EQ(record->owner, 1u);
  EXPECT_TRUE(record->destination.vertices.empty());
  EXPECT_EQ(memory.indices(record->range).size(), kVertices * 3u);  // committed
}

TEST_F(GeometryCacheTest, ReservingAnExistingMeshReturnsIt) {
  const MeshHandle handle = reserve(1, hole(1));
  EXPECT_EQ(reserve(1, hole(1)), handle);
  cache.complete(handle, {});
  EXPECT_EQ(reserve(1, hole(1)), handle);
  EXPECT_EQ(cache.stats().bytes, kMeshBytes);
}

TEST_F(GeometryCacheTest, LookUpsAreCountedAsHitsOnlyWhenReady) {
  cache.look_up(key(1));
  const MeshHandle handle = reserve(1, hole(1));
  cache.look_up(key(1));
  cache.complete(handle, {});
  cache.look_up(key(1));
  cache.find(key(1));
  EXPECT_EQ(cache.stats().misses, 2u);
  EXPECT_EQ(cache.stats().hits, 1u);
}

TEST_F(GeometryCacheTest, TheWorstRankIsEvictedFirstAndReportedToItsOwner) {
  add(1, prefetch(10));
  add(2, prefetch(400));
  add(3, drawn(1000));
  add(4, prefetch(40));
  ASSERT_TRUE(reserve(5, hole(1)));
  ASSERT_TRUE(reserve(6, hole(1)));
  const auto evictions = cache.take_evictions();
  ASSERT_EQ(evictions.size(), 2u);
  EXPECT_EQ(evictions[0].owner, 2u);
  EXPECT_EQ(evictions[1].owner, 4u);
  EXPECT_EQ(evictions[1].key, key(4));
  EXPECT_EQ(cache.get(evictions[1].handle), nullptr);
  EXPECT_FALSE(cache.find(key(4)));
  EXPECT_TRUE(cache.take_evictions().empty());
  EXPECT_LE(cache.stats().peak_bytes, 4 * kMeshBytes);
}

TEST_F(GeometryCacheTest, NoVisibleMeshIsEvictedWhileAnInvisibleOneIsLeft) {
  add(1, drawn(1e6F));
  add(2, prefetch(1));
  add(3, drawn(1e5F));
  add(4, Rank::by_deadline(0, 0));
  ASSERT_TRUE(reserve(5, hole(2)));
  ASSERT_TRUE(reserve(6, hole(2)));
  ASSERT_TRUE(reserve(7, hole(2)));
  const auto evictions = cache.take_evictions();
  ASSERT_EQ(evictions.size(), 3u);
  EXPECT_EQ(evictions[0].owner, 2u);
  EXPECT_EQ(evictions[1].owner, 4u);
  EXPECT_EQ(evictions[2].owner, 1u);  // only a nearer hole evicts drawn meshes, the farthest first
}

TEST_F(GeometryCacheTest, ARequestIsRejectedRatherThanEvictAnEqualMesh) {
  for (std::uint32_t i = 1; i <= 4; ++i)
    add(i, prefetch(10));
  const auto p = parameters_of(5, kVertices);
  const auto refused = cache.reserve(key_of(5, p), p, 5, prefetch(10));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::ErrorCode::kOverBudget);
  EXPECT_TRUE(cache.take_evictions().empty());
  EXPECT_EQ(cache.stats().refusals, 1u);
  EXPECT_FALSE(cache.find(key(5)));  // not remembered: it may be requested again
  EXPECT_TRUE(reserve(5, prefetch(5)));
}

TEST_F(GeometryCacheTest, NothingIsEvictedForARequestThatCannotFitAnyway) {
  add(1, prefetch(100));
  add(2, drawn(1));
  add(3, drawn(1));
  add(4, drawn(1));
  const auto p = parameters_of(9, 2 * kVertices);
  EXPECT_FALSE(cache.reserve(key_of(9, p), p, 9, Rank::by_deadline(0, 0)));
  const auto huge = parameters_of(10, 5 * kVertices);
  EXPECT_FALSE(cache.reserve(key_of(10, huge), huge, 10, hole(0)));
  EXPECT_TRUE(cache.take_evictions().empty());
}

TEST_F(GeometryCacheTest, ReservationsInFlightAreNeverEvicted) {
  for (std::uint32_t i = 1; i <= 4; ++i)
    ASSERT_TRUE(reserve(i, prefetch(1000)));
  EXPECT_FALSE(reserve(5, hole(1)));
  EXPECT_EQ(cache.stats().requested, 4u);
}

TEST_F(GeometryCacheTest, AChangedRankDecidesTheNextEviction) {
  const MeshHandle a = add(1, drawn(1));
  add(2, prefetch(1));
  add(3, prefetch(2));
  add(4, prefetch(3));
  ASSERT_TRUE(reserve(5, hole(1)));  // evicts 4 and has selected the order
  cache.set_rank(a, Rank::unwanted());
  ASSERT_TRUE(reserve(6, hole(1)));
  const auto evictions = cache.take_evictions();
  ASSERT_EQ(evictions.size(), 2u);
  EXPECT_EQ(evictions[1].owner, 1u);
}

TEST_F(GeometryCacheTest, StaleHandlesAreIgnoredByEverything) {
  const MeshHandle old = add(1, prefetch(1));
  cache.release(old);
  const MeshHandle fresh = reserve(2, prefetch(1));
  ASSERT_EQ(fresh.slot, old.slot);
  EXPECT_NE(fresh, old);
  EXPECT_EQ(cache.get(old), nullptr);
  cache.complete(old, {});
  cache.fail(old, "stale");
  cache.cancel(old);
  cache.release(old);
  cache.settle(old);
  cache.set_rank(old, hole(0));
  cache.adopt(old, 99, hole(0));
  for (const MeshHandle handle : {kNoMesh, MeshHandle{12345, 0}}) {
    EXPECT_EQ(cache.get(handle), nullptr);
    cache.complete(handle, {});
    cache.release(handle);
    EXPECT_EQ(cache.failure_reason(handle), "");
  }
  EXPECT_EQ(cache.get(fresh)->state, MeshState::kRequested);
  EXPECT_EQ(cache.get(fresh)->owner, 2u);
  EXPECT_EQ(cache.get(fresh)->rank, prefetch(1));
}

TEST_F(GeometryCacheTest, ACancelledReservationLeavesNothingBehind) {
  const MeshHandle handle = reserve(1, hole(1));
  cache.cancel(handle);
  EXPECT_FALSE(cache.find(key(1)));
  EXPECT_EQ(memory.used_bytes(), 0u);
  EXPECT_EQ(cache.stats().evictions, 0u);
  EXPECT_TRUE(cache.take_evictions().empty());
}

TEST_F(GeometryCacheTest, AMeshReleasedInFlightIsFreedWhenFinishedUnlessAdopted) {
  const MeshHandle gone = reserve(1, hole(1)), kept = reserve(2, hole(1));
  cache.release(gone);
  cache.release(kept);
  EXPECT_EQ(memory.used_bytes(), 2 * kMeshBytes);  // a modeler may be writing
  cache.adopt(kept, 77, hole(2));
  cache.complete(gone, {});
  cache.complete(kept, {});
  EXPECT_EQ(cache.get(gone), nullptr);
  EXPECT_EQ(cache.get(kept)->state, MeshState::kReady);
  EXPECT_EQ(cache.get(kept)->owner, 77u);
  EXPECT_EQ(memory.used_bytes(), kMeshBytes);
}

TEST_F(GeometryCacheTest, AFailedMeshIsRememberedWithItsReasonAndNotRetried) {
  const MeshHandle handle = reserve(1, hole(1));
  cache.fail(handle, "rock level 0 threw: too hard");
  EXPECT_EQ(cache.get(handle)->state, MeshState::kFailed);
  EXPECT_EQ(cache.failure_reason(handle), "rock level 0 threw: too hard");
  EXPECT_EQ(memory.used_bytes(), 0u);
  const auto p = parameters_of(1, kVertices);
  const auto again = cache.reserve(key(1), p, 1, hole(1));
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, core::ErrorCode::kSynthesisFailed);
  EXPECT_EQ(again.error().message, "rock level 0 threw: too hard");
}

TEST_F(GeometryCacheTest, OldFailuresAreForgottenToBoundMemory) {
  const auto p = parameters_of(1, kVertices);
  MeshKey broken = key(0);
  broken.level = 50;  // does not exist
  for (std::uint32_t i = 0; i < GeometryCache::kMaxFailures + 10; ++i) {
    broken.index = i;
    EXPECT_FALSE(cache.reserve(broken, p, 1, hole(1)));
  }
  EXPECT_EQ(cache.stats().failed, GeometryCache::kMaxFailures);
  broken.index = 9;
  EXPECT_FALSE(cache.find(broken));
  broken.index = 10;
  EXPECT_TRUE(cache.find(broken));
}

TEST_F(GeometryCacheTest, AHungModelersDestinationStaysReservedUntilItReleasesIt) {
  const MeshHandle handle = reserve(1, hole(1));
  cache.fail(handle, "hangs", true);
  EXPECT_EQ(memory.used_bytes(), kMeshBytes);
  EXPECT_EQ(cache.get(handle)->state, MeshState::kFailed);
  cache.settle(handle);
  EXPECT_EQ(memory.used_bytes(), 0u);
  EXPECT_EQ(cache.failure_reason(handle), "hangs");
}

TEST_F(GeometryCacheTest, AHalvedBudgetIsMetAtOnceWorstFirstEvenIfVisible) {
  add(1, drawn(1));
  add(2, drawn(50));
  add(3, prefetch(1));
  add(4, drawn(20));
  cache.set_budget(2 * kMeshBytes);
  EXPECT_EQ(memory.used_bytes(), 2 * kMeshBytes);
  const auto evictions = cache.take_evictions();
  ASSERT_EQ(evictions.size(), 2u);
  EXPECT_EQ(evictions[0].owner, 3u);
  EXPECT_EQ(evictions[1].owner, 2u);
}

TEST_F(GeometryCacheTest, ReservationsInFlightMeetASmallerBudgetWhenFinished) {
  const MeshHandle a = reserve(1, drawn(1)), b = reserve(2, drawn(2)), c = reserve(3, drawn(3));
  cache.set_budget(kMeshBytes);
  EXPECT_EQ(memory.used_bytes(), 3 * kMeshBytes);
  cache.complete(a, {});
  cache.complete(b, {});
  cache.complete(c, {});
  EXPECT_EQ(memory.used_bytes(), kMeshBytes);
}

TEST_F(GeometryCacheTest, RegenerationsAndPrefetchHitsAreCounted) {
  const MeshHandle seen = add(1, prefetch(1));
  add(2, prefetch(100));
  add(3, drawn(1));
  add(4, drawn(1));
  cache.set_rank(seen, drawn(3));
  cache.set_rank(seen, prefetch(3));
  cache.set_rank(seen, drawn(3));
  ASSERT_TRUE(reserve(5, drawn(1)));  // evicts 2
  EXPECT_EQ(cache.stats().regenerations, 0u);
  cache.release(seen);
  ASSERT_TRUE(reserve(2, drawn(1)));
  const CacheStats stats = cache.stats();
  EXPECT_EQ(stats.prefetched, 2u);
  EXPECT_EQ(stats.prefetch_hits, 1u);
  EXPECT_EQ(stats.regenerations, 1u);
  EXPECT_EQ(stats.evictions, 1u);
}

TEST_F(GeometryCacheTest, TheDestructorReleasesEverything) {
  {
    GeometryCache other(memory, registry, 1 << 20);
    const auto p = parameters_of(1, kVertices);
    const auto a = other.reserve(key_of(1, p), p, 1, hole(1));
    const auto b = other.reserve(key_of(2, p), p, 1, hole(1));
    ASSERT_TRUE(a && b);
    other.complete(*a, {});
    EXPECT_GT(memory.used_bytes(), 0u);
  }
  EXPECT_EQ(memory.used_bytes(), 0u);
}

TEST(GeometryCacheTypes, TypesOfUnknownOrExcessiveSizeFailPermanently) {
  models::Registry registry;
  ASSERT_TRUE(registry.add(std::make_unique<testing::SizelessModel>()));
  ASSERT_TRUE(registry.add(std::make_unique<testing::HugeModel>()));
  core::HeapGeometryMemory memory(1 << 20);
  GeometryCache cache(memory, registry, 1 << 20);
  const auto p = parameters_of(1, 1);
  for (models::ModelIndex model = 0; model < 3; ++model) {  // 2 does not exist
    const MeshKey key = key_of(model, p, model);
    const auto refused = cache.reserve(key, p, 1, hole(1));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::ErrorCode::kSynthesisFailed);
    EXPECT_EQ(cache.get(cache.find(key))->state, MeshState::kFailed);
    EXPECT_NE(cache.failure_reason(cache.find(key)), "");
  }
  EXPECT_EQ(memory.used_bytes(), 0u);
}

}  // namespace
}  // namespace psygen::synthesis
