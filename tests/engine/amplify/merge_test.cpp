#include "engine/amplify/merge.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/engine/amplify/ledgers.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::amplify {
namespace {

// Shard `i` of 2, without files, with this share.
NamedLedger shard(int i, BlockRun share, std::initializer_list<BlockRun> finished) {
  LedgerText ledger = some_ledger(finished);
  ledger.key.format.reset();
  ledger.part = "shard " + std::to_string(i) + " of 2";
  ledger.share = share;
  return {"s/shard_" + std::to_string(i) + "_of_2.ledger", ledger};
}

std::string refused(const std::vector<NamedLedger>& ledgers) {
  const auto totals = merge(ledgers);
  return totals ? "joined" : totals.error().message;
}

TEST(Merge, AddsUpToTheWhole) {
  const auto totals =
      merge(std::vector{shard(1, {0, 6}, {{3, 6}, {0, 3}}), shard(2, {6, 10}, {{6, 10}})});
  ASSERT_TRUE(totals) << totals.error().message;
  const Totals whole = entry({0, 10}).totals;
  EXPECT_EQ(totals->blocks, whole.blocks);
  EXPECT_EQ(totals->triangles, whole.triangles);
  EXPECT_EQ(totals->hash.value(), whole.hash.value());
}

TEST(Merge, NamesMissingBlocks) {
  EXPECT_EQ(refused({}), "there is no ledger to merge");
  EXPECT_EQ(refused({shard(1, {0, 6}, {{0, 6}})}),
            "4 blocks from 6,0 to 9,0 are missing: the ledger of their shard is missing");
  EXPECT_EQ(refused({shard(2, {6, 10}, {{6, 10}})}),
            "6 blocks from 0,0 to 5,0 are missing: the ledger of their shard is missing");
  EXPECT_EQ(refused({shard(1, {0, 6}, {{0, 2}, {3, 6}}), shard(2, {6, 10}, {{6, 10}})}),
            "the block 2,0 is missing: shard 1 of 2 has not finished (s/shard_1_of_2.ledger)");
}

TEST(Merge, NamesDuplicateBlocksAndOtherJobs) {
  EXPECT_EQ(refused({shard(1, {0, 6}, {{0, 6}}), shard(2, {4, 10}, {{4, 10}})}),
            "2 blocks from 4,0 to 5,0 are in both s/shard_1_of_2.ledger and s/shard_2_of_2.ledger");
  NamedLedger other = shard(2, {6, 10}, {{6, 10}});
  other.ledger.key.version = "0.2.0";
  EXPECT_EQ(
      refused({shard(1, {0, 6}, {{0, 6}}), other}),
      "s/shard_2_of_2.ledger: belongs to another job than s/shard_1_of_2.ledger: psygen 0.2.0 "
      "instead of 0.1.0");
}

TEST(Merge, ChecksTheFilesOfBlocks) {
  const TemporaryFolder folder;
  LedgerText whole = some_ledger({{0, 10}});
  whole.key.format = exchange::Format::kObj;
  const auto said = refused({{folder / "shard_1_of_2.ledger", whole}});
  EXPECT_NE(said.find("the file of block 0,0 is missing"), std::string::npos) << said;
}

TEST(Merge, ReadsLedgersFromFoldersAndFiles) {
  const TemporaryFolder folder;
  const std::vector<std::filesystem::path> paths{folder.path()};
  EXPECT_NE(read_ledgers(paths).error().message.find("has no ledger"), std::string::npos);
  std::ofstream(folder / "b.ledger") << ledger_text(some_ledger({{0, 5}}));
  std::ofstream(folder / "a.ledger") << ledger_text(some_ledger({{5, 10}}));
  std::ofstream(folder / "world.toml") << "format = 1\n";
  const auto ledgers = read_ledgers(paths);
  ASSERT_TRUE(ledgers) << ledgers.error().message;
  ASSERT_EQ(ledgers->size(), 2u);
  EXPECT_EQ(ledgers->front().file, folder / "a.ledger");
  const std::vector<std::filesystem::path> one{folder / "b.ledger"}, none{folder / "c.ledger"};
  EXPECT_EQ(read_ledgers(one)->size(), 1u);
  EXPECT_FALSE(read_ledgers(none));
  std::ofstream(folder / "a.ledger") << "cut";
  EXPECT_FALSE(read_ledgers(paths));
}

}  // namespace
}  // namespace psygen::amplify
