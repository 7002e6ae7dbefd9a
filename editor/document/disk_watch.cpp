#include "editor/document/disk_watch.hpp"

namespace psygen::editor {
namespace {
constexpr int kSettleMs = 100;
}  // namespace

DiskWatch::DiskWatch(QObject* parent) : QObject(parent) {
  settle_.setSingleShot(true);
  settle_.setInterval(kSettleMs);
  connect(&watcher_, &QFileSystemWatcher::fileChanged, &settle_, qOverload<>(&QTimer::start));
  connect(&watcher_, &QFileSystemWatcher::directoryChanged, &settle_, qOverload<>(&QTimer::start));
  connect(&settle_, &QTimer::timeout, this, &DiskWatch::look);
}

void DiskWatch::watch(const std::filesystem::path& file) {
  settle_.stop();
  if (const QStringList all = watcher_.files() + watcher_.directories(); !all.isEmpty())
    watcher_.removePaths(all);
  file_ = QString::fromStdString(file.string());
  folder_ = QString::fromStdString(file.parent_path().string());
  if (file_.isEmpty()) return;
  watcher_.addPath(folder_.isEmpty() ? QStringLiteral(".") : folder_);
  watcher_.addPath(file_);
}

void DiskWatch::look() {
  if (file_.isEmpty()) return;
  if (!watcher_.files().contains(file_)) watcher_.addPath(file_);  // it was replaced
  Q_EMIT maybe_changed();
}

}  // namespace psygen::editor
