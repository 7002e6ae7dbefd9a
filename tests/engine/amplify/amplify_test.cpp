#include "engine/amplify/amplify.hpp"

#include <gtest/gtest.h>

#include <mutex>
#include <set>

#include "tests/engine/amplify/throwing_type.hpp"
#include "tests/engine/world/shaped_worlds.hpp"
#include "tests/engine/world/shipped.hpp"
#include "tests/faults.hpp"

namespace psygen::amplify {
namespace {

using world::testing::kSmallWorld;
using world::testing::parsed;
using world::testing::registry;

Options with_threads(unsigned threads) {
  Options options;
  options.threads = threads;
  return options;
}

TEST(Amplify, TheHashIsTheSameForAnyNumberOfThreads) {
  const world::World world = parsed(kSmallWorld);
  const Region region = *whole(world);
  const auto one = amplify(world, registry(), region, with_threads(1));
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_TRUE(one->complete);
  EXPECT_EQ(one->totals.blocks, 32u);
  EXPECT_EQ(one->totals.models, 32u * 8);
  for (const unsigned threads : {2u, 3u, 8u}) {
    const auto many = amplify(world, registry(), region, with_threads(threads));
    ASSERT_TRUE(many);
    EXPECT_EQ(many->threads, threads);
    EXPECT_EQ(many->totals.hash.value(), one->totals.hash.value());
    EXPECT_EQ(many->totals.triangles, one->totals.triangles);
    EXPECT_EQ(many->totals.bytes, one->totals.bytes);
  }
}

TEST(Amplify, TheHashOfShapedGroundIsTheSameForAnyNumberOfThreads) {
  const world::World world = world::testing::shaped_world(world::testing::kShapes);
  const Region region = *whole(world);
  const auto one = amplify(world, registry(), region, with_threads(1));
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_NE(one->totals.hash.value(),
            amplify(parsed(kSmallWorld), registry(), region, with_threads(4))->totals.hash.value());
  EXPECT_LT(one->totals.models, 32u * 8);  // some would stand on the road
  for (const unsigned threads : {2u, 8u}) {
    const auto many = amplify(world, registry(), region, with_threads(threads));
    ASSERT_TRUE(many);
    EXPECT_EQ(many->totals.hash.value(), one->totals.hash.value());
  }
}

TEST(Amplify, ContinuesWithFewerThreadsAndFailsWithoutAny) {
  const world::World world = parsed(kSmallWorld);
  const Region region = *whole(world);
  const auto all = amplify(world, registry(), region, with_threads(8));
  for (const unsigned left : {1u, 3u}) {
    const FewThreads few(left);
    const auto report = amplify(world, registry(), region, with_threads(8));
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->threads, left);
    EXPECT_TRUE(report->complete);
    EXPECT_EQ(report->totals.hash.value(), all->totals.hash.value());
  }
  const FewThreads none(0);
  const auto report = amplify(world, registry(), region, with_threads(8));
  ASSERT_FALSE(report);
  EXPECT_NE(report.error().message.find("no more threads"), std::string::npos);
}

TEST(Amplify, PartsOfARegionAddUpToIt) {
  const world::World world = parsed(kSmallWorld);
  Totals sum;
  for (const Region& part : {Region{4, 0, 8, 4}, Region{0, 2, 4, 4}, Region{0, 0, 4, 2}})
    sum.add(amplify(world, registry(), part, with_threads(2))->totals);
  const auto all = amplify(world, registry(), *whole(world), with_threads(2));
  EXPECT_EQ(sum.hash.value(), all->totals.hash.value());
  EXPECT_EQ(sum.triangles, all->totals.triangles);
}

TEST(Amplify, WorksAtTheLimitOfBlockCoordinates) {
  world::World world = parsed(kSmallWorld);
  world.blocks_x = world.blocks_z = 0;
  const std::int64_t end = std::int64_t{INT32_MAX} + 1;
  const auto corner = amplify(world, registry(), {end - 2, end - 2, end, end}, with_threads(2));
  ASSERT_TRUE(corner) << corner.error().message;
  EXPECT_EQ(corner->totals.blocks, 4u);
  EXPECT_EQ(corner->totals.failed, 0u);
}

TEST(Amplify, RejectsRegionsAndThreadsThatAreOutOfRange) {
  const world::World world = parsed(kSmallWorld);
  EXPECT_FALSE(amplify(world, registry(), {0, 0, 9, 1}, with_threads(1)));
  EXPECT_FALSE(amplify(world, registry(), {0, 0, 1, 1}, with_threads(0)));
  EXPECT_FALSE(amplify(world, registry(), {0, 0, 1, 1}, with_threads(257)));
}

TEST(Amplify, ThatIsStoppedIsIncompleteAndKeepsFinishedBlocks) {
  const world::World world = parsed(kSmallWorld);
  const std::atomic<bool> stop{true};
  Options options = with_threads(2);
  options.stop = &stop;
  const auto report = amplify(world, registry(), *whole(world), options);
  ASSERT_TRUE(report);
  EXPECT_FALSE(report->complete);
  EXPECT_EQ(report->totals.blocks, 0u);
}

// Records its calls; fails at one block on request.
struct Notes {
  std::mutex mutex;
  std::multiset<core::BlockCoord> finished;
  std::size_t meshes = 0, dropped = 0;
};
class NotingSink final : public BlockSink {
 public:
  NotingSink(Notes& notes, const core::BlockCoord* bad) : notes_(notes), bad_(bad) {}
  bool wants(core::BlockCoord block) override { return block.x != 3; }
  void add(core::BlockCoord, const BlockMesh&) override { ++meshes_; }
  core::Result<void> finish(core::BlockCoord block) override {
    if (bad_ != nullptr && block == *bad_) return core::fail(core::ErrorCode::kIo, "disk full");
    const std::lock_guard lock(notes_.mutex);
    notes_.finished.insert(block);
    notes_.meshes += std::exchange(meshes_, 0);
    return {};
  }
  void drop(core::BlockCoord) override {
    const std::lock_guard lock(notes_.mutex);
    ++notes_.dropped;
    meshes_ = 0;
  }

