// Text output that cannot fail silently: the first error (unwritable folder, full disk) is kept and
// comes out of close(). Writes in place, without a temporary file. One thread.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::telemetry {

// Creates the folder and those above it; one that exists already is fine. Fails with kIo and the
// path when it cannot be created, is no folder, or nothing can be written into it.
core::Result<void> create_output_folder(const std::filesystem::path& folder);

class OutputFile {
 public:
  // Opens `path`, replacing what it holds. Always gives an object; errors come out of close().
  explicit OutputFile(const std::filesystem::path& path);

  void write(std::string_view text);
  // Everything has reached the operating system, or kIo with the path and the first error.
  core::Result<void> close();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
  int first_error_ = 0;  // errno
};

// The whole file at once.
core::Result<void> write_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace psygen::telemetry
