#include "engine/amplify/ledger.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <barrier>
#include <csignal>
#include <fstream>
#include <thread>

#include "tests/engine/amplify/ledgers.hpp"
#include "tests/full_disk.hpp"

namespace psygen::amplify {
namespace {

TEST(Ledger, ReadsBackEqual) {
  const LedgerText ledger = some_ledger({{0, 5}, {7, 9}});
  const auto read = parse_ledger(ledger_text(ledger), "a.ledger");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->key, ledger.key);
  EXPECT_EQ(read->part, ledger.part);
  EXPECT_EQ(read->share, ledger.share);
  ASSERT_EQ(read->finished.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const Totals &mine = ledger.finished[i].totals, &theirs = read->finished[i].totals;
    EXPECT_EQ(read->finished[i].run, ledger.finished[i].run);
    EXPECT_EQ(theirs.blocks, mine.blocks);
    EXPECT_EQ(theirs.models, mine.models);
    EXPECT_EQ(theirs.triangles, mine.triangles);
    EXPECT_EQ(theirs.bytes, mine.bytes);
    EXPECT_EQ(theirs.hash.value(), mine.hash.value());
  }
}

TEST(Ledger, ThatIsTruncatedAnywhereLosesItsLastLineOrIsRejected) {
  const std::string text = ledger_text(some_ledger({{0, 5}, {7, 9}}));
  const std::size_t head = ledger_text(some_ledger({})).size();
  const std::size_t one = ledger_text(some_ledger({{0, 5}})).size();
  for (std::size_t bytes = 0; bytes < text.size(); ++bytes) {
    const auto read = parse_ledger(text.substr(0, bytes), "a.ledger");
    ASSERT_EQ(read.has_value(), bytes >= head) << bytes;
    if (!read) continue;
    EXPECT_EQ(read->finished.size(), bytes >= one ? 1u : 0u) << bytes;
    EXPECT_EQ(read->whole_bytes, bytes >= one ? one : head) << bytes;
  }
}

TEST(Ledger, WithAnyOtherByteIsRejected) {
  const std::string text = ledger_text(some_ledger({{0, 5}, {7, 9}}));
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    std::string other = text;
    other[i] = other[i] == '1' ? '2' : '1';
    const auto read = parse_ledger(other, "a.ledger");
    ASSERT_FALSE(read) << i;
    EXPECT_TRUE(read.error().message.starts_with("a.ledger:")) << read.error().message;
  }
  EXPECT_FALSE(parse_ledger("", "a.ledger"));
  EXPECT_FALSE(parse_ledger(std::string(1000, '\0'), "a.ledger"));
}

TEST(Ledger, HasOnlyBlocksOfItsShare) {
  LedgerText ledger = some_ledger({{0, 5}, {7, 9}});
  ledger.share.end = 8;
  const auto read = parse_ledger(ledger_text(ledger), "a.ledger");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "a.ledger:10: is not a line of a ledger");
}

TEST(Ledger, ResumesAndDropsATruncatedLine) {
  const TemporaryFolder folder;
  const auto file = folder / "shard_1_of_2.ledger";
  {
    auto ledger = Ledger::open(file, some_ledger({}));
    ASSERT_TRUE(ledger) << ledger.error().message;
    EXPECT_TRUE((*ledger)->add(entry({0, 5})));
    EXPECT_TRUE((*ledger)->add(entry({7, 9})));
  }
  std::ofstream(file, std::ios::app) << "done 5 7 1";
  {
    auto ledger = Ledger::open(file, some_ledger({}));
    ASSERT_TRUE(ledger) << ledger.error().message;
    EXPECT_EQ((*ledger)->finished().size(), 2u);
    EXPECT_TRUE((*ledger)->add(entry({5, 7})));
  }
  auto ledger = Ledger::open(file, some_ledger({}));
  ASSERT_TRUE(ledger) << ledger.error().message;
  ASSERT_EQ((*ledger)->finished().size(), 3u);
  EXPECT_TRUE((*ledger)->rewrite(compacted((*ledger)->finished())));
  EXPECT_EQ(contents_of(folder.path()).at("shard_1_of_2.ledger"),
            ledger_text(some_ledger({{0, 9}})));
}

TEST(Ledger, IsWrittenByOneAtATime) {
  const TemporaryFolder folder;
  const auto first = Ledger::open(folder / "a.ledger", some_ledger({}));
  ASSERT_TRUE(first);
  const auto second = Ledger::open(folder / "a.ledger", some_ledger({}));
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("another process is writing it"), std::string::npos);
}

