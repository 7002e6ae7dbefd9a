// Commands for the world file: open, save, compare with the disk, recover after a crash. Asks
// before unsaved changes are lost. Main thread.
#pragma once

#include <QObject>
#include <filesystem>

#include "editor/shell/main_window.hpp"

class QMenu;

namespace psygen::editor {

// Actions and dialogs belong to the window of the context.
class FileCommands final : public QObject {
  Q_OBJECT

 public:
  // The objects of the context outlive this one.
  explicit FileCommands(const EditorContext& context);

  // Opens a world file and offers the recovery of unsaved changes. Fails like Document::open(); the
  // error also becomes a message.
  core::Result<void> open(const std::filesystem::path& file);
  // Offers to save unsaved changes. Returns false if the user cancels.
  bool may_discard();
  // Adds the commands from "New world" to "Revert to the saved file".
  void add_to_menu(QMenu& menu);

 private:
  void choose_file();
  bool save();
  bool save_as();
  void show_diff();
  void fill_recent_files();
  void on_file_changed();
  void on_disk_changed(DiskState state, bool conflict);
  void offer_recovery();

  const EditorContext context_;
  QMenu* recent_menu_;
};

}  // namespace psygen::editor
