#include "engine/core/replace_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <utility>

#include "engine/core/hash.hpp"

namespace psygen::core {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{64} << 10;

// Identifies the host and the container, within which process ids are unique.
const std::string& host_mark() {
  static const std::string mark = [] {
    char name[256] = "", space[64] = "";
    if (gethostname(name, sizeof(name) - 1) != 0) name[0] = '\0';
    if (readlink("/proc/self/ns/pid", space, sizeof(space) - 1) < 0) space[0] = '\0';
    const std::string both = std::string(name) + space;
    const std::uint64_t hash = hash_bytes(std::as_bytes(std::span(both)));
    return fmt::format("{:08x}", static_cast<std::uint32_t>(hash));
  }();
  return mark;
}

// Returns the file that a chain of links leads to, whether it exists or not.
std::filesystem::path without_links(std::filesystem::path path) {
  std::error_code error;
  for (int links = 0; links < 40 && std::filesystem::is_symlink(path, error); ++links) {
    const std::filesystem::path next = std::filesystem::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / next;  // replaces the whole path if the link is absolute
  }
  return path;
}

// A file as it is before its replacement.
struct Existing {
  bool exists = false;
  struct statx status {};
  const char* refusal = nullptr;  // the reason not to replace it; null: none
};

Existing look_at(const std::filesystem::path& target) {
  Existing file;
  file.exists = statx(AT_FDCWD, target.c_str(), 0, STATX_TYPE | STATX_MODE | STATX_UID | STATX_GID,
                      &file.status) == 0;
  if (!file.exists)
    file.refusal = errno == ELOOP ? std::strerror(ELOOP) : nullptr;
  else if (!S_ISREG(file.status.stx_mode))
    file.refusal = "is not a regular file, and is not replaced";
  else if ((file.status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0)
    file.refusal = "is a mount point, and cannot be replaced";
  else if (access(target.c_str(), W_OK) != 0)
    file.refusal = "the file is read-only";
  return file;
}

// Opens a new file next to `path` and stores its name; returns -1 and sets errno if that fails.
int open_temporary(const std::filesystem::path& path, std::filesystem::path& temporary) {
  int file = -1;
  for (int attempt = 0; attempt < 100 && file < 0; ++attempt) {
    temporary = path.parent_path() / fmt::format(".{}.{}-{}@{}.partial", path.filename().string(),
                                                 getpid(), attempt, host_mark());
    file = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0 && errno != EEXIST) break;
  }
  return file;
}

void flush_folder(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.parent_path();
  const int handle =
      open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return;
  fsync(handle);
  close(handle);
}

constexpr std::string_view kPartial = ".partial";

// The parts of a temporary file's name, as open_temporary() makes it.
struct Partial {
  std::string file;  // the file that it was to become
  pid_t owner = 0;
  bool ours = false;  // written on this host
};

std::optional<Partial> partial_of(const std::string& name) {
  if (!name.starts_with('.') || !name.ends_with(kPartial)) return std::nullopt;
  const std::string stem = name.substr(0, name.size() - kPartial.size());
  const std::size_t dot = stem.rfind('.'), dash = stem.rfind('-'), at = stem.rfind('@');
  if (dot == 0 || dot == std::string::npos || dash == std::string::npos || dash < dot)
    return std::nullopt;
  Partial partial{stem.substr(1, dot - 1), 0, false};
  const auto parsed = std::from_chars(stem.data() + dot + 1, stem.data() + dash, partial.owner);
  if (parsed.ec != std::errc() || parsed.ptr != stem.data() + dash || partial.owner <= 0)
    return std::nullopt;
  // Files of older versions do not name their host.
  partial.ours = at == std::string::npos || at < dash || stem.substr(at + 1) == host_mark();
  return partial;
}

// True if this process can still write. A zombie cannot: it has ended, but its parent has not read
// its status. The first process of a container may take seconds to do so, or never do it.
bool is_running(pid_t process) {
  if (kill(process, 0) != 0 && errno == ESRCH) return false;
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string stat;  // process (name) state …; empty without /proc
  std::getline(file, stat);
  const std::size_t name_end = stat.rfind(") ");
  return name_end == std::string::npos || stat[name_end + 2] != 'Z';
}

template <class Unwanted>
void remove_partials_that(const std::filesystem::path& folder, Unwanted unwanted) {
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    const auto partial = partial_of(it->path().filename().string());
    if (partial && unwanted(*partial)) unlink(it->path().c_str());
  }
}

}  // namespace

