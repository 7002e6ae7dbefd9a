// Replaces a file's content as a whole: after a crash or a full disk the old content or the new
// content is there, never a mix. POSIX. One thread per file; different files from any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::core {

// A file that is written piece by piece. Until commit() it lies beside `path` under a temporary
// name; what was not committed is removed.
class FileReplacement {
 public:
  // Refuses a path that exists and is not a regular file. Always gives an object: the first error
  // is kept and comes out of commit().
  explicit FileReplacement(std::filesystem::path path);
  ~FileReplacement();
  FileReplacement(const FileReplacement&) = delete;
  FileReplacement& operator=(const FileReplacement&) = delete;

  void write(std::string_view bytes);  // buffered
  // Everything has reached the disk, still under the temporary name. Call once, or leave it to
  // commit(). Fails with kIo: the path, what could not be done and the system's reason.
  Result<void> flush();
  // Flushes and renames, once. Fails as flush(); then `path` holds what it held before.
  Result<void> commit();

 private:
  void write_out(std::string_view bytes);
  void fail_with(const char* action, int error);

  std::filesystem::path path_;
  std::filesystem::path temporary_;  // empty: there is none
  int file_ = -1;                    // open until it is flushed
  std::string buffer_;               // written next
  std::string failure_;              // the first; empty: none
};

// The whole content at once.
Result<void> replace_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
Result<void> replace_file(const std::filesystem::path& path, std::string_view text);

// Removes the temporary files that processes which no longer run (killed, no power) left in the
// folder. Not those of its sub-folders.
void remove_stale_partials(const std::filesystem::path& folder);

}  // namespace psygen::core
