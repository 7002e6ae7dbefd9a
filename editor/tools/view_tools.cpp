#include "editor/tools/view_tools.hpp"

#include <QAction>
#include <QActionGroup>
#include <QComboBox>
#include <QLabel>
#include <QMainWindow>
#include <QMenu>
#include <QSignalBlocker>
#include <QToolBar>
#include <utility>

namespace psygen::editor {

ViewTools::ViewTools(QMainWindow& window, Document& document, WorldView& view,
                     std::function<void(bool)> set_dragging)
    : QObject(&window),
      document_(document),
      view_(view),
      set_dragging_(std::move(set_dragging)),
      group_(new QActionGroup(this)),
      road_(host()) {
  window.addToolBarBreak();
  bar_ = window.addToolBar(tr("Tools"));
  bar_->setObjectName("tools");
  group_->setExclusionPolicy(QActionGroup::ExclusionPolicy::ExclusiveOptional);
  connect(group_, &QActionGroup::triggered, this, [this](QAction* action) {
    for (const auto& [tool, button] : buttons_)
      if (button == action) turn_on(action->isChecked() ? tool : nullptr);
  });
  add_roads();
  add_commands(window);
  connect(&document_, &Document::changed, this, [this](Changes what) {
    if (what.testFlag(Change::kFile)) {
      leave();
      road_.choose(std::nullopt);
    }
    fill_roads();
  });
  fill_roads();
  turn_on(nullptr);
}

ToolHost ViewTools::host() {
  return {document_, [this](bool on) { set_dragging_(on); },
          [this](const QString& sentence) { Q_EMIT told(sentence); },
          [this](const world::TextPath& table) {
            fill_roads();
            if (!table.empty()) Q_EMIT chosen(table);
          }};
}

void ViewTools::add_tool(ViewTool& tool, const QString& name, const QString& key,
                         const QString& help) {
  QAction* action = bar_->addAction(name);
  action->setCheckable(true);
  action->setShortcut(key);
  action->setToolTip(tr("%1 (%2)").arg(help, key));
  group_->addAction(action);
  buttons_.push_back({&tool, action});
}

void ViewTools::add_of_tool(QWidget* widget) {
  of_tools_.push_back({buttons_.back().tool, bar_->addWidget(widget)});
}

void ViewTools::add_roads() {
  add_tool(road_, tr("Draw roads"), "F2", tr("Draw roads on the ground"));
  roads_ = new QComboBox;
  roads_->setAccessibleName(tr("The road to draw"));
  roads_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  connect(roads_, &QComboBox::activated, this, [this](int index) {
    road_.choose(index > 0 ? std::optional(static_cast<std::size_t>(index - 1)) : std::nullopt);
  });
  add_of_tool(roads_);
  add_of_tool(new QLabel(
      tr("  A click adds a point, dragging moves one, Del or the right button removes it.  ")));
}

void ViewTools::add_commands(QMainWindow& window) {
  leave_ = new QAction(tr("Leave the tool"), &window);
  leave_->setShortcut(Qt::Key_Escape);
  connect(leave_, &QAction::triggered, this, &ViewTools::escape);
  remove_ = new QAction(tr("Remove what the tool has chosen"), &window);
  remove_->setShortcut(QKeySequence::Delete);
  connect(remove_, &QAction::triggered, this, &ViewTools::remove);
}

void ViewTools::add_to_menu(QMenu& menu) {
  for (const auto& [tool, button] : buttons_)
    menu.addAction(button);
  menu.addSeparator();
  menu.addActions({remove_, leave_});
}

void ViewTools::turn_on(ViewTool* tool) {
  if (tool != nullptr) Q_EMIT started();
  view_.set_tool(tool);
  for (const auto& [of, button] : buttons_)
    button->setChecked(of == tool);
  for (const auto& [of, action] : of_tools_)
    action->setVisible(of == tool);
  leave_->setEnabled(tool != nullptr);
  remove_->setEnabled(tool != nullptr);
}

void ViewTools::leave() {
  if (view_.tool() != nullptr) turn_on(nullptr);
}

void ViewTools::escape() {
  if (view_.tool() != nullptr && !view_.tool()->cancel()) leave();
}

void ViewTools::remove() {
  if (view_.tool() == &road_) road_.remove();
}

void ViewTools::fill_roads() {
  if (roads_ == nullptr) return;
  const QSignalBlocker quiet(roads_);
  const auto& roads = document_.world().shaped.roads;
  QStringList names{tr("New road")};
  for (std::size_t i = 0; i < roads.size(); ++i)
    names += tr("Road %1, %2 points").arg(i + 1).arg(roads[i].points_m.size());
  while (roads_->count() > names.size())
    roads_->removeItem(roads_->count() - 1);
  for (int i = 0; i < names.size(); ++i) {
    if (i < roads_->count())
      roads_->setItemText(i, names[i]);
    else
      roads_->addItem(names[i]);
  }
  roads_->setCurrentIndex(road_.road() ? static_cast<int>(*road_.road()) + 1 : 0);
}

}  // namespace psygen::editor
