#include "engine/amplify/ledger.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <span>
#include <utility>

#include "engine/core/hash.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::amplify {

std::string_view name_of(const JobFormat& format) {
  return format ? exchange::name_of(*format) : kNoFiles;
}

core::Result<JobKey> job_key(const world::World& world, const models::Registry& registry,
                             const Region& region, JobFormat format, std::string_view version) {
  const core::BlockCoord middle{static_cast<std::int32_t>((region.x0 + region.x1) / 2),
                                static_cast<std::int32_t>((region.z0 + region.z1) / 2)};
  const auto sample = sample_world_hash(world, registry, middle);
  if (!sample) {
    return core::fail(core::ErrorCode::kSynthesisFailed,
                      fmt::format("the world {} cannot be divided: a model on the blocks around "
                                  "{},{} fails",
                                  world.name, middle.x, middle.z));
  }
  return JobKey{.version = std::string(version),
                .world = world.name,
                .world_hash = world::world_hash(world, registry),
                .sample_hash = *sample,
                .region = region,
                .format = format};
}

std::string difference(const JobKey& mine, const JobKey& theirs) {
  if (theirs.version != mine.version)
    return fmt::format("psygen {} instead of {}", theirs.version, mine.version);
  if (theirs.world_hash != mine.world_hash)
    return theirs.world == mine.world
               ? fmt::format("another version of the world {} or of the files that it names",
                             mine.world)
               : fmt::format("the world {} instead of {}", theirs.world, mine.world);
  if (theirs.region != mine.region)
    return fmt::format("the region {} instead of {}", text_of(theirs.region), text_of(mine.region));
  if (theirs.format != mine.format)
    return fmt::format("files of format {} instead of {}", name_of(theirs.format),
                       name_of(mine.format));
  if (theirs.sample_hash != mine.sample_hash)
    return fmt::format(
        "other bits for the same world (a sample has the hash {:016x} instead of "
        "{:016x}): another build of psygen",
        theirs.sample_hash, mine.sample_hash);
  return {};
}

