// Tests the budget under pressure: random loads against a model, and memory that returns late or
// fails.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "engine/synthesis/geometry_cache.hpp"
#include "tests/engine/synthesis/fake_memory.hpp"
#include "tests/engine/synthesis/fake_models.hpp"

namespace psygen::synthesis {
namespace {
using testing::FakeMemory;
using testing::FakeModel;
using testing::key_of;
using testing::kMeshBytes;
using testing::parameters_of;
using testing::prefetch;
using testing::registry_of;

Rank random_rank(core::RandomStream& random) {
  const auto group = static_cast<RankGroup>(random.next_integer(0, 6));
  return Rank::by_layer(group, static_cast<std::uint32_t>(random.next_integer(0, 4)),
                        static_cast<float>(random.next_integer(0, 5)) * 16);
}

// The cache's content as the test expects it.
struct Believed {
  MeshHandle handle;
  Rank rank;
  std::uint64_t bytes;
  bool ready;
};
using Model = std::map<std::uint32_t, Believed>;

// Expects that each eviction took the worst ready mesh, and only meshes that the request may evict.
void expect_lawful(std::span<const Eviction> evictions, Model& model, const Rank* request) {
  for (const Eviction& e : evictions) {
    const auto victim = model.find(static_cast<std::uint32_t>(e.owner));
    ASSERT_NE(victim, model.end());
    ASSERT_EQ(victim->second.handle, e.handle);
    ASSERT_TRUE(victim->second.ready);
    if (request != nullptr) {
      ASSERT_TRUE(may_evict(*request, victim->second.rank));
    }
    for (const auto& [owner, other] : model) {
      if (other.ready) {
        ASSERT_LE(eviction_order(other.rank), eviction_order(victim->second.rank));
      }
    }
    model.erase(victim);
  }
}

void expect_same(const GeometryCache& cache, const Model& model) {
  std::uint32_t ready = 0, requested = 0;
  for (const auto& [owner, b] : model) {
    const MeshRecord* record = cache.get(b.handle);
    ASSERT_NE(record, nullptr);
    ASSERT_EQ(record->state, b.ready ? MeshState::kReady : MeshState::kRequested);
    ASSERT_EQ(record->rank, b.rank);
    ++(b.ready ? ready : requested);
  }
  std::uint64_t visible = 0, unwanted = 0;
  for (const MeshRecord& r : cache.records()) {
    if (is_visible(r.rank.group())) visible += r.range.bytes;
    const bool kept = r.state == MeshState::kReady && r.rank.group() == RankGroup::kUnwanted;
    unwanted += kept ? r.range.bytes : 0;
  }
  ASSERT_EQ(cache.stats().visible_bytes, visible);
  ASSERT_EQ(cache.stats().unwanted_bytes, unwanted);
  ASSERT_EQ(cache.stats().ready, ready);
  ASSERT_EQ(cache.stats().requested, requested);
}

Model::iterator pick(Model& model, core::RandomStream& random, bool ready) {
  std::vector<Model::iterator> fitting;
  for (auto it = model.begin(); it != model.end(); ++it) {
    if (it->second.ready == ready) fitting.push_back(it);
  }
  return fitting.empty() ? model.end() : fitting[random.next_u64() % fitting.size()];
}

void run_random_load(std::uint64_t seed, int frames_in_flight) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  FakeMemory memory(1 << 24, frames_in_flight);
  std::uint64_t budget = 60'000;
  GeometryCache cache(memory, registry, budget);
  Model model;
  core::RandomStream random(seed, 0, 0, 0, core::Purpose::kParameters);
  for (std::uint32_t step = 0; step < 2500; ++step) {
    const std::int64_t what = random.next_integer(0, 9);
    const std::uint64_t used_before = memory.used_bytes();
    const Rank rank = random_rank(random);
    if (what <= 4) {
      const auto p = parameters_of(step, random.next_integer(1, 200));
      const auto handle = cache.reserve(key_of(step, p), p, step, rank);
      expect_lawful(cache.take_evictions(), model, &rank);
      if (handle) model[step] = {*handle, rank, cache.get(*handle)->range.bytes, false};
      ASSERT_LE(memory.used_bytes(), std::max(budget, used_before));
    } else if (what <= 6) {
      const auto it = pick(model, random, false);
      if (it == model.end()) continue;
      it->second.ready = true;
      cache.complete(it->second.handle, {});
      expect_lawful(cache.take_evictions(), model, nullptr);
    } else if (what == 7) {
      const auto it = pick(model, random, random.next_integer(0, 1) == 0);
      if (it == model.end()) continue;
      it->second.rank = rank;
      cache.set_rank(it->second.handle, rank);
    } else if (what == 8) {
      const bool ready = random.next_integer(0, 1) == 0;
      const auto it = pick(model, random, ready);
      if (it == model.end()) continue;
      ready ? cache.release(it->second.handle) : cache.cancel(it->second.handle);
      model.erase(it);
    } else {
      memory.end_frame();
      if (step % 400 == 9) {
        budget = static_cast<std::uint64_t>(random.next_integer(10'000, 80'000));
        cache.set_budget(budget);
      }
      cache.begin_batch();
      expect_lawful(cache.take_evictions(), model, nullptr);
    }
    ASSERT_NO_FATAL_FAILURE(expect_same(cache, model)) << step;
  }
  EXPECT_GT(cache.stats().evictions, 50u);
}

TEST(Eviction, RandomLoadsNeverExceedTheBudgetAndAlwaysTakeTheWorst) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    ASSERT_NO_FATAL_FAILURE(run_random_load(seed, 0)) << seed;
}

