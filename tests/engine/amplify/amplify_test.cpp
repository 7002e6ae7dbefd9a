#include "engine/amplify/amplify.hpp"

#include <gtest/gtest.h>

#include <mutex>
#include <set>

#include "tests/engine/world/files.hpp"

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

TEST(Amplify, PartsOfARegionAddUpToIt) {
  const world::World world = parsed(kSmallWorld);
  Totals sum;
  for (const Region& part : {Region{4, 0, 8, 4}, Region{0, 2, 4, 4}, Region{0, 0, 4, 2}})
    sum.add(amplify(world, registry(), part, with_threads(2))->totals);
  const auto all = amplify(world, registry(), *whole(world), with_threads(2));
  EXPECT_EQ(sum.hash.value(), all->totals.hash.value());
  EXPECT_EQ(sum.triangles, all->totals.triangles);
}

TEST(Amplify, WorksAtTheEndOfAllBlocks) {
  world::World world = parsed(kSmallWorld);
  world.blocks_x = world.blocks_z = 0;
  const std::int64_t end = std::int64_t{INT32_MAX} + 1;
  const auto corner = amplify(world, registry(), {end - 2, end - 2, end, end}, with_threads(2));
  ASSERT_TRUE(corner) << corner.error().message;
  EXPECT_EQ(corner->totals.blocks, 4u);
  EXPECT_EQ(corner->totals.failed, 0u);
}

TEST(Amplify, RefusesRegionsAndThreadsThatAreOutOfRange) {
  const world::World world = parsed(kSmallWorld);
  EXPECT_FALSE(amplify(world, registry(), {0, 0, 9, 1}, with_threads(1)));
  EXPECT_FALSE(amplify(world, registry(), {0, 0, 1, 1}, with_threads(0)));
  EXPECT_FALSE(amplify(world, registry(), {0, 0, 1, 1}, with_threads(257)));
}

TEST(Amplify, ThatIsStoppedIsNotCompleteAndKeepsWhatWasDone) {
  const world::World world = parsed(kSmallWorld);
  const std::atomic<bool> stop{true};
  Options options = with_threads(2);
  options.stop = &stop;
  const auto report = amplify(world, registry(), *whole(world), options);
  ASSERT_TRUE(report);
  EXPECT_FALSE(report->complete);
  EXPECT_EQ(report->totals.blocks, 0u);
}

// Notes what it is given; fails at one block, if asked to.
struct Notes {
  std::mutex mutex;
  std::multiset<core::BlockCoord> finished;
  std::size_t meshes = 0;
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

TEST(Amplify, ASinkThatFailsEndsItWithItsSentence) {
  const world::World world = parsed(kSmallWorld);
  Notes notes;
  const core::BlockCoord bad{2, 1};
  Options options = with_threads(2);
  options.make_sink = [&] { return std::make_unique<NotingSink>(notes, &bad); };
  const auto report = amplify(world, registry(), *whole(world), options);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().message, "disk full");
}

}  // namespace
}  // namespace psygen::amplify
