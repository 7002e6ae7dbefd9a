// Every control of the window can be reached by keyboard and has a name that a screen reader says.
#include <QAbstractButton>
#include <QAbstractSpinBox>
#include <QComboBox>
#include <QDockWidget>
#include <QLineEdit>
#include <QMenu>
#include <QMenuBar>
#include <QSlider>
#include <set>

#include "tests/editor/window/window_fixture.hpp"

namespace psygen::editor {
namespace {

// Parts of Qt's own widgets, which they name themselves.
bool is_inner(const QWidget& widget) {
  return widget.objectName().startsWith("qt_") || widget.inherits("QTableCornerButton") ||
         qobject_cast<QAbstractSpinBox*>(widget.parent()) ||
         qobject_cast<QComboBox*>(widget.parent()) || qobject_cast<QLineEdit*>(widget.parent()) ||
         widget.parent()->inherits("QTabBar") || widget.parent()->inherits("QMenuBar") ||
         widget.parent()->inherits("QToolBar");
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
      const bool control = qobject_cast<QAbstractButton*>(widget) ||
                           qobject_cast<QSlider*>(widget) ||
                           qobject_cast<QAbstractSpinBox*>(widget) ||
                           qobject_cast<QComboBox*>(widget) || qobject_cast<QLineEdit*>(widget);
      if (!control || is_inner(*widget)) continue;
      const std::string where = section.path.text() + ", " + widget->metaObject()->className() +
                                " in " + widget->parent()->objectName().toStdString();
      EXPECT_FALSE(name_of(*widget).isEmpty()) << where;
      EXPECT_NE(widget->focusPolicy(), Qt::NoFocus) << where;
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
