#include "editor/shell/panel.hpp"

#include <QAction>
#include <QDockWidget>
#include <QMainWindow>
#include <map>

#include "engine/core/assert.hpp"

namespace psygen::editor {
namespace {

constexpr int kRightPx = 240, kBottomPx = 150;  // of the first layout

Qt::DockWidgetArea area_of(PanelPlace place) {
  if (place == PanelPlace::kLeft) return Qt::LeftDockWidgetArea;
  return place == PanelPlace::kBottom ? Qt::BottomDockWidgetArea : Qt::RightDockWidgetArea;
}

void show_dock(QDockWidget& dock) {
  dock.show();
  dock.raise();
}

// Qt's command of the dock, which would close a panel behind another tab. Here it brings the panel
// to the front, and is checked while the panel is there.
QAction* command_of(const Panel& panel, QDockWidget& dock) {
  QAction* command = dock.toggleViewAction();
  command->setShortcut(panel.shortcut);
  QObject::disconnect(command, &QAction::triggered, &dock, nullptr);
  QObject::connect(&dock, &QDockWidget::visibilityChanged, command, &QAction::setChecked);
  QObject::connect(command, &QAction::triggered, &dock, [&dock](bool on) {
    if (!on) return void(dock.close());
    show_dock(dock);
    dock.widget()->setFocus();
  });
  return command;
}

}  // namespace

std::vector<QAction*> add_panels(QMainWindow& window, const std::vector<Panel>& panels) {
  std::map<PanelPlace, QDockWidget*> front;
  std::vector<QAction*> commands;
  for (const Panel& panel : panels) {
    auto* dock = new QDockWidget(panel.title, &window);
    dock->setObjectName(panel.name);
    dock->setWidget(panel.make());
    window.addDockWidget(area_of(panel.place), dock);
    if (!panel.is_open) dock->hide();
    const auto [first, is_first] = front.try_emplace(panel.place, dock);
    if (!is_first) window.tabifyDockWidget(first->second, dock);
    commands.push_back(command_of(panel, *dock));
  }
  for (const auto& [place, dock] : front)
    dock->raise();
  window.resizeDocks({front[PanelPlace::kLeft], front[PanelPlace::kTopRight]},
                     {kLeftPanelsPx, kRightPx}, Qt::Horizontal);
  window.resizeDocks({front[PanelPlace::kBottom]}, {kBottomPx}, Qt::Vertical);
  return commands;
}

QDockWidget& dock_of(QWidget& content) {
  QDockWidget* dock = nullptr;
  for (QWidget* at = &content; at != nullptr && dock == nullptr; at = at->parentWidget())
    dock = qobject_cast<QDockWidget*>(at);
  PSYGEN_CHECK(dock != nullptr, "the widget is in no panel");
  return *dock;
}

void show_panel(QWidget& content) {
  show_dock(dock_of(content));
}

}  // namespace psygen::editor
