#include "engine/image/replace_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace psygen::image {
namespace {

using core::ErrorCode;

tl::unexpected<core::Error> io_error(const std::filesystem::path& path, const char* action,
                                     int error) {
  return core::fail(ErrorCode::kIo,
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

}  // namespace

core::Result<void> replace_file(const std::filesystem::path& path,
                                std::span<const std::uint8_t> bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return core::fail(ErrorCode::kIo,
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

}  // namespace psygen::image
