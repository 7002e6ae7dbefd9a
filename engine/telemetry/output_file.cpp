#include "engine/telemetry/output_file.hpp"

#include <fmt/format.h>
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

}  // namespace psygen::telemetry
