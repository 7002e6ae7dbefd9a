#include "engine/amplify/ledger.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "engine/core/replace_file.hpp"

namespace psygen::amplify {
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

}  // namespace

core::Result<BlockRanges> blocks_of(const std::vector<Finished>& finished) {
  std::vector<BlockRun> runs;
  for (const Finished& f : finished)
    runs.push_back(f.run);
  std::ranges::sort(runs, {}, &BlockRun::first);
  BlockRanges blocks;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (i > 0 && runs[i].first < runs[i - 1].end)
      return core::fail(
          core::ErrorCode::kInvalidArgument,
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
  const int handle = ::open(file_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (handle < 0) return io_error(file_, "cannot be opened");
  const bool refused = flock(handle, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (refused || !is_at(file_, handle)) {
    close(handle);
    return core::fail(core::ErrorCode::kInvalidArgument,
                      fmt::format("{}: another process is writing it", file_.string()));
  }
  if (handle_ >= 0) close(handle_);
  handle_ = handle;
  return {};
}

core::Result<void> Ledger::take_over(LedgerText theirs) {
  const auto refuse = [this](const std::string& why) {
    return core::fail(core::ErrorCode::kInvalidArgument,
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
