// Unsaved texts that survive a crash: one file per session in the editor's state folder, its
// painted images, and locks that show which sessions still run. It contains no undo history and is
// no backup of saved files. Main thread; several processes may use the same folder.
#pragma once

#include <QDateTime>
#include <QLockFile>
#include <QString>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/handmade/files.hpp"

namespace psygen::editor {

// An unsaved text.
struct Recovery {
  std::filesystem::path world_file;       // canonical; empty: the world was never saved
  std::string text;                       // with the unsaved changes
  std::string saved_text;                 // contents of the world file
  QDateTime time;                         // of writing the recovery file
  std::filesystem::path file;             // the recovery file
  handmade::NamedPictures pictures = {};  // painted and unsaved
};

// $XDG_STATE_HOME/psygen-editor, else ~/.local/state/psygen-editor.
std::filesystem::path default_state_folder();

// The key of a world file in file names of the state folder. All paths of one file have the same
// key.
QString file_key(const std::filesystem::path& world_file);
// True if both paths name one file; false if one is empty.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

// The recovery file and the locks of one open document.
class RecoverySession {
 public:
  // Acquires the locks. `world_file` is empty for a world without a file. Fails with
  // kInvalidArgument, naming the process, if another editor has the file open; not with `share`. If
  // the folder is not writable, there are no locks and write() fails.
  static core::Result<std::unique_ptr<RecoverySession>> start(
      const std::filesystem::path& state_folder, const std::filesystem::path& world_file,
      bool share = false);
  // Removes the recovery file and releases the locks: a clean end.
  ~RecoverySession();
  RecoverySession(const RecoverySession&) = delete;
  RecoverySession& operator=(const RecoverySession&) = delete;

  // Replaces the recovery file as a whole. Fails with kIo.
  core::Result<void> write(const Recovery& recovery) const;
  // Removes the recovery file, because nothing is unsaved.
  void clear() const;
  // Path of the recovery file, which need not exist yet.
  const std::filesystem::path& file() const { return file_; }

 private:
  RecoverySession() = default;
  std::filesystem::path file_;
  std::unique_ptr<QLockFile> running_;   // while this session lives
  std::unique_ptr<QLockFile> document_;  // while it has the world file open
};

// Recoveries of sessions that ended without closing, newest first. Damaged files are skipped.
std::vector<Recovery> left_recoveries(const std::filesystem::path& state_folder);
// Removes the files of a recovery.
void discard_recovery(const Recovery& recovery);

}  // namespace psygen::editor
