#include "engine/cluster/job.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <mutex>

#include "engine/amplify/merge.hpp"
#include "tests/engine/cluster/threads_as_ranks.hpp"
#include "tests/engine/world/shipped.hpp"
#include "tests/full_disk.hpp"

namespace psygen::cluster {
namespace {

using exchange::Format;
using world::testing::kSmallWorld;
using world::testing::parsed;
using world::testing::registry;
using Outcome = tl::expected<JobReport, JobError>;

// Differences between ranks.
struct RankSetup {
  world::World world = parsed(kSmallWorld);
  std::string version = "0.1.0";
  std::filesystem::path folder{};
  amplify::JobFormat format = Format::kGlb;
  amplify::Options options{};
};

std::vector<Outcome> run_ranks(unsigned count, const std::function<RankSetup(unsigned)>& setup) {
  std::vector<Outcome> outcomes(count, tl::unexpected(JobError{}));
  ThreadsAsRanks(count).run([&](Peers& peers) {
    const RankSetup mine = setup(peers.rank());
    const auto key =
        amplify::job_key(mine.world, registry(), {0, 0, 6, 4}, mine.format, mine.version);
    outcomes[peers.rank()] =
        amplify_together(mine.world, registry(), key, mine.folder, mine.options, peers);
  });
  return outcomes;
}

std::vector<Outcome> run_ranks(unsigned count, const std::filesystem::path& folder,
                               amplify::JobFormat format = Format::kGlb) {
  return run_ranks(count, [&](unsigned) {
    RankSetup setup;
    setup.folder = folder;
    setup.format = format;
    setup.options.threads = 2;
    return setup;
  });
}

amplify::Report alone(const std::filesystem::path& folder) {
  const world::World world = parsed(kSmallWorld);
  const auto files = amplify::BlockFolder::open(folder, world, registry(), Format::kGlb);
  amplify::Options options;
  options.make_sink = [&] { return (*files)->make_sink(); };
  return *amplify::amplify(world, registry(), {0, 0, 6, 4}, options);
}

FileContents blocks_in(const std::filesystem::path& folder) {
  FileContents contents = contents_of(folder);
  std::erase_if(contents, [](const auto& file) { return file.first.ends_with(".ledger"); });
  return contents;
}

TEST(Job, HasTheFilesAndTheHashOfOneProcessForAnyNumberOfRanks) {
  const TemporaryFolder top;
  const amplify::Report whole = alone(top / "alone");
  const FileContents files = contents_of(top / "alone");
  for (const unsigned ranks : {1u, 2u, 5u}) {
    const auto folder = top / fmt::format("ranks{}", ranks);
    const auto outcomes = run_ranks(ranks, folder);
    for (const Outcome& outcome : outcomes) {
      ASSERT_TRUE(outcome) << outcome.error().error.message;
      EXPECT_TRUE(outcome->report.complete);
      EXPECT_EQ(outcome->written, 24u);
      EXPECT_EQ(outcome->report.threads, 2 * ranks);
    }
    EXPECT_EQ(outcomes[0]->report.totals.hash.value(), whole.totals.hash.value());
    EXPECT_EQ(outcomes[0]->report.totals.triangles, whole.totals.triangles);
    EXPECT_TRUE(blocks_in(folder) == files);
    EXPECT_EQ(contents_of(folder).size(), files.size() + 1);  // job.ledger
    const auto ledgers = amplify::read_ledgers(std::vector{folder});
    EXPECT_EQ(amplify::merge(*ledgers)->hash.value(), whole.totals.hash.value());
  }
}

TEST(Job, ReportsStatisticsWithoutAFolder) {
  const auto outcomes = run_ranks(3, "", std::nullopt);
  ASSERT_TRUE(outcomes[0]) << outcomes[0].error().error.message;
  EXPECT_EQ(outcomes[0]->report.totals.blocks, 24u);
  EXPECT_EQ(outcomes[0]->written, 0u);
}

TEST(Job, MakesNothingAgainOnceFinishedForAnyNumberOfRanks) {
  const TemporaryFolder top;
  const auto first = run_ranks(3, top / "job");
  const FileContents files = contents_of(top / "job");
  for (const unsigned ranks : {1u, 4u}) {
    const auto again = run_ranks(ranks, top / "job");
    ASSERT_TRUE(again[0]);
    EXPECT_EQ(again[0]->written + again[0]->skipped, 0u);
    EXPECT_EQ(again[0]->report.totals.hash.value(), first[0]->report.totals.hash.value());
    EXPECT_TRUE(contents_of(top / "job") == files);
  }
  std::filesystem::remove(top / "job/block_3_2.glb");
  const auto mended = run_ranks(2, top / "job");
  ASSERT_TRUE(mended[0]);
  EXPECT_EQ(mended[0]->written, 1u);
  EXPECT_EQ(mended[0]->report.totals.hash.value(), first[0]->report.totals.hash.value());
  EXPECT_TRUE(contents_of(top / "job") == files);
}

// Expects every rank to fail before the first block with the same message.
void expect_refused(const std::vector<Outcome>& outcomes, const std::string& words) {
  for (const Outcome& outcome : outcomes) {
    ASSERT_FALSE(outcome);
    EXPECT_TRUE(outcome.error().common);
    EXPECT_NE(outcome.error().error.message.find(words), std::string::npos)
        << outcome.error().error.message;
  }
}

TEST(Job, DoesNotBeginIfRanksDisagree) {
  const TemporaryFolder top;
  const auto with = [&](const std::function<void(RankSetup&)>& change) {
    return run_ranks(3, [&](unsigned rank) {
      RankSetup setup;
      setup.folder = top / "job";
      if (rank == 2) change(setup);
      return setup;
    });
  };
  expect_refused(with([](RankSetup& s) { s.version = "0.2.0"; }), "psygen 0.2.0 instead of 0.1.0");
  expect_refused(with([](RankSetup& s) { s.world.name = "other"; }), "rank 2 (host2, ");
  expect_refused(with([](RankSetup& s) { s.world.name = "other"; }),
                 "the world other instead of small");
  expect_refused(with([](RankSetup& s) { s.format = Format::kObj; }), "format obj instead of glb");
  expect_refused(with([](RankSetup& s) { s.folder.clear(); }),
                 "rank 0 has --out and rank 2 has none");
  EXPECT_FALSE(std::filesystem::exists(top / "job"));
  expect_refused(
      with([&](RankSetup& s) { s.folder = top / "elsewhere"; }),
      "files that rank 0 writes there are not visible on host2; --out must be a folder that all "
      "ranks share");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(top / "job"), {}), 0);
}

