// The output folder of a run. Files in it are written completely or not at all
// (core/replace_file.hpp). Writes no files. One thread per folder.
#pragma once

#include <filesystem>
#include <span>
#include <utility>

#include "engine/core/error.hpp"

namespace psygen::telemetry {

// Creates the folder and its parents. Accepts an existing folder, and removes the partial files of
// killed processes from it. Fails with kIo and the path if the folder cannot be created, is not a
// folder, or is not writable.
core::Result<void> create_output_folder(const std::filesystem::path& folder);

// Checks before a long job that its result can be written: creates the folder, and fails like
// core::check_replaceable().
core::Result<void> check_output_file(const std::filesystem::path& file);
// Fails with kInvalidArgument if the output file is one of `inputs`, also under another name. Names
// that do not exist, and empty ones, are no input.
core::Result<void> check_no_input(const std::filesystem::path& file,
                                  std::span<const std::filesystem::path> inputs);

// The only process that writes into an output folder, until the object is destroyed.
class OutputFolder {
 public:
  // Creates the folder. Fails like create_output_folder(), or with kIo if another process writes
  // into it. File systems without locks accept every process.
  static core::Result<OutputFolder> open(const std::filesystem::path& folder);
  OutputFolder(OutputFolder&& other) noexcept : lock_(std::exchange(other.lock_, -1)) {}
  OutputFolder& operator=(OutputFolder&&) = delete;
  ~OutputFolder();

 private:
  explicit OutputFolder(int lock) : lock_(lock) {}
  int lock_ = -1;  // descriptor of the folder
};

}  // namespace psygen::telemetry
