#include "engine/telemetry/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "engine/core/replace_file.hpp"

namespace psygen::telemetry {

core::Result<void> create_output_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && access(folder.c_str(), W_OK | X_OK) != 0) {
    error = std::error_code(errno, std::generic_category());
  }
  if (error) {
    return core::fail(core::ErrorCode::kIo, fmt::format("{}: cannot use this output folder: {}",
                                                        folder.string(), error.message()));
  }
  core::remove_stale_partials(folder);
  return {};
}

core::Result<void> check_output_file(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  if (auto ok = create_output_folder(folder.empty() ? "." : folder); !ok) return ok;
  return core::check_replaceable(file);
}

core::Result<void> check_no_input(const std::filesystem::path& file,
                                  std::span<const std::filesystem::path> inputs) {
  for (const std::filesystem::path& input : inputs) {
    std::error_code missing;
    if (std::filesystem::equivalent(file, input, missing))
      return core::invalid_argument(file.string() + ": is read here, and is not replaced");
  }
  return {};
}

core::Result<OutputFolder> OutputFolder::open(const std::filesystem::path& folder) {
  if (auto ok = create_output_folder(folder); !ok) return tl::unexpected(ok.error());
  OutputFolder opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.lock_ < 0 || flock(opened.lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK)
    return opened;
  return core::fail(core::ErrorCode::kIo,
                    fmt::format("{}: another flight writes into this folder", folder.string()));
}

OutputFolder::~OutputFolder() {
  if (lock_ >= 0) close(lock_);
}

}  // namespace psygen::telemetry
