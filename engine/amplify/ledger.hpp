// The finished blocks of a part of a job, as a text file next to the blocks: an identification,
// then one line with totals for each run of blocks. Lines are appended whole and have checksums, so
// a part that is killed at any moment can be resumed: a truncated line counts as not written. A
// line is written after the files of its blocks. Not a log for people, and not a lock of the
// folder. `add()` from any thread, everything else from one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/amplify/block_ranges.hpp"
#include "engine/amplify/block_synthesiser.hpp"
#include "engine/amplify/region.hpp"
#include "engine/exchange/write_document.hpp"
#include "engine/models/registry.hpp"

namespace psygen::amplify {

// The format of a job's files; nothing: no files, only statistics.
using JobFormat = std::optional<exchange::Format>;
inline constexpr std::string_view kNoFiles = "none";
// "glb", "obj" or "none".
std::string_view name_of(const JobFormat& format);

// The common properties of all parts of one job: the world, its region, the files, and the version
// that makes them. Parts with different keys would make different bits and are never joined.
struct JobKey {
  std::string version;            // version of psygen
  std::string world;              // the world's name, for messages
  std::uint64_t world_hash = 0;   // world::world_hash()
  std::uint64_t sample_hash = 0;  // of blocks in the middle of the region, all levels of detail
  Region region;
  JobFormat format;
  friend bool operator==(const JobKey&, const JobKey&) = default;
};

// The key of a job. Makes 9 blocks. Fails with kSynthesisFailed if one of their models fails.
core::Result<JobKey> job_key(const world::World& world, const models::Registry& registry,
                             const Region& region, JobFormat format, std::string_view version);

// The difference between `theirs` and `mine`, as in "the region 0,0,8,8 instead of 0,0,4,4"; empty
// if they are equal.
std::string difference(const JobKey& mine, const JobKey& theirs);

inline constexpr std::string_view kLedgerExtension = ".ledger";

// Finished blocks and their totals. None of their meshes failed.
struct Finished {
  BlockRun run;
  Totals totals;
};

// The content of a ledger.
struct LedgerText {
  JobKey key;
  std::string part;  // "shard 3 of 8", "rank 2"
  BlockRun share;    // an upper bound of the part's blocks
  std::vector<Finished> finished;
  std::size_t whole_bytes = 0;  // size up to the end of the last whole line
};

// The blocks of all entries. Fails with kInvalidArgument if two entries have a block in common.
core::Result<BlockRanges> blocks_of(const std::vector<Finished>& finished);
// Entries in ascending order. Adjacent entries are joined up to kMaxCompacted blocks, which is the
// cost of one lost file.
inline constexpr std::uint64_t kMaxCompacted = 4096;
std::vector<Finished> compacted(std::vector<Finished> finished);

// The text of a whole ledger, and the line of an entry.
std::string line_of(const Finished& finished);
std::string ledger_text(const LedgerText& ledger);
// Reads such a text; `name` is for messages. A truncated last line is ignored. A truncated head,
// like any other text that psygen did not write, fails with kParse.
core::Result<LedgerText> parse_ledger(std::string_view text, const std::string& name);
core::Result<LedgerText> read_ledger(const std::filesystem::path& file);

// A ledger that is being written. The file is locked during that time, if its file system can lock.
class Ledger {
 public:
  // Opens or creates `file` for the part with the key, name and share of `ledger`;
  // `ledger.finished` is ignored. finished() then has the entries of the file. Fails with kIo, with
  // kInvalidArgument if the file belongs to another job, part or share or another process writes
  // it, and with kParse if psygen did not write it.
  static core::Result<std::unique_ptr<Ledger>> open(std::filesystem::path file, LedgerText ledger);
  ~Ledger();
  Ledger(const Ledger&) = delete;
  Ledger& operator=(const Ledger&) = delete;

  const std::vector<Finished>& finished() const { return content_.finished; }
  const JobKey& key() const { return content_.key; }
  // Replaces the whole content by these entries. Fails with kIo.
  core::Result<void> rewrite(std::vector<Finished> finished);
  // Appends an entry. Any thread. Fails with kIo.
  core::Result<void> add(const Finished& finished);

 private:
  Ledger(std::filesystem::path file, LedgerText content);
  core::Result<void> lock();
  core::Result<void> replace(std::vector<Finished> finished);
  core::Result<void> take_over(LedgerText theirs);

  std::filesystem::path file_;
  LedgerText content_;
  std::mutex mutex_;
  int handle_ = -1;
};

}  // namespace psygen::amplify