namespace {

tl::unexpected<core::Error> io_error(const std::filesystem::path& file, const char* action) {
  return core::fail(core::ErrorCode::kIo,
                    fmt::format("{}: {}: {}", file.string(), action, std::strerror(errno)));
}

// Held by one process at a time while it looks for a ledger, creates or replaces it. File systems
// without locks are used unlocked.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& file)
      : handle_(::open(file.has_parent_path() ? file.parent_path().c_str() : ".",
                       O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (handle_ >= 0) (void)flock(handle_, LOCK_EX);
  }
  ~FolderLock() {
    if (handle_ >= 0) close(handle_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int handle_;
};

// True if the name still leads to the open file.
bool is_at(const std::filesystem::path& file, int handle) {
  struct stat named {
  }, opened{};
  return stat(file.c_str(), &named) == 0 && fstat(handle, &opened) == 0 &&
         named.st_ino == opened.st_ino && named.st_dev == opened.st_dev;
}

// Ledgers are lines of words, each with the checksum of its line.
constexpr std::size_t kMaxLedgerBytes = std::size_t{1} << 30;
constexpr std::string_view kFirstWords = "psygen ledger 1";
constexpr std::size_t kCheckBytes = 10;  // " ~" and eight digits
constexpr std::size_t kMaxNameBytes = 200;

std::string check_of(std::string_view line) {
  const std::uint64_t hash = core::hash_bytes(std::as_bytes(std::span(line.data(), line.size())));
  return fmt::format(" ~{:08x}", static_cast<std::uint32_t>(hash));
}

std::string checked(const std::string& line) {
  return line + check_of(line) + "\n";
}

// The next whole line without its checksum. Nothing at the end and for a line that does not match
// its checksum.
std::optional<std::string_view> take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos || end < kCheckBytes) return std::nullopt;
  const std::string_view line = text.substr(0, end - kCheckBytes);
  if (text.substr(end - kCheckBytes, kCheckBytes) != check_of(line)) return std::nullopt;
  text.remove_prefix(end + 1);
  return line;
}

// Reads numbers from the front of a line, separated by single spaces.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  bool word(std::string_view expected) {
    if (!rest_.starts_with(expected)) return false;
    rest_.remove_prefix(expected.size());
    if (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
    return true;
  }
  bool number(std::uint64_t& value, int base = 10) {
    const char* const end = rest_.data() + rest_.size();
    const auto parsed = std::from_chars(rest_.data(), end, value, base);
    if (parsed.ec != std::errc()) return false;
    rest_.remove_prefix(static_cast<std::size_t>(parsed.ptr - rest_.data()));
    if (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
    return true;
  }
  std::string rest() const { return std::string(rest_); }
  bool is_over() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

std::optional<Finished> finished_of(std::string_view line, const BlockRun& share) {
  Words words(line);
  Finished f;
  std::uint64_t sum = 0, count = 0;
  Totals& t = f.totals;
  const bool read = words.word("done") && words.number(f.run.first) && words.number(f.run.end) &&
                    words.number(t.models) && words.number(t.triangles) && words.number(t.bytes) &&
                    words.number(sum, 16) && words.number(count) && words.is_over();
  if (!read || f.run.first >= f.run.end || f.run.first < share.first || f.run.end > share.end)
    return std::nullopt;
  t.blocks = f.run.count();
  t.hash = synthesis::WorldHash::restored(sum, count);
  return f;
}

bool read_format(Words& words, JobFormat& format) {
  const std::string name = words.rest();
  format = exchange::format_from(name);
  return format.has_value() || name == kNoFiles;
}

bool read_region(Words& words, Region& region) {
  const auto parsed = parse_region(words.rest());
  if (parsed) region = *parsed;
  return parsed.has_value();
}

// Reads the lines before the entries. Returns false if one is missing or malformed.
bool read_head(std::string_view& text, LedgerText& ledger) {
  JobKey& key = ledger.key;
  const auto line = [&text](std::string_view name, auto&& take) {
    const auto taken = take_line(text);
    if (!taken) return false;
    Words words(*taken);
    return words.word(name) && take(words);
  };
  return line(kFirstWords, [](Words& w) { return w.is_over(); }) &&
         line("version", [&](Words& w) { return !(key.version = w.rest()).empty(); }) &&
         line("world",
              [&](Words& w) {
                const bool read = w.number(key.world_hash, 16);
                key.world = w.rest();
                return read;
              }) &&
         line("sample", [&](Words& w) { return w.number(key.sample_hash, 16); }) &&
         line("region", [&](Words& w) { return read_region(w, key.region); }) &&
         line("format", [&](Words& w) { return read_format(w, key.format); }) &&
         line("part", [&](Words& w) { return !(ledger.part = w.rest()).empty(); }) &&
         line("share", [&](Words& w) {
           return w.number(ledger.share.first) && w.number(ledger.share.end) &&
                  ledger.share.first <= ledger.share.end &&
                  ledger.share.end <= key.region.block_count();
         });
}

}  // namespace

std::string line_of(const Finished& finished) {
  const Totals& t = finished.totals;
  return checked(fmt::format("done {} {} {} {} {} {:x} {}", finished.run.first, finished.run.end,
                             t.models, t.triangles, t.bytes, t.hash.sum(), t.hash.count()));
}

std::string ledger_text(const LedgerText& ledger) {
  const JobKey& key = ledger.key;
  std::string text = checked(std::string(kFirstWords)) +
                     checked(fmt::format("version {}", key.version)) +
                     checked(fmt::format("world {:016x} {}", key.world_hash,
                                         core::shown(key.world, kMaxNameBytes))) +
                     checked(fmt::format("sample {:016x}", key.sample_hash)) +
                     checked(fmt::format("region {}", text_of(key.region))) +
                     checked(fmt::format("format {}", name_of(key.format))) +
                     checked(fmt::format("part {}", ledger.part)) +
                     checked(fmt::format("share {} {}", ledger.share.first, ledger.share.end));
  for (const Finished& finished : ledger.finished)
    text += line_of(finished);
  return text;
}

core::Result<LedgerText> parse_ledger(std::string_view text, const std::string& name) {
  LedgerText ledger;
  std::string_view rest = text;
  if (!read_head(rest, ledger))
    return core::fail(core::ErrorCode::kParse,
                      fmt::format("{}: is not a ledger of psygen amplify, or is damaged", name));
  std::size_t line_number = 8;
  while (const auto line = take_line(rest)) {
    ++line_number;
    const auto finished = finished_of(*line, ledger.share);
    if (!finished)
      return core::fail(core::ErrorCode::kParse,
                        fmt::format("{}:{}: is not a line of a ledger", name, line_number));
    ledger.finished.push_back(*finished);
  }
  ledger.whole_bytes = text.size() - rest.size();
  if (rest.find('\n') != std::string_view::npos)
    return core::fail(core::ErrorCode::kParse,
                      fmt::format("{}:{}: is damaged", name, line_number + 1));
  return ledger;
}

core::Result<LedgerText> read_ledger(const std::filesystem::path& file) {
  const auto text = world::read_text_file(file, kMaxLedgerBytes);
  if (!text) return tl::unexpected(text.error());
  return parse_ledger(*text, file.string());
}

core::Result<BlockRanges> blocks_of(const std::vector<Finished>& finished) {
  std::vector<BlockRun> runs;
  for (const Finished& f : finished)
    runs.push_back(f.run);
  std::ranges::sort(runs, {}, &BlockRun::first);
  BlockRanges blocks;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (i > 0 && runs[i].first < runs[i - 1].end)
      return core::invalid_argument(
          fmt::format("the blocks {} are listed twice",
                      BlockRanges({runs[i].first, std::min(runs[i].end, runs[i - 1].end)}).text()));
    blocks.append(runs[i]);
  }
  return blocks;
}

