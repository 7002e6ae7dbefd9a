#include "editor/tools/view_tools.hpp"

#include <QAction>
#include <QActionGroup>
#include <QComboBox>
#include <QLabel>
#include <QMainWindow>
#include <QMenu>
#include <QSignalBlocker>
#include <QToolBar>
#include <tuple>
#include <utility>

namespace psygen::editor {
namespace {

// Changes only what differs, so that an open list stays open.
void fill(QComboBox& box, const QStringList& names, int current) {
  const QSignalBlocker quiet(&box);
  while (box.count() > names.size())
    box.removeItem(box.count() - 1);
  for (int i = 0; i < names.size(); ++i) {
    if (i == box.count())
      box.addItem(names[i]);
    else if (box.itemText(i) != names[i])
      box.setItemText(i, names[i]);
  }
  box.setCurrentIndex(current);
}

}  // namespace

ViewTools::ViewTools(QMainWindow& window, Document& document, WorldView& view,
                     std::function<void(bool)> set_dragging)
    : QObject(&window),
      document_(document),
      view_(view),
      set_dragging_(std::move(set_dragging)),
      group_(new QActionGroup(this)),
      road_(host()),
      place_(host()) {
  window.addToolBarBreak();
  bar_ = window.addToolBar(tr("Tools"));
  bar_->setObjectName("tools");
  group_->setExclusionPolicy(QActionGroup::ExclusionPolicy::ExclusiveOptional);
  connect(group_, &QActionGroup::triggered, this, [this](QAction* action) {
    for (const auto& [tool, button] : buttons_)
      if (button == action) turn_on(action->isChecked() ? tool : nullptr);
  });
  add_roads();
  add_places();
  add_commands(window);
  connect(&document_, &Document::changed, this, [this](Changes what) {
    if (what.testFlag(Change::kFile)) {
      leave();
      road_.choose(std::nullopt);
      place_.choose(std::nullopt);
    }
    fill_lists();
  });
  fill_lists();
  turn_on(nullptr);
}

ToolHost ViewTools::host() {
  return {document_, [this](bool on) { set_dragging_(on); },
          [this](const QString& sentence) { Q_EMIT told(sentence); },
          [this](const world::TextPath& table) {
            fill_lists();
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

void ViewTools::add_places() {
  add_tool(place_, tr("Place models"), "F3", tr("Place single models on the ground"));
  types_ = new QComboBox;
  types_->setAccessibleName(tr("The model to place"));
  types_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  connect(types_, &QComboBox::textActivated, this,
          [this](const QString& name) { place_.set_type(name.toStdString()); });
  add_of_tool(types_);
  add_of_tool(
      new QLabel(tr("  A click places it, dragging moves it, the wheel over it turns it, Del "
                    "or the right button removes it.  ")));
}

void ViewTools::add_commands(QMainWindow& window) {
  leave_ = new QAction(tr("Leave the tool"), &window);
  leave_->setShortcut(Qt::Key_Escape);
  connect(leave_, &QAction::triggered, this, &ViewTools::escape);
  for (const auto& [name, key, steps] : {std::tuple{tr("Turn to the left"), Qt::Key_Comma, 1},
                                         std::tuple{tr("Turn to the right"), Qt::Key_Period, -1}}) {
    turns_.push_back(new QAction(name, &window));
    turns_.back()->setShortcut(key);
    connect(turns_.back(), &QAction::triggered, this,
            [this, steps = steps] { place_.turn(steps * PlaceTool::kTurnDeg); });
  }
  remove_ = new QAction(tr("Remove what the tool has chosen"), &window);
  remove_->setShortcut(QKeySequence::Delete);
  connect(remove_, &QAction::triggered, this, &ViewTools::remove);
}

void ViewTools::add_to_menu(QMenu& menu) {
  for (const auto& [tool, button] : buttons_)
    menu.addAction(button);
  menu.addSeparator();
  for (QAction* turn : turns_)
    menu.addAction(turn);
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
  for (QAction* turn : turns_)
    turn->setEnabled(tool == &place_);
}

void ViewTools::leave() {
  if (view_.tool() != nullptr) turn_on(nullptr);
}

void ViewTools::escape() {
  if (view_.tool() != nullptr && !view_.tool()->cancel()) leave();
}

void ViewTools::remove() {
  if (view_.tool() == &road_) road_.remove();
  if (view_.tool() == &place_) place_.remove();
}

void ViewTools::fill_lists() {
  if (roads_ != nullptr) fill_roads();
  if (types_ != nullptr) fill_types();
}

void ViewTools::fill_roads() {
  const auto& roads = document_.world().shaped.roads;
  QStringList names{tr("New road")};
  for (std::size_t i = 0; i < roads.size(); ++i)
    names += tr("Road %1, %2 points").arg(i + 1).arg(roads[i].points_m.size());
  fill(*roads_, names, road_.road() ? static_cast<int>(*road_.road()) + 1 : 0);
}

void ViewTools::fill_types() {
  QStringList names;
  for (const std::string& type : place_.types())
    names += QString::fromStdString(type);
  fill(*types_, names, static_cast<int>(names.indexOf(QString::fromStdString(place_.type()))));
}

}  // namespace psygen::editor
