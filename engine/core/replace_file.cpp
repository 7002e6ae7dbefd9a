#include "engine/core/replace_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <string>
#include <utility>

namespace psygen::core {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{64} << 10;

// Opens a new file next to `path` and stores its name; -1 with errno when that fails.
int open_temporary(const std::filesystem::path& path, std::filesystem::path& temporary) {
  int file = -1;
  for (int attempt = 0; attempt < 100 && file < 0; ++attempt) {
    temporary = path.parent_path() /
                fmt::format(".{}.{}-{}.partial", path.filename().string(), getpid(), attempt);
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

// The process that made a temporary file of open_temporary(); 0 for any other file.
pid_t owner_of_partial(const std::string& name) {
  constexpr std::string_view kEnding = ".partial";
  if (!name.starts_with('.') || !name.ends_with(kEnding)) return 0;
  const std::string_view stem = std::string_view(name).substr(0, name.size() - kEnding.size());
  const std::size_t dot = stem.rfind('.');
  const std::size_t dash = stem.rfind('-');
  if (dot == std::string_view::npos || dash == std::string_view::npos || dash < dot) return 0;
  pid_t owner = 0;
  const auto parsed = std::from_chars(stem.data() + dot + 1, stem.data() + dash, owner);
  return parsed.ec == std::errc() && parsed.ptr == stem.data() + dash ? owner : 0;
}

}  // namespace

void remove_stale_partials(const std::filesystem::path& folder) {
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    const pid_t owner = owner_of_partial(it->path().filename().string());
    if (owner > 0 && kill(owner, 0) != 0 && errno == ESRCH) unlink(it->path().c_str());
  }
}

FileReplacement::FileReplacement(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  const auto status = std::filesystem::status(path_, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    failure_ = fmt::format("{}: is not a regular file; it is left alone", path_.string());
    return;
  }
  file_ = open_temporary(path_, temporary_);
  if (file_ >= 0) return;
  fail_with(errno == ENOENT ? "its folder is missing" : "cannot create a file in its folder",
            errno);
  temporary_.clear();
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
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    fail_with("cannot write", errno);
    return fail(ErrorCode::kIo, failure_);
  }
  temporary_.clear();
  flush_folder(path_);
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