TEST(Eviction, RandomLoadsNeverExceedTheBudgetWhenMemoryReturnsFramesLater) {
  for (std::uint64_t seed = 4; seed <= 6; ++seed)
    ASSERT_NO_FATAL_FAILURE(run_random_load(seed, 3)) << seed;
}

class PressureTest : public ::testing::Test {
 protected:
  MeshHandle reserve(std::uint32_t index, Rank rank) {
    const auto p = parameters_of(index, 80);
    return cache.reserve(key_of(index, p), p, index, rank).value_or(kNoMesh);
  }
  void fill(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i)
      cache.complete(reserve(i, prefetch(static_cast<float>(16 + i * 16))), {});
  }
  models::Registry registry = registry_of(std::make_unique<FakeModel>());
  FakeMemory memory{1 << 20, 2};
  GeometryCache cache{memory, registry, 8 * kMeshBytes};
};

TEST_F(PressureTest, ARequestThatWaitsForTheGpuEvictsOnlyOnce) {
  fill(8);
  EXPECT_FALSE(reserve(100, prefetch(0)));
  EXPECT_EQ(cache.stats().evictions, 1u);
  memory.end_frame();
  cache.begin_batch();
  EXPECT_FALSE(reserve(100, prefetch(0)));
  EXPECT_EQ(cache.stats().evictions, 1u);
  memory.end_frame();
  cache.begin_batch();
  EXPECT_TRUE(reserve(100, prefetch(0)));
  EXPECT_EQ(cache.stats().evictions, 1u);
  EXPECT_EQ(memory.used_bytes(), 8 * kMeshBytes);
}

TEST_F(PressureTest, ARequestWhoseMemoryIsBeingFreedIsToldToWait) {
  fill(8);
  const auto p = parameters_of(100, 80);
  const auto error_of = [&](std::uint32_t index, Rank rank) {
    return cache.reserve(key_of(index, p), p, index, rank).error().code;
  };
  EXPECT_EQ(error_of(100, prefetch(0)), core::ErrorCode::kNotReady);
  EXPECT_EQ(error_of(101, prefetch(1e6F)), core::ErrorCode::kOverBudget);
}

TEST_F(PressureTest, SomeMemoryIsKeptFreeByEvictingUnwantedMeshes) {
  cache.set_budget(64 * kMeshBytes);
  fill(64);
  std::vector<MeshHandle> unwanted;  // in this order, others between them
  for (std::uint32_t i = 0; i < 64; i += 2) {
    unwanted.push_back(cache.find(key_of(63 - i, parameters_of(63 - i, 80))));
    cache.set_rank(unwanted.back(), Rank::unwanted());
  }
  EXPECT_EQ(cache.stats().unwanted_bytes, 32 * kMeshBytes);
  cache.set_rank(unwanted[1], prefetch(0));  // wanted again
  cache.begin_batch();
  EXPECT_EQ(cache.stats().evictions, 3u);  // 64 / 24 meshes
  for (const std::size_t gone : {0, 2, 3})
    EXPECT_EQ(cache.get(unwanted[gone]), nullptr) << gone;
  EXPECT_NE(cache.get(unwanted[1]), nullptr);
  EXPECT_EQ(cache.stats().unwanted_bytes, 28 * kMeshBytes);
  for (int frame = 0; frame < 2; ++frame)
    memory.end_frame();
  cache.begin_batch();
  EXPECT_EQ(cache.stats().evictions, 3u);
  for (std::uint32_t i = 0; i < 3; ++i)
    EXPECT_TRUE(reserve(100 + i, prefetch(1e6F)));  // without waiting
}