std::vector<Finished> compacted(std::vector<Finished> finished) {
  std::ranges::sort(finished, {}, [](const Finished& f) { return f.run.first; });
  std::vector<Finished> joined;
  for (Finished& f : finished) {
    if (!joined.empty() && joined.back().run.end == f.run.first &&
        f.run.end - joined.back().run.first <= kMaxCompacted) {
      joined.back().run.end = f.run.end;
      joined.back().totals.add(f.totals);
    } else {
      joined.push_back(std::move(f));
    }
  }
  return joined;
}

Ledger::Ledger(std::filesystem::path file, LedgerText content)
    : file_(std::move(file)), content_(std::move(content)) {
  content_.finished.clear();
}

Ledger::~Ledger() {
  if (handle_ >= 0) close(handle_);
}

core::Result<std::unique_ptr<Ledger>> Ledger::open(std::filesystem::path file, LedgerText ledger) {
  std::unique_ptr<Ledger> opened(new Ledger(std::move(file), std::move(ledger)));
  const FolderLock alone(opened->file_);
  std::error_code error;
  if (!std::filesystem::exists(opened->file_, error)) {
    if (auto ok = opened->replace({}); !ok) return tl::unexpected(ok.error());
    return opened;
  }
  if (auto ok = opened->lock(); !ok) return tl::unexpected(ok.error());
  auto theirs = read_ledger(opened->file_);
  if (!theirs) return tl::unexpected(theirs.error());
  if (auto ok = opened->take_over(std::move(*theirs)); !ok) return tl::unexpected(ok.error());
  return opened;
}

// Opens the file to append and locks it. File systems without locks are used unlocked.
core::Result<void> Ledger::lock() {
  // O_NONBLOCK: a pipe would wait for a reader.
  const int handle = ::open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NONBLOCK);
  if (handle < 0) return io_error(file_, "cannot be opened");
  struct stat status {};
  if (fstat(handle, &status) != 0 || !S_ISREG(status.st_mode)) {
    close(handle);
    return core::fail(core::ErrorCode::kIo, file_.string() + ": is not a regular file");
  }
  const bool refused = flock(handle, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (refused || !is_at(file_, handle)) {
    close(handle);
    return core::invalid_argument(fmt::format("{}: another process is writing it", file_.string()));
  }
  if (handle_ >= 0) close(handle_);
  handle_ = handle;
  return {};
}

core::Result<void> Ledger::take_over(LedgerText theirs) {
  const auto refuse = [this](const std::string& why) {
    return core::invalid_argument(
        fmt::format("{}: belongs to {}; choose another folder", file_.string(), why));
  };
  const std::string other = difference(content_.key, theirs.key);
  if (!other.empty()) return refuse(other);
  if (theirs.part != content_.part) return refuse(theirs.part + " instead of " + content_.part);
  if (theirs.share != content_.share)
    return refuse(fmt::format("the blocks {} instead of {}", BlockRanges(theirs.share).text(),
                              BlockRanges(content_.share).text()));
  if (auto once = blocks_of(theirs.finished); !once)
    return core::fail(core::ErrorCode::kParse,
                      fmt::format("{}: {}", file_.string(), once.error().message));
  content_ = std::move(theirs);
  if (ftruncate(handle_, static_cast<off_t>(content_.whole_bytes)) != 0)
    return io_error(file_, "cannot be truncated");
  return {};
}

core::Result<void> Ledger::rewrite(std::vector<Finished> finished) {
  const FolderLock alone(file_);
  return replace(std::move(finished));
}

core::Result<void> Ledger::replace(std::vector<Finished> finished) {
  content_.finished = std::move(finished);
  if (auto ok = core::replace_file(file_, ledger_text(content_)); !ok) return ok;
  return lock();
}

core::Result<void> Ledger::add(const Finished& finished) {
  const std::string line = line_of(finished);
  const std::lock_guard lock(mutex_);
  ssize_t written = -1;
  do {
    written = write(handle_, line.data(), line.size());
  } while (written < 0 && errno == EINTR);
  if (written != static_cast<ssize_t>(line.size())) {
    const int reason = written < 0 ? errno : ENOSPC;
    // A half line would corrupt the lines of other threads after it.
    if (written > 0 && ftruncate(handle_, lseek(handle_, 0, SEEK_END) - written) != 0)
      return io_error(file_, "cannot be truncated");
    errno = reason;
    return io_error(file_, "cannot write");
  }
  content_.finished.push_back(finished);
  return {};
}

}  // namespace psygen::amplify
