// Notices that a file has changed on the disk, also when it is replaced, removed or made anew. It
// reads nothing: whoever hears the signal looks. Main thread.
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
  // Watches this file from now on; empty: none.
  void watch(const std::filesystem::path& file);

 Q_SIGNALS:
  // Once after a burst of changes; some of them may have left the file as it was.
  void maybe_changed();

 private:
  void look();
  QFileSystemWatcher watcher_;
  QTimer settle_;  // other programs write a file in several steps
  QString file_, folder_;
};

}  // namespace psygen::editor