TEST_F(PressureTest, NoWantedMeshIsEvictedAheadOfNeed) {
  fill(8);
  for (int i = 0; i < 10; ++i)
    cache.begin_batch();
  EXPECT_EQ(cache.stats().evictions, 0u);
}

TEST_F(PressureTest, VisibleBytesAreCountedForEveryWayToLeaveTheCache) {
  const auto visible = [](float distance) {
    return Rank::by_layer(RankGroup::kDrawn, 0, distance);
  };
  for (std::uint32_t i = 0; i < 4; ++i)
    cache.complete(reserve(i, visible(1)), {});
  const MeshHandle requested = reserve(4, visible(1));
  EXPECT_EQ(cache.stats().visible_bytes, 5 * kMeshBytes);
  cache.cancel(requested);
  cache.set_rank(cache.find(key_of(0, parameters_of(0, 80))), prefetch(1));
  cache.release(cache.find(key_of(1, parameters_of(1, 80))));
  EXPECT_EQ(cache.stats().visible_bytes, 2 * kMeshBytes);
  cache.fail(reserve(5, visible(1)), "no");
  EXPECT_EQ(cache.stats().visible_bytes, 2 * kMeshBytes);
  cache.set_budget(kMeshBytes);  // the prefetched one goes first, then one of the drawn
  EXPECT_EQ(cache.stats().visible_bytes, kMeshBytes);
}

TEST_F(PressureTest, FragmentedMemoryIsFreedInBatchesOfUnwantedMeshes) {
  FakeMemory immediate(1 << 20, 0);
  GeometryCache other(immediate, registry, 80 * kMeshBytes);
  const auto p = parameters_of(1, 80);
  for (std::uint32_t i = 0; i < 40; ++i)
    other.complete(*other.reserve(key_of(i, p), p, i, Rank::unwanted()), {});
  immediate.fail_next_reservations(1);
  EXPECT_TRUE(other.reserve(key_of(50, p), p, 50, prefetch(0)));
  EXPECT_EQ(other.stats().evictions, 5u);  // an eighth
}

TEST_F(PressureTest, ARepeatedRequestInOneBatchIsPromisedItsMemoryOnce) {
  fill(8);
  for (int i = 0; i < 5; ++i)
    EXPECT_FALSE(reserve(100, prefetch(0)));
  EXPECT_EQ(cache.stats().evictions, 1u);
  EXPECT_FALSE(reserve(101, prefetch(0)));
  EXPECT_EQ(cache.stats().evictions, 2u);
}

TEST_F(PressureTest, ARequestWaitsForPiecesThatAreBeingFreed) {
  GeometryCache other(memory, registry, 80 * kMeshBytes);  // its memory returns two frames later
  const auto p = parameters_of(1, 80);
  for (std::uint32_t i = 0; i < 40; ++i)
    other.complete(*other.reserve(key_of(i, p), p, i, Rank::unwanted()), {});
  memory.fail_next_reservations(3);
  for (int tick = 0; tick < 3; ++tick) {
    other.begin_batch();
    const auto waits = other.reserve(key_of(50, p), p, 50, prefetch(0));
    ASSERT_FALSE(waits);
    EXPECT_EQ(waits.error().code, core::ErrorCode::kNotReady) << tick;
    EXPECT_LE(other.stats().evictions, 7u) << tick;  // an eighth, and the growth of the limit
  }
  for (int frame = 0; frame < 2; ++frame)
    memory.end_frame();
  other.begin_batch();
  EXPECT_TRUE(other.reserve(key_of(50, p), p, 50, prefetch(0)));
}

