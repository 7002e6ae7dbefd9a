// Every control of the window is reachable by keyboard and has a name for screen readers.
#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSpinBox>
#include <QAccessible>
#include <QApplication>
#include <QComboBox>
#include <QDockWidget>
#include <QLineEdit>
#include <QMenu>
#include <QMenuBar>
#include <QSlider>
#include <QToolBar>
#include <QToolButton>
#include <QWidgetAction>
#include <set>

#include "tests/editor/window/window_fixture.hpp"

namespace psygen::editor {
namespace {

// True for parts of Qt's own widgets, which Qt names, and for toolbar buttons, which are also in
// menus.
bool is_inner(const QWidget& widget) {
  return widget.objectName().startsWith("qt_") || widget.inherits("QTableCornerButton") ||
         widget.inherits("QHeaderView") || widget.inherits("QComboBoxListView") ||
         qobject_cast<QAbstractSpinBox*>(widget.parent()) ||
         qobject_cast<QComboBox*>(widget.parent()) || qobject_cast<QLineEdit*>(widget.parent()) ||
         widget.parent()->inherits("QTabBar") || widget.parent()->inherits("QMenuBar") ||
         (widget.parent()->inherits("QToolBar") && widget.inherits("QToolButton"));
}

bool is_control(const QWidget& widget) {
  return qobject_cast<const QAbstractButton*>(&widget) || qobject_cast<const QSlider*>(&widget) ||
         qobject_cast<const QAbstractSpinBox*>(&widget) ||
         qobject_cast<const QComboBox*>(&widget) || qobject_cast<const QLineEdit*>(&widget) ||
         qobject_cast<const QAbstractItemView*>(&widget);
}

std::string place_of(const QWidget& widget) {
  return std::string(widget.metaObject()->className()) + " in " +
         widget.parent()->metaObject()->className() + " " +
         widget.parent()->objectName().toStdString();
}

// Collects all accessible objects below one.
void collect(QAccessibleInterface* at, std::set<const QObject*>& found) {
  if (at == nullptr) return;
  if (at->object() != nullptr) found.insert(at->object());
  for (int i = 0; i < at->childCount(); ++i)
    collect(at->child(i), found);
}

QString name_of(const QWidget& widget) {
  if (!widget.accessibleName().isEmpty()) return widget.accessibleName();
  const auto* button = qobject_cast<const QAbstractButton*>(&widget);
  return button != nullptr ? button->text() : QString();
}

TEST_F(EditorWindow, EveryControlHasANameAndTakesTheFocus) {
  for (const world::WorldSection& section : document().sections()) {
    properties().go_to(section.path);
    for (QWidget* widget : window_->findChildren<QWidget*>()) {
      if (!is_control(*widget) || is_inner(*widget)) continue;
      const std::string where = section.path.text() + ", " + place_of(*widget);
      EXPECT_FALSE(name_of(*widget).isEmpty()) << where;
      EXPECT_NE(widget->focusPolicy(), Qt::NoFocus) << where;
    }
  }
}

// With the controls of each tool and of a model alone.
TEST_F(EditorWindow, EveryControlIsFoundThroughTheAccessibilityTree) {
  for (QDockWidget* dock : window_->findChildren<QDockWidget*>())
    dock->show();
  for (const char* command_name :
       {"Draw roads", "Place models", "Paint masks", "Exit tool", "Model alone"}) {
    properties().go_to({"scatter", 0});
    command(command_name);
    std::set<const QObject*> found;
    for (QWidget* top : QApplication::topLevelWidgets())
      collect(QAccessible::queryAccessibleInterface(top), found);
    for (QWidget* widget : window_->findChildren<QWidget*>()) {
      if (!is_control(*widget) || is_inner(*widget) || widget->isHidden()) continue;
      const std::string where = std::string(command_name) + ", " + place_of(*widget);
      EXPECT_TRUE(found.contains(widget)) << where;
      QAccessibleInterface* seen = QAccessible::queryAccessibleInterface(widget);
      ASSERT_NE(seen, nullptr) << where;
      EXPECT_FALSE(seen->text(QAccessible::Name).isEmpty()) << where;
      EXPECT_NE(seen->role(), QAccessible::NoRole) << where;
      EXPECT_TRUE(seen->state().focusable || !widget->isEnabled()) << where;
    }
  }
  command("Model alone");
}

// A command with only a toolbar button is not reachable by keyboard.
TEST_F(EditorWindow, EveryButtonOfAToolbarIsACommandOfAMenuToo) {
  std::set<const QAction*> in_menus;
  for (const QMenu* menu : window_->findChildren<QMenu*>())
    for (const QAction* action : menu->actions())
      in_menus.insert(action);
  for (const QToolBar* bar : window_->findChildren<QToolBar*>()) {
    if (bar->objectName() == "model") continue;  // its button repeats "Model alone"
    for (const QAction* action : bar->actions()) {
      const bool is_button =
          !action->isSeparator() &&
          qobject_cast<QToolButton*>(bar->widgetForAction(const_cast<QAction*>(action)));
      if (is_button && qobject_cast<const QWidgetAction*>(action) == nullptr) {
        EXPECT_TRUE(in_menus.contains(action))
            << bar->objectName().toStdString() << ": " << action->text().toStdString();
      }
    }
  }
}

TEST_F(EditorWindow, NoShortcutIsGivenTwice) {
  std::set<QString> seen;
  for (const QAction* action : window_->findChildren<QAction*>()) {
    for (const QKeySequence& keys : action->shortcuts())
      EXPECT_TRUE(seen.insert(keys.toString()).second) << keys.toString().toStdString();
  }
  EXPECT_GE(seen.size(), 15u);
}

TEST_F(EditorWindow, PanelsCanBeClosedAndTheLayoutCanBeRestored) {
  const auto docks = window_->findChildren<QDockWidget*>();
  ASSERT_GE(docks.size(), 6);
  std::set<const QDockWidget*> shown;
  for (QDockWidget* dock : docks) {
    if (!dock->isHidden()) shown.insert(dock);
    dock->hide();
  }
  EXPECT_GE(shown.size(), 6u);
  for (QAction* action : window_->findChildren<QAction*>()) {
    if (action->text() == "&Reset the layout") action->trigger();
  }
  for (const QDockWidget* dock : docks)
    EXPECT_EQ(!dock->isHidden(), shown.contains(dock)) << dock->objectName().toStdString();
}

TEST_F(EditorWindow, TheCommandOfAPanelBringsItToTheFrontOrClosesIt) {
  auto* properties = window_->findChild<QDockWidget*>("properties");
  auto* library = window_->findChild<QDockWidget*>("library");
  EXPECT_TRUE(library->visibleRegion().isEmpty()) << "behind the properties";
  command("Library");
  EXPECT_TRUE(QTest::qWaitFor([&] { return !library->visibleRegion().isEmpty(); }, kMaxMs));
  EXPECT_TRUE(properties->visibleRegion().isEmpty());
  command("Library");
  EXPECT_TRUE(library->isHidden());
  command("Properties");
  command("Library");
  EXPECT_FALSE(library->isHidden());
}

}  // namespace
}  // namespace psygen::editor
