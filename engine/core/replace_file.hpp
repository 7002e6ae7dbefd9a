// Replaces a file's content as a whole: after a crash or a full disk the file holds the old content
// or the new content, never a mix. Not a lock: the last of several writers wins. POSIX. One thread
// per file; different files from any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::core {

// A file that is written piece by piece. Until commit() the content is in a temporary file next to
// `path`; it is removed when commit() does not happen.
class FileReplacement {
 public:
  // Refuses a path that exists and is not a regular file. Always constructs an object: the first
  // error is kept and is returned by commit().
  explicit FileReplacement(std::filesystem::path path);
  // Removes the temporary file unless it was committed.
  ~FileReplacement();
  FileReplacement(const FileReplacement&) = delete;
  FileReplacement& operator=(const FileReplacement&) = delete;

  // Appends bytes, buffered. After an error it does nothing.
  void write(std::string_view bytes);
  // Writes everything to the disk, still under the temporary name. Call it once, or leave it to
  // commit(). Fails with kIo: the path, what failed and the system's reason.
  Result<void> flush();
  // Flushes and renames, once. Fails like flush(); `path` then holds what it held before.
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

// Replaces the whole content at once. Fails like FileReplacement::commit().
Result<void> replace_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
Result<void> replace_file(const std::filesystem::path& path, std::string_view text);

// Removes temporary files in this folder whose processes no longer run (killed, power lost),
// whether or not their parents have waited for them. Those of other hosts, which may share the
// folder, stay. Does not look into sub-folders.
void remove_stale_partials(const std::filesystem::path& folder);
// Removes the temporary files of the files of these names, whoever made them: for one who alone
// writes those files.
void remove_partials_of(const std::filesystem::path& folder,
                        const std::function<bool(const std::string& file)>& is_ours);

}  // namespace psygen::core