TEST_F(PressureTest, EachOfSeveralWaitingRequestsGetsItsMemory) {
  fill(8);
  for (std::uint32_t i = 0; i < 3; ++i)
    EXPECT_FALSE(reserve(100 + i, prefetch(0)));
  EXPECT_EQ(cache.stats().evictions, 3u);
  memory.end_frame();
  memory.end_frame();
  cache.begin_batch();
  for (std::uint32_t i = 0; i < 3; ++i)
    EXPECT_TRUE(reserve(100 + i, prefetch(0)));
  EXPECT_EQ(cache.stats().evictions, 3u);
}

TEST_F(PressureTest, AHalvedBudgetIsMetWithinTheNextFramesWithoutEvictingTooMuch) {
  fill(8);
  cache.set_budget(4 * kMeshBytes);
  for (int frame = 0; frame < 2; ++frame) {
    memory.end_frame();
    cache.begin_batch();
  }
  EXPECT_EQ(memory.used_bytes(), 4 * kMeshBytes);
  EXPECT_EQ(cache.stats().evictions, 4u);
}

TEST_F(PressureTest, OtherBytesInTheSameMemoryCountAgainstTheBudget) {
  fill(6);
  const auto other = memory.reserve(core::VertexLayout::kModel, 80, 240);
  ASSERT_TRUE(other);
  EXPECT_TRUE(reserve(100, prefetch(0)));
  EXPECT_FALSE(reserve(101, prefetch(0)));  // full: one of the six must go first
  EXPECT_EQ(cache.stats().evictions, 1u);
  EXPECT_LE(cache.stats().peak_bytes, 8 * kMeshBytes);
}

TEST_F(PressureTest, TheLimitRecoversAfterMemoryRanOutOnce) {
  FakeMemory immediate(1 << 20, 0);
  GeometryCache other(immediate, registry, 8 * kMeshBytes);
  const auto p = parameters_of(1, 80);
  for (std::uint32_t i = 0; i < 4; ++i)
    other.complete(*other.reserve(key_of(i, p), p, i, prefetch(100)), {});
  immediate.fail_next_reservations(1);
  EXPECT_TRUE(other.reserve(key_of(50, p), p, 50, prefetch(0)));  // one was evicted, then it fits
  EXPECT_EQ(other.stats().out_of_memory, 1u);
  EXPECT_EQ(other.stats().evictions, 1u);
  EXPECT_EQ(other.stats().limit_bytes, 4 * kMeshBytes);
  for (int tick = 0; tick < 64; ++tick)
    other.begin_batch();
  EXPECT_EQ(other.stats().limit_bytes, 8 * kMeshBytes);
}

TEST_F(PressureTest, AMemorySmallerThanTheBudgetIsTheLimit) {
  FakeMemory immediate(1 << 20, 0);
  GeometryCache other(immediate, registry, 8 * kMeshBytes);
  const auto p = parameters_of(1, 80);
  for (std::uint32_t i = 0; i < 4; ++i)
    other.complete(*other.reserve(key_of(i, p), p, i, prefetch(100)), {});
  immediate.limit_capacity(5 * kMeshBytes);
  immediate.fail_next_reservations(1);
  EXPECT_TRUE(other.reserve(key_of(50, p), p, 50, prefetch(0)));
  for (int tick = 0; tick < 64; ++tick)
    other.begin_batch();
  EXPECT_EQ(other.stats().limit_bytes, 5 * kMeshBytes);
  EXPECT_EQ(other.stats().capacity_bytes, 5 * kMeshBytes);
}

TEST_F(PressureTest, AMemoryThatAlwaysFailsCostsOneEvictionATickAndIsAnError) {
  FakeMemory immediate(1 << 20, 0);
  GeometryCache other(immediate, registry, 16 * kMeshBytes);
  const auto p = parameters_of(1, 80);
  for (std::uint32_t i = 0; i < 8; ++i)
    other.complete(*other.reserve(key_of(i, p), p, i, prefetch(100)), {});
  immediate.fail_next_reservations(1000);
  for (std::uint32_t i = 0; i < 20; ++i) {
    const auto refused = other.reserve(key_of(100 + i, p), p, 1, prefetch(0));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::ErrorCode::kOutOfMemory);
  }
  EXPECT_EQ(other.stats().evictions, 1u);
  EXPECT_EQ(other.stats().ready, 7u);
}

}  // namespace
}  // namespace psygen::synthesis
