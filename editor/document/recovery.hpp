// Unsaved texts that survive a crash: one file per session in the editor's state folder, with
// painted pictures beside it, and locks
// that tell which sessions still run. Not the undo history, and not a backup of saved files. Main
// thread; several processes may use the same folder.
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
  std::filesystem::path world_file;       // empty: it had no name yet
  std::string text;                       // with the changes
  std::string saved_text;                 // what the file held
  int undo_index = 0;                     // steps that were done
  QDateTime time;                         // when it was written
  std::filesystem::path file;             // the recovery file
  handmade::NamedPictures pictures = {};  // painted and not written
};

// $XDG_STATE_HOME/psygen-editor, else ~/.local/state/psygen-editor.
std::filesystem::path default_state_folder();

// The key of a world file in names of files of the state folder. The same for all paths of a file.
QString file_key(const std::filesystem::path& world_file);

// The recovery file and the locks of one open document.
class RecoverySession {
 public:
  // Takes the locks. `world_file` is empty for a world without a name. Fails with kInvalidArgument
  // if another editor has the file open, naming its process; not with `share`. Where the folder
  // cannot be written there are no locks and write() fails.
  static core::Result<std::unique_ptr<RecoverySession>> start(
      const std::filesystem::path& state_folder, const std::filesystem::path& world_file,
      bool share = false);
  // Removes the recovery file and releases the locks: a clean end.
  ~RecoverySession();
  RecoverySession(const RecoverySession&) = delete;
  RecoverySession& operator=(const RecoverySession&) = delete;

  // Replaces the recovery file as a whole. Fails with kIo.
  core::Result<void> write(const Recovery& recovery) const;
  // Removes it: nothing is unsaved.
  void clear() const;
  // Where it is, or will be.
  const std::filesystem::path& file() const { return file_; }

 private:
  RecoverySession() = default;
  std::filesystem::path file_;
  std::unique_ptr<QLockFile> running_;   // while this session lives
  std::unique_ptr<QLockFile> document_;  // while it has the world file open
};

// What sessions left that ended without closing, newest first. Damaged files are left out.
std::vector<Recovery> left_recoveries(const std::filesystem::path& state_folder);
// Removes one of them.
void discard_recovery(const Recovery& recovery);

}  // namespace psygen::editor
