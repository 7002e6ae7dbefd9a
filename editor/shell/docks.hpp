// Docks of the window, and their sizes at first. Main thread.
#pragma once

#include <QDockWidget>
#include <QMainWindow>

namespace psygen::editor {

inline constexpr int kPropertiesPx = 380, kSelectionPx = 240, kAttachedPx = 330,
                     kStatisticsPx = 150;

// A dock around `content`. `name` is that of its place in kept layouts.
inline QDockWidget* add_dock(QMainWindow& window, const QString& name, const QString& title,
                             QWidget* content, Qt::DockWidgetArea area) {
  auto* dock = new QDockWidget(title, &window);
  dock->setObjectName(name);
  dock->setWidget(content);
  window.addDockWidget(area, dock);
  return dock;
}

}  // namespace psygen::editor