TEST(Job, CanBeStoppedAndResumed) {
  const TemporaryFolder top;
  const amplify::Report whole = alone(top / "alone");
  const std::atomic<bool> stop{true};
  const auto stopped = run_ranks(2, [&](unsigned) {
    RankSetup setup;
    setup.folder = top / "job";
    setup.options.stop = &stop;
    return setup;
  });
  for (const Outcome& outcome : stopped)
    EXPECT_TRUE(outcome->report.stopped);
  EXPECT_TRUE(std::filesystem::exists(top / "job/rank_1.ledger"));
  const auto later = run_ranks(3, top / "job");
  ASSERT_TRUE(later[0]) << later[0].error().error.message;
  EXPECT_EQ(later[0]->report.totals.hash.value(), whole.totals.hash.value());
  EXPECT_TRUE(blocks_in(top / "job") == contents_of(top / "alone"));
}

TEST(Job, ResumesFromLedgersOfDeadRanksAndRejectsThoseOfOtherJobs) {
  const TemporaryFolder top;
  const auto first = run_ranks(1, top / "job");
  // Simulates that rank 7 died after half of them, in the middle of a line.
  const auto ledger = amplify::read_ledger(top / "job/job.ledger");
  amplify::LedgerText theirs = *ledger;
  theirs.part = "rank 7";
  std::filesystem::remove(top / "job/job.ledger");
  std::ofstream(top / "job/rank_7.ledger") << amplify::ledger_text(theirs) << "done 3 4";
  const auto partial = top / "job/.rank_3.ledger.17-0@anotherhost.partial";
  std::ofstream(partial) << "half";
  const auto again = run_ranks(2, top / "job");
  ASSERT_TRUE(again[0]) << again[0].error().error.message;
  EXPECT_EQ(again[0]->skipped, 0u);
  EXPECT_EQ(again[0]->report.totals.hash.value(), first[0]->report.totals.hash.value());
  EXPECT_FALSE(std::filesystem::exists(top / "job/rank_7.ledger"));
  EXPECT_FALSE(std::filesystem::exists(partial));
  theirs.key.version = "0.0.1";
  std::ofstream(top / "job/rank_7.ledger") << amplify::ledger_text(theirs);
  expect_refused(run_ranks(2, top / "job"),
                 "rank_7.ledger: belongs to psygen 0.0.1 instead of 0.1.0");
}

TEST(Job, ReportsAFullDisk) {
  const TemporaryFolder top;
  for (const std::size_t calls : {3u, 40u}) {
    const FullDisk full(top / "job", calls);
    const auto outcomes = run_ranks(1, top / "job");
    ASSERT_FALSE(outcomes[0]);
    EXPECT_EQ(outcomes[0].error().error.code, core::ErrorCode::kIo);
    EXPECT_NE(outcomes[0].error().error.message.find("No space left"), std::string::npos);
  }
  EXPECT_TRUE(run_ranks(2, top / "job")[0]->report.complete);
}

TEST(Job, ThreadsOfARankMatchItsPartOfTheMachine) {
  EXPECT_EQ(threads_for_rank(2, 2, 8), 1u);
  EXPECT_EQ(threads_for_rank(16, 32, 2), 16u);  // bound to a socket
  EXPECT_EQ(threads_for_rank(1, 16, 4), 1u);    // bound to a core
  EXPECT_EQ(threads_for_rank(64, 64, 1), 64u);
  EXPECT_EQ(threads_for_rank(0, 0, 0), 1u);
}

}  // namespace
}  // namespace psygen::cluster
