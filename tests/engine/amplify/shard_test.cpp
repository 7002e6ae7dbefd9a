#include "engine/amplify/shard.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "engine/amplify/block_files.hpp"
#include "engine/amplify/merge.hpp"
#include "tests/engine/amplify/throwing_type.hpp"
#include "tests/engine/world/shipped.hpp"
#include "tests/full_disk.hpp"

namespace psygen::amplify {
namespace {

using exchange::Format;
using world::testing::kSmallWorld;
using world::testing::parsed;
using world::testing::registry;

constexpr Region kSharedRegion{1, 0, 5, 3};

core::Result<Report> make(const world::World& world, const Shard& shard,
                          const std::filesystem::path& folder, JobFormat format,
                          const std::atomic<bool>* stop = nullptr) {
  auto key = job_key(world, registry(), kSharedRegion, format, "0.1.0");
  if (!key) return tl::unexpected(key.error());
  Options options;
  options.threads = 2;
  options.stop = stop;
  std::unique_ptr<BlockFolder> files;
  if (format) {
    auto opened = BlockFolder::open(folder, world, registry(), *format);
    if (!opened) return tl::unexpected(opened.error());
    files = std::move(*opened);
    options.make_sink = [&] { return files->make_sink(); };
  }
  return amplify_shard({world, registry(), *key}, shard, folder, options);
}

core::Result<Totals> merged(const std::filesystem::path& folder) {
  const auto ledgers = read_ledgers(std::vector{folder});
  if (!ledgers) return tl::unexpected(ledgers.error());
  return merge(*ledgers);
}

// The files of blocks and of their origin, without ledgers.
FileContents blocks_in(const std::filesystem::path& folder) {
  FileContents contents = contents_of(folder);
  std::erase_if(contents, [](const auto& file) { return file.first.ends_with(kLedgerExtension); });
  return contents;
}

Report one_process(const world::World& world, const std::filesystem::path& folder, Format format) {
  const auto files = BlockFolder::open(folder, world, registry(), format);
  Options options;
  options.make_sink = [&] { return (*files)->make_sink(); };
  return *amplify(world, registry(), kSharedRegion, options);
}

TEST(Shard, IsWrittenAsIOfN) {
  EXPECT_EQ(parse_shard("3/8")->index, 3u);
  EXPECT_EQ(parse_shard("8/8")->count, 8u);
  for (const char* text : {"", "3", "/", "3/", "/8", "0/8", "9/8", "3/8/", "3 /8", "-1/8", "1/0",
                           "1/1000001", "1.0/2", "1/99999999999999999999"}) {
    const auto shard = parse_shard(text);
    ASSERT_FALSE(shard) << text;
    EXPECT_NE(shard.error().message.find("is not a shard I/N"), std::string::npos);
  }
}

TEST(Shard, AllTogetherMakeTheFilesAndTheHashOfOneProcess) {
  const world::World world = parsed(kSmallWorld);
  for (const Format format : {Format::kGlb, Format::kObj}) {
    const TemporaryFolder top;
    const Report whole = one_process(world, top / "whole", format);
    const auto counts = format == Format::kGlb ? std::vector<std::uint64_t>{3, 20}  // of 12 blocks
                                               : std::vector<std::uint64_t>{2};
    for (const std::uint64_t n : counts) {
      std::filesystem::remove_all(top / "shards");
      for (std::uint64_t i = n; i >= 1; --i) {
        const auto report = make(world, {i, n}, top / "shards", format);
        ASSERT_TRUE(report) << report.error().message;
        EXPECT_TRUE(report->complete);
      }
      const auto totals = merged(top / "shards");
      ASSERT_TRUE(totals) << totals.error().message;
      EXPECT_EQ(totals->hash.value(), whole.totals.hash.value());
      EXPECT_EQ(totals->triangles, whole.totals.triangles);
      EXPECT_TRUE(blocks_in(top / "shards") == contents_of(top / "whole")) << n;
    }
  }
}

TEST(Shard, WithoutFilesHasTheSameTotals) {
  const TemporaryFolder folder;
  const world::World world = parsed(kSmallWorld);
  for (std::uint64_t i = 1; i <= 2; ++i)
    ASSERT_TRUE(make(world, {i, 2}, folder.path(), std::nullopt));
  EXPECT_EQ(folder.file_count(), 2u);
  EXPECT_EQ(merged(folder.path())->hash.value(),
            amplify(world, registry(), kSharedRegion, {})->totals.hash.value());
}

TEST(Shard, ThatIsFinishedMakesNothingAndKnowsItsTotals) {
  const TemporaryFolder folder;
  const world::World world = parsed(kSmallWorld);
  const auto first = make(world, {1, 2}, folder.path(), Format::kGlb);
  const std::atomic<bool> stop{true};  // stops before any block
  const auto second = make(world, {1, 2}, folder.path(), Format::kGlb, &stop);
  ASSERT_TRUE(first && second);
  EXPECT_TRUE(second->complete);
  EXPECT_EQ(second->totals.hash.value(), first->totals.hash.value());
  EXPECT_EQ(second->totals.triangles, first->totals.triangles);
  const auto stopped = make(world, {2, 2}, folder.path(), Format::kGlb, &stop);
  EXPECT_TRUE(stopped->stopped);
  EXPECT_FALSE(stopped->complete);
  EXPECT_NE(merged(folder.path()).error().message.find("shard 2 of 2 has not finished"),
            std::string::npos);
}

TEST(Shard, RemakesBlocksWithMissingFiles) {
  const TemporaryFolder folder;
  const world::World world = parsed(kSmallWorld);
  const auto first = make(world, {1, 1}, folder.path(), Format::kGlb);
  const FileContents whole = contents_of(folder.path());
  std::filesystem::remove(folder / "block_2_1.glb");
  std::filesystem::resize_file(folder / "block_4_2.glb", 99);
  EXPECT_NE(merged(folder.path()).error().message.find("block 2,1 is missing"), std::string::npos);
  const auto again = make(world, {1, 1}, folder.path(), Format::kGlb);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->totals.hash.value(), first->totals.hash.value());
  EXPECT_TRUE(contents_of(folder.path()) == whole);
}

TEST(Shard, RemovesHalfWrittenFilesOfItsBlocksFromAnyHost) {
  const TemporaryFolder folder;
  const auto left = [&](const char* block) {
    return folder / ("." + std::string(block) + ".glb.99999999-0@another.partial");
  };
  for (const char* block : {"block_1_0", "block_4_2", "block_9_9"})
    std::ofstream(left(block)) << "half";
  ASSERT_TRUE(make(parsed(kSmallWorld), {1, 2}, folder.path(), Format::kGlb));
  EXPECT_FALSE(std::filesystem::exists(left("block_1_0")));
  EXPECT_TRUE(std::filesystem::exists(left("block_4_2"))) << "that of another shard";
  EXPECT_TRUE(std::filesystem::exists(left("block_9_9")));
}

TEST(Shard, WithFailingModelsIsIncomplete) {
  const TemporaryFolder folder;
  ThrowingWorld throwing;
  const auto run = [&]() -> core::Result<Report> {
    Options options;
    const JobKey key{"0.1.0", "w", 1, 2, kSharedRegion, std::nullopt};
    return amplify_shard({throwing.world, throwing.registry, key}, {1, 1}, folder.path(), options);
  };
  const auto broken = run();
  ASSERT_TRUE(broken);
  EXPECT_FALSE(broken->complete);
  EXPECT_FALSE(merged(folder.path()));
  throwing.throws = false;
  const auto mended = run();
  EXPECT_TRUE(mended->complete);
  EXPECT_EQ(merged(folder.path())->hash.value(), mended->totals.hash.value());
}

TEST(Shard, AfterAFullDiskALaterRunFinishesIt) {
  const TemporaryFolder top;
  const world::World world = parsed(kSmallWorld);
  const Report whole = one_process(world, top / "whole", Format::kGlb);
  bool all_fits = false;
  for (std::size_t calls = 0; !all_fits; calls += 17) {
    std::filesystem::remove_all(top / "cut");
    {
      const FullDisk full(top / "cut", calls);
      const auto made = make(world, {1, 1}, top / "cut", Format::kGlb);
      all_fits = !full.was_met();
      if (!made) {
        EXPECT_EQ(made.error().message.find((top / "cut").string()), 0u);
      }
    }
    const auto again = make(world, {1, 1}, top / "cut", Format::kGlb);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->totals.hash.value(), whole.totals.hash.value()) << calls;
    EXPECT_TRUE(blocks_in(top / "cut") == contents_of(top / "whole")) << calls;
  }
}

}  // namespace
}  // namespace psygen::amplify