void remove_stale_partials(const std::filesystem::path& folder) {
  remove_partials_that(
      folder, [](const Partial& partial) { return partial.ours && !is_running(partial.owner); });
}

void remove_partials_of(const std::filesystem::path& folder,
                        const std::function<bool(const std::string& file)>& is_ours) {
  remove_partials_that(folder, [&](const Partial& partial) { return is_ours(partial.file); });
}

Result<void> check_replaceable(const std::filesystem::path& path) {
  const std::filesystem::path target = without_links(path), folder = target.parent_path();
  const char* refusal = look_at(target).refusal;
  if (refusal == nullptr && access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) != 0)
    refusal = errno == ENOENT ? "its folder is missing" : "cannot create a file in its folder";
  if (refusal == nullptr) return {};
  return fail(ErrorCode::kIo, fmt::format("{}: {}", path.string(), refusal));
}

FileReplacement::FileReplacement(std::filesystem::path path)
    : path_(std::move(path)), target_(without_links(path_)) {
  const Existing before = look_at(target_);
  if (before.refusal != nullptr) {
    failure_ = fmt::format("{}: {}", path_.string(), before.refusal);
    return;
  }
  file_ = open_temporary(target_, temporary_);
  if (file_ < 0) {
    fail_with(errno == ENOENT ? "its folder is missing" : "cannot create a file in its folder",
              errno);
    temporary_.clear();
  } else if (before.exists) {
    // The owner first, because a change of owner clears bits of the mode. Only root may change it.
    (void)!fchown(file_, before.status.stx_uid, before.status.stx_gid);
    (void)fchmod(file_, before.status.stx_mode & 07777U);
  }
}

FileReplacement::~FileReplacement() {
  if (file_ >= 0) close(file_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void FileReplacement::fail_with(const char* action, int error) {
  if (failure_.empty())
    failure_ = fmt::format("{}: {}: {}", path_.string(), action, std::strerror(error));
}

void FileReplacement::write_out(std::string_view bytes) {
  while (!bytes.empty() && failure_.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      fail_with("cannot write", errno);
    }
  }
}

void FileReplacement::write(std::string_view bytes) {
  if (buffer_.size() + bytes.size() > kBufferBytes) {
    write_out(buffer_);
    buffer_.clear();
  }
  if (bytes.size() > kBufferBytes) {
    write_out(bytes);
  } else {
    buffer_ += bytes;
  }
}

Result<void> FileReplacement::flush() {
  write_out(buffer_);
  buffer_.clear();
  if (failure_.empty() && file_ >= 0 && fsync(file_) != 0) fail_with("cannot write", errno);
  if (file_ >= 0 && close(std::exchange(file_, -1)) != 0) fail_with("cannot write", errno);
  if (!failure_.empty()) return fail(ErrorCode::kIo, failure_);
  return {};
}

Result<void> FileReplacement::commit() {
  if (auto ok = flush(); !ok) return ok;
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) {
    fail_with("cannot write", errno);
    return fail(ErrorCode::kIo, failure_);
  }
  temporary_.clear();
  flush_folder(target_);
  return {};
}

Result<void> replace_file(const std::filesystem::path& path, std::string_view text) {
  FileReplacement file(path);
  file.write(text);
  return file.commit();
}

Result<void> replace_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  return replace_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace psygen::core
