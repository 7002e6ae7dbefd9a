// Panels of the window. A panel is registered by one entry: a name, a place, a shortcut and a
// function that makes its widget. The window makes a dock of each entry. Main thread.
#pragma once

#include <QKeySequence>
#include <QString>
#include <functional>
#include <vector>

class QAction;
class QDockWidget;
class QMainWindow;
class QWidget;

namespace psygen::editor {

// Place of a panel in the first layout. Panels of one place are tabs; the first one is in front.
enum class PanelPlace { kLeft, kTopRight, kBottomRight, kBottom };

struct Panel {
  QString name;   // object name of the dock: saved layouts contain it, so it must never change
  QString title;  // of the dock and of its command
  PanelPlace place = PanelPlace::kLeft;
  QKeySequence shortcut;  // brings the panel to the front, or closes it if it is there
  bool is_open = true;    // in the first layout
  std::function<QWidget*()> make;
};

inline constexpr int kLeftPanelsPx = 380;  // width of the panels on the left, at first

// Makes a dock of each panel, in their order. Returns the commands that show and close the panels,
// in the same order.
std::vector<QAction*> add_panels(QMainWindow& window, const std::vector<Panel>& panels);

// Returns the dock that contains a panel's widget. The widget must be in a dock.
QDockWidget& dock_of(QWidget& content);

// Opens the dock that contains the widget, in front of the other tabs.
void show_panel(QWidget& content);

}  // namespace psygen::editor
