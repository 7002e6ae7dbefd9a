// Every control of the window can be reached by keyboard and has a name that a screen reader says.
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

// Parts of Qt's own widgets, which they name themselves. Buttons of toolbars are commands, which
// menus have too.
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

// All objects that an assistive program finds below one.
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

TEST_F(EditorWindow, EveryControlHasANameAndTakesTheKeyboard) {
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
       {"Draw roads", "Place models", "Paint masks", "Leave the tool", "Model alone"}) {
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

// A command that only a button of a toolbar has could not be reached.
TEST_F(EditorWindow, EveryButtonOfAToolbarIsACommandOfAMenuToo) {
  std::set<const QAction*> in_menus;
  for (const QMenu* menu : window_->findChildren<QMenu*>())
    for (const QAction* action : menu->actions())
      in_menus.insert(action);
  for (const QToolBar* bar : window_->findChildren<QToolBar*>()) {
    if (bar->objectName() == "model") continue;  // its button is "Model alone" once more
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

TEST_F(EditorWindow, PanelsCanBeHiddenAndTheLayoutComesBack) {
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

}  // namespace
}  // namespace psygen::editor
