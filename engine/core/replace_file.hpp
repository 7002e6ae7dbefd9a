// Replaces a file's content as a whole: after a crash or a full disk the file holds the old content
// or the new content, never a mix. Follows links, and keeps the permissions of an existing file.
// Not a lock: the last of several writers wins. POSIX. One thread per file; different files from
// any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::core {

// A file that is written piece by piece. Until commit(), its content is in a temporary file next to
// `path`, which the destructor removes.
class FileReplacement {
 public:
  // Rejects a path that exists and is not a regular file, is read-only, or is a mount point. Always
  // constructs an object: it keeps the first error, and commit() returns it.
  explicit FileReplacement(std::filesystem::path path);
  // Removes the temporary file unless it was committed.
  ~FileReplacement();
  FileReplacement(const FileReplacement&) = delete;
  FileReplacement& operator=(const FileReplacement&) = delete;

  // Appends bytes, buffered. Does nothing after an error.
  void write(std::string_view bytes);
  // Writes everything to the disk, still under the temporary name. Call it once, or leave it to
  // commit(). Fails with kIo; the message has the path, the operation and the system's reason.
  Result<void> flush();
  // Flushes and renames, once. Fails like flush(); `path` then keeps its old content.
  Result<void> commit();

 private:
  void write_out(std::string_view bytes);
  void fail_with(const char* action, int error);

  std::filesystem::path path_;       // as given, for messages
  std::filesystem::path target_;     // without links
  std::filesystem::path temporary_;  // next to the target; empty: none
  int file_ = -1;                    // open until the flush
  std::string buffer_;               // bytes not yet written
  std::string failure_;              // the first error; empty: none
};

// Fails with kIo, and the path, for a file that cannot be replaced: one that is not regular, is
// read-only, is a mount point, or lies in a folder that is missing or cannot be written. For a
// check before long work.
Result<void> check_replaceable(const std::filesystem::path& path);
// Replaces the whole content. Fails like FileReplacement::commit().
Result<void> replace_file(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
Result<void> replace_file(const std::filesystem::path& path, std::string_view text);

// Removes temporary files in this folder whose processes have ended (killed, power lost), also if
// their parents have not waited for them. Keeps files of other hosts, which may share the folder.
// Does not visit sub-folders.
void remove_stale_partials(const std::filesystem::path& folder);
// Removes all temporary files of the files that `is_ours` selects, whichever process made them.
// Only for the one program that writes those files.
void remove_partials_of(const std::filesystem::path& folder,
                        const std::function<bool(const std::string& file)>& is_ours);

}  // namespace psygen::core
