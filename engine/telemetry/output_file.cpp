#include "engine/telemetry/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace psygen::telemetry {

core::Result<void> create_output_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && access(folder.c_str(), W_OK | X_OK) != 0) {
    error = std::error_code(errno, std::generic_category());
  }
  if (error) {
    return core::fail(core::ErrorCode::kIo,
                      fmt::format("{}: cannot be used as the output folder: {}", folder.string(),
                                  error.message()));
  }
  return {};
}

// A pipe that nobody reads is an error rather than a wait without an end.
OutputFile::OutputFile(const std::filesystem::path& path) : path_(path) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_CLOEXEC, 0666);
  if (file >= 0) file_.reset(fdopen(file, "wb"));
  if (!file_) first_error_ = errno;
}

void OutputFile::write(std::string_view text) {
  if (first_error_ != 0) return;
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) first_error_ = errno;
}

core::Result<void> OutputFile::close() {
  if (file_ && std::fclose(file_.release()) != 0 && first_error_ == 0) first_error_ = errno;
  if (first_error_ == 0) return {};
  return core::fail(core::ErrorCode::kIo, fmt::format("{}: cannot be written: {}", path_.string(),
                                                      std::strerror(first_error_)));
}

core::Result<void> write_text_file(const std::filesystem::path& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  return file.close();
}

}  // namespace psygen::telemetry
