#include "engine/core/replace_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <string>

namespace psygen::core {
namespace {

tl::unexpected<Error> io_error(const std::filesystem::path& path, const char* action, int error) {
  return fail(ErrorCode::kIo,
              fmt::format("{}: {}: {}", path.string(), action, std::strerror(error)));
}

// Opens a new file beside `path` and stores its name; -1 with errno when that is not possible.
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

// 0 or the errno of what failed.
int write_all(int file, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return fsync(file) == 0 ? 0 : errno;
}

void flush_folder(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.parent_path();
  const int handle =
      open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle < 0) return;
  fsync(handle);
  close(handle);
}

// The process that a temporary file of open_temporary() belongs to; 0 for any other file.
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

Result<void> replace_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return fail(ErrorCode::kIo,
                fmt::format("{}: is not a regular file; it is left alone", path.string()));
  }
  std::filesystem::path temporary;
  const int file = open_temporary(path, temporary);
  if (file < 0) return io_error(path, "cannot create a file in its folder", errno);
  int failure = write_all(file, bytes);
  if (close(file) != 0 && failure == 0) failure = errno;
  if (failure == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) failure = errno;
  if (failure != 0) {
    unlink(temporary.c_str());
    return io_error(path, "cannot write", failure);
  }
  flush_folder(path);
  return {};
}

}  // namespace psygen::core