 private:
  Notes& notes_;
  const core::BlockCoord* bad_;
  std::size_t meshes_ = 0;
};

TEST(Amplify, GivesEachWantedBlockToOneSinkAndHashesTheOthersToo) {
  const world::World world = parsed(kSmallWorld);
  Notes notes;
  Options options = with_threads(3);
  options.make_sink = [&] { return std::make_unique<NotingSink>(notes, nullptr); };
  const auto report = amplify(world, registry(), *whole(world), options);
  ASSERT_TRUE(report);
  EXPECT_EQ(notes.finished.size(), 28u);
  EXPECT_EQ(std::set(notes.finished.begin(), notes.finished.end()).size(), 28u);
  EXPECT_EQ(notes.meshes, 28u * 9);
  EXPECT_EQ(report->totals.hash.value(),
            amplify(world, registry(), *whole(world), with_threads(1))->totals.hash.value());
}

TEST(Amplify, ASinkThatFailsEndsItWithItsError) {
  const world::World world = parsed(kSmallWorld);
  Notes notes;
  const core::BlockCoord bad{2, 1};
  Options options = with_threads(2);
  options.make_sink = [&] { return std::make_unique<NotingSink>(notes, &bad); };
  const auto report = amplify(world, registry(), *whole(world), options);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "disk full");
}

TEST(Amplify, ABlockThatLacksAMeshIsDroppedAndTheReportIsIncomplete) {
  ThrowingWorld throwing;
  Notes notes;
  Options options = with_threads(2);
  options.make_sink = [&] { return std::make_unique<NotingSink>(notes, nullptr); };
  const Region all = *whole(throwing.world);
  const auto report = amplify(throwing.world, throwing.registry, all, options);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->totals.failed, 2u * 32);
  EXPECT_EQ(report->totals.blocks, all.block_count());
  EXPECT_FALSE(report->stopped);
  EXPECT_FALSE(report->complete);
  EXPECT_EQ(notes.dropped, 28u);
  EXPECT_TRUE(notes.finished.empty());
  throwing.throws = false;
  const auto mended = amplify(throwing.world, throwing.registry, all, options);
  ASSERT_TRUE(mended);
  EXPECT_TRUE(mended->complete);
  EXPECT_EQ(notes.finished.size(), 28u);
  EXPECT_EQ(notes.meshes, 28u * 11);
}

// Throws the given exception.
class ThrowingSink final : public BlockSink {
 public:
  explicit ThrowingSink(const std::function<void()>& thrower) : thrower_(thrower) {}
  bool wants(core::BlockCoord) override { return true; }
  void add(core::BlockCoord, const BlockMesh&) override { thrower_(); }
  core::Result<void> finish(core::BlockCoord) override { return {}; }
  void drop(core::BlockCoord) override {}

 private:
  const std::function<void()>& thrower_;
};

TEST(Amplify, ExceptionsEndItAndOnlyBadAllocIsOutOfMemory) {
  const world::World world = parsed(kSmallWorld);
  const auto error_of = [&](const std::function<void()>& thrower) {
    Options options = with_threads(3);
    options.make_sink = [&] { return std::make_unique<ThrowingSink>(thrower); };
    const auto report = amplify(world, registry(), *whole(world), options);
    return report ? core::Error{} : report.error();
  };
  const core::Error any = error_of([] { throw std::runtime_error("a broken type"); });
  EXPECT_EQ(any.code, core::ErrorCode::kSynthesisFailed);
  EXPECT_NE(any.message.find("a broken type"), std::string::npos);
  EXPECT_EQ(error_of([] { throw 7; }).code, core::ErrorCode::kSynthesisFailed);
  EXPECT_EQ(error_of([] { throw std::bad_alloc(); }).code, core::ErrorCode::kOutOfMemory);
}

// Callbacks during a run may throw: the threads end, and the exception is passed on.
TEST(Amplify, EndsItsThreadsWhenItsCallerThrows) {
  const world::World world = parsed(kSmallWorld);
  std::atomic<bool> thrown{false};
  const std::function<void()> until_thrown = [&thrown] { thrown.wait(false); };
  Options options = with_threads(2);
  options.make_sink = [&] { return std::make_unique<ThrowingSink>(until_thrown); };
  options.progress = [&thrown](std::uint64_t) {
    thrown = true;
    thrown.notify_all();
    throw std::bad_alloc();
  };
  EXPECT_THROW((void)amplify(world, registry(), *whole(world), options), std::bad_alloc);
}

TEST(Amplify, NeverDefaultsToMoreThreadsThanItAllows) {
  const world::World world = parsed(kSmallWorld);
  EXPECT_EQ(threads_for(0), 1u);
  EXPECT_EQ(threads_for(6), 6u);
  EXPECT_TRUE(amplify(world, registry(), {0, 0, 1, 1}, with_threads(threads_for(4096))));
}

}  // namespace
}  // namespace psygen::amplify
