// Reports changes of a file on the disk, also its replacement, removal and creation. It reads no
// file: receivers of the signal check the contents. Main thread.
#pragma once

#include <QFileSystemWatcher>
#include <QObject>
#include <QTimer>
#include <filesystem>

namespace psygen::editor {

// Watches one file.
class DiskWatch : public QObject {
  Q_OBJECT

 public:
  explicit DiskWatch(QObject* parent = nullptr);
  // Watches this file instead of the previous one; empty: none.
  void watch(const std::filesystem::path& file);

 Q_SIGNALS:
  // Emitted once after a burst of changes. The contents may be the same as before.
  void maybe_changed();

 private:
  void look();
  QFileSystemWatcher watcher_;
  QTimer settle_;  // other programs write a file in several steps
  QString file_, folder_;
};

}  // namespace psygen::editor