// The first process creates it; the others find it locked.
TEST(Ledger, IsCreatedByOneOfManyConcurrentProcesses) {
  const TemporaryFolder folder;
  for (int round = 0; round < 40; ++round) {
    const auto file = folder / (std::to_string(round) + ".ledger");
    std::array<std::unique_ptr<Ledger>, 4> opened;
    std::barrier start(opened.size());
    std::vector<std::jthread> threads;
    for (std::unique_ptr<Ledger>& mine : opened) {
      threads.emplace_back([&] {
        start.arrive_and_wait();
        if (auto ledger = Ledger::open(file, some_ledger({}))) mine = std::move(*ledger);
      });
    }
    threads.clear();
    EXPECT_EQ(std::ranges::count_if(opened, [](const auto& l) { return l != nullptr; }), 1)
        << round;
  }
}

TEST(Ledger, OfAnotherJobPartOrShareIsNotChanged) {
  const TemporaryFolder folder;
  const auto file = folder / "a.ledger";
  ASSERT_TRUE(Ledger::open(file, some_ledger({})));
  const std::string before = contents_of(folder.path()).at("a.ledger");
  const auto refused = [&](auto&& change, const std::string& words) {
    LedgerText other = some_ledger({});
    change(other);
    const auto ledger = Ledger::open(file, other);
    ASSERT_FALSE(ledger) << words;
    EXPECT_NE(ledger.error().message.find(words), std::string::npos) << ledger.error().message;
  };
  refused([](LedgerText& l) { l.key.version = "9.9"; }, "psygen 0.1.0 instead of 9.9");
  refused([](LedgerText& l) { l.key.world_hash += 1; }, "another version of the world small");
  refused([](LedgerText& l) { l.key.world_hash += 1, l.key.world = "big"; },
          "the world small instead of big");
  refused([](LedgerText& l) { l.key.region.x1 = 9; }, "the region 0,0,10,1 instead of 0,0,9,1");
  refused([](LedgerText& l) { l.key.format.reset(); }, "files of format glb instead of none");
  refused([](LedgerText& l) { l.key.sample_hash += 1; }, "another build of psygen");
  refused([](LedgerText& l) { l.part = "shard 2 of 2"; }, "shard 1 of 2 instead of shard 2 of 2");
  refused([](LedgerText& l) { l.share.end = 6; }, "the blocks 0-9 instead of 0-5");
  std::ofstream(folder / "b.ledger") << "a letter\n";
  EXPECT_FALSE(Ledger::open(folder / "b.ledger", some_ledger({})));
  EXPECT_EQ(contents_of(folder.path()).at("a.ledger"), before);
  EXPECT_EQ(contents_of(folder.path()).at("b.ledger"), "a letter\n");
}

// A full disk may lose the line that is being written, and no other.
TEST(Ledger, OnAFullDiskKeepsItsEntries) {
  for (std::size_t calls = 0; calls < 3; ++calls) {
    const TemporaryFolder folder;
    auto ledger = Ledger::open(folder / "a.ledger", some_ledger({}));
    ASSERT_TRUE(ledger);
    ASSERT_TRUE((*ledger)->add(entry({0, 5})));
    {
      const FullDisk full(folder.path(), calls);
      core::Result<void> added{};
      for (std::uint64_t i = 5; added && i < 9; ++i)
        added = (*ledger)->add(entry({i, i + 1}));
      ASSERT_FALSE(added);
      EXPECT_EQ(added.error().code, core::ErrorCode::kIo);
      EXPECT_NE(added.error().message.find("a.ledger: cannot write: No space"), std::string::npos);
    }
    ledger->reset();
    const auto read = read_ledger(folder / "a.ledger");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->finished.size(), 1 + calls);
  }
}

// A half-written line is removed, because lines of other threads follow it.
TEST(Ledger, KeepsNoHalfLine) {
  const TemporaryFolder folder;
  const auto file = folder / "a.ledger";
  auto ledger = Ledger::open(file, some_ledger({}));
  ASSERT_TRUE(ledger);
  ASSERT_TRUE((*ledger)->add(entry({0, 5})));
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto size = std::filesystem::file_size(file);
  const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit five_bytes_more{size + 5, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &five_bytes_more), 0);
  const auto added = (*ledger)->add(entry({5, 6}));
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, ignored);
  ASSERT_FALSE(added);
  EXPECT_EQ(std::filesystem::file_size(file), size);
  ASSERT_TRUE((*ledger)->add(entry({6, 7})));
  ledger->reset();
  const auto read = read_ledger(file);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->finished.size(), 2U);
}

}  // namespace
}  // namespace psygen::amplify
