#include "editor/tools/view_tools.hpp"

#include <QAction>
#include <QActionGroup>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QMainWindow>
#include <QMenu>
#include <QSignalBlocker>
#include <QSlider>
#include <QToolBar>
#include <utility>

#include "editor/document/qt_text.hpp"

namespace psygen::editor {
namespace {

constexpr int kStrengthSteps = 20, kStrengthPx = 90;
enum Area { kAroundView, kWholeWorld };   // of a new mask
constexpr double kGrowth = 1.25;          // of the brush, per key
constexpr double kAheadFraction = 0.375;  // of a new mask's side: maximum distance of its middle

// Changes only entries that differ, so that an open list stays open.
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
      place_(host()),
      mask_(host()) {
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
  add_masks();
  add_commands(window);
  connect(&document_, &Document::changed, this, [this](Change what) {
    if (what == Change::kFile) {
      leave();
      road_.choose(std::nullopt);
      place_.choose(std::nullopt);
      mask_.choose(std::nullopt);
      mask_.set_new_mask(std::nullopt);
    }
    fill_lists();
  });
  fill_lists();
  turn_on(nullptr);
}

ToolHost ViewTools::host() {
  return {.document = document_,
          .set_dragging = [this](bool on) { set_dragging_(on); },
          .show_message = [this](const QString& message) { Q_EMIT message_posted(message); },
          .chosen =
              [this](const world::TextPath& table) {
                fill_lists();
                if (!table.empty()) Q_EMIT chosen(table);
              },
          .around =
              [this](double size_m) {
                return middle_of_view(view_.camera().pose(), document_.world(),
                                      size_m * kAheadFraction);
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

QAction* ViewTools::add_of_tool(QWidget* widget) {
  of_tools_.push_back({buttons_.back().tool, bar_->addWidget(widget)});
  return of_tools_.back().action;
}

void ViewTools::add_roads() {
  add_tool(road_, tr("Draw roads"), "F2", tr("Draw roads on the ground"));
  roads_ = new QComboBox;
  roads_->setAccessibleName(tr("Road to draw"));
  roads_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  connect(roads_, &QComboBox::activated, this, [this](int index) {
    road_.choose(index > 0 ? std::optional(static_cast<std::size_t>(index - 1)) : std::nullopt);
  });
  add_of_tool(roads_);
  add_of_tool(new QLabel(
      tr("  Click to add a point, drag to move it, right-click or Del to remove it.  ")));
}

void ViewTools::add_places() {
  add_tool(place_, tr("Place models"), "F3", tr("Place models on the ground"));
  types_ = new QComboBox;
  types_->setAccessibleName(tr("Model to place"));
  types_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  connect(types_, &QComboBox::textActivated, this,
          [this](const QString& name) { place_.set_type(name.toStdString()); });
  add_of_tool(types_);
  add_of_tool(
      new QLabel(tr("  Click to place, drag to move, scroll over it to turn, right-click or Del to "
                    "remove.  ")));
}

void ViewTools::add_masks() {
  add_tool(mask_, tr("Paint masks"), "F4", tr("Paint where a scatter layer appears"));
  masks_ = new QComboBox;
  masks_->setAccessibleName(tr("Scatter layer of the mask"));
  masks_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  connect(masks_, &QComboBox::activated, this,
          [this](int index) { mask_.choose(static_cast<std::size_t>(index)); });
  add_of_tool(masks_);
  add_new_mask();
  add_brush();
  brush_parts_.push_back(add_of_tool(new QLabel(tr("  Drag to paint, Shift+drag to erase.  "))));
}

// The area and the pixels of a new mask, with the resulting image size or the error.
void ViewTools::add_new_mask() {
  auto* bar = new QWidget;
  bar->setObjectName("new_mask");
  auto* layout = new QHBoxLayout(bar);
  layout->setContentsMargins(6, 0, 6, 0);
  new_area_ = new QComboBox;
  new_area_->setAccessibleName(tr("Area of the new mask"));
  new_area_->setToolTip(tr("Area of the new mask: the blue border in the view"));
  new_area_->addItem(tr("Around the view"));
  layout->addWidget(new_area_);
  const auto add_metres = [layout](const QString& label, const QString& name) {
    auto* edit = new QDoubleSpinBox;
    edit->setAccessibleName(name);
    edit->setToolTip(name);
    edit->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
    edit->setGroupSeparatorShown(true);
    edit->setSuffix(tr(" m"));
    layout->addWidget(new QLabel(label));
    layout->addWidget(edit);
    return edit;
  };
  new_side_ = add_metres(tr("Side"), tr("Side of the new mask in metres"));
  new_side_->setRange(NewMask::kMinSideM, NewMask::kMaxSideM);
  new_side_->setDecimals(0);
  new_pixel_ = add_metres(tr("Pixel"), tr("Size of a pixel of the new mask in metres"));
  new_pixel_->setRange(NewMask::kMinPixelM, NewMask::kMaxPixelM);
  new_pixel_->setDecimals(1);
  layout->addWidget(new_size_ = new QLabel);
  const auto changed = [this] {
    mask_.set_new_mask(NewMask{.whole_world = new_area_->currentIndex() == kWholeWorld,
                               .side_m = new_side_->value(),
                               .pixel_m = new_pixel_->value()});
    show_new_mask();
  };
  connect(new_area_, &QComboBox::activated, this, changed);
  connect(new_side_, &QDoubleSpinBox::valueChanged, this, changed);
  connect(new_pixel_, &QDoubleSpinBox::valueChanged, this, changed);
  QAction* const controls = add_of_tool(bar);
  new_mask_ = bar_->addAction(tr("New mask"), this, [this] { mask_.make_mask(); });
  new_mask_->setToolTip(tr("Create a mask of this area"));
  of_tools_.push_back({&mask_, new_mask_});
  new_mask_parts_ = {controls, new_mask_};
}

void ViewTools::add_brush() {
  QAction* const radius_label = add_of_tool(new QLabel(tr("  Radius ")));
  radius_ = new QDoubleSpinBox;
  radius_->setAccessibleName(tr("Brush radius in metres"));
  radius_->setRange(MaskTool::kMinRadiusM, MaskTool::kMaxRadiusM);
  radius_->setDecimals(1);
  radius_->setSuffix(tr(" m"));
  radius_->setValue(mask_.brush().radius_m);
  radius_->setToolTip(tr("Brush radius ([ and ])"));
  connect(radius_, &QDoubleSpinBox::valueChanged, this,
          [this](double radius_m) { mask_.set_radius_m(radius_m); });
  QAction* const radius = add_of_tool(radius_);
  QAction* const strength_label = add_of_tool(new QLabel(tr("  Strength ")));
  auto* strength = new QSlider(Qt::Horizontal);
  strength->setAccessibleName(tr("Brush strength"));
  strength->setToolTip(tr("Brush strength: how much one stroke changes the mask"));
  strength->setRange(1, kStrengthSteps);
  strength->setValue(kStrengthSteps);
  strength->setMaximumWidth(kStrengthPx);
  connect(strength, &QSlider::valueChanged, this,
          [this](int value) { mask_.set_strength(static_cast<double>(value) / kStrengthSteps); });
  QAction* const strength_part = add_of_tool(strength);
  erase_ = bar_->addAction(tr("Erase"));
  erase_->setCheckable(true);
  erase_->setShortcut(Qt::Key_X);
  erase_->setToolTip(tr("Erase with the brush (X)"));
  connect(erase_, &QAction::toggled, this, [this](bool on) { mask_.set_erases(on); });
  of_tools_.push_back({&mask_, erase_});
  brush_parts_ = {radius_label, radius, strength_label, strength_part, erase_};
}

QAction* ViewTools::add_command(QMainWindow& window, const QString& name, const QKeySequence& key,
                                std::function<void()> does) {
  auto* command = new QAction(name, &window);
  command->setShortcut(key);
  connect(command, &QAction::triggered, this, std::move(does));
  return command;
}

void ViewTools::add_commands(QMainWindow& window) {
  const auto turn = [this](double degrees) { return [this, degrees] { place_.turn(degrees); }; };
  const auto scale = [this](double factor) {
    return [this, factor] { radius_->setValue(mask_.brush().radius_m * factor); };
  };
  const double degrees = PlaceTool::kTurnDeg;
  commands_ = {
      {&place_, add_command(window, tr("Turn left"), Qt::Key_Comma, turn(degrees))},
      {&place_, add_command(window, tr("Turn right"), Qt::Key_Period, turn(-degrees))},
      {&mask_, add_command(window, tr("Smaller brush"), Qt::Key_BracketLeft, scale(1 / kGrowth))},
      {&mask_, add_command(window, tr("Larger brush"), Qt::Key_BracketRight, scale(kGrowth))},
      {&mask_, erase_},
      {&mask_, new_mask_}};
  remove_ = add_command(window, tr("Delete the chosen point or model"), QKeySequence::Delete,
                        [this] { remove(); });
  leave_ = add_command(window, tr("Exit tool"), Qt::Key_Escape, [this] { escape(); });
}

void ViewTools::add_to_menu(QMenu& menu) {
  for (const auto& [tool, button] : buttons_)
    menu.addAction(button);
  menu.addSeparator();
  for (const auto& [tool, command] : commands_)
    menu.addAction(command);
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
  for (const auto& [of, command] : commands_)
    command->setEnabled(of == tool);
  leave_->setEnabled(tool != nullptr);
  remove_->setEnabled(tool == &road_ || tool == &place_);
  if (tool == &mask_ && !mask_.scatter() && !document_.world().scatter.empty()) mask_.choose(0);
  fill_lists();
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

// Lists of an inactive tool are filled when it becomes active.
void ViewTools::fill_lists() {
  if (view_.tool() == &road_) fill_roads();
  if (view_.tool() == &place_) fill_types();
  if (view_.tool() == &mask_) fill_masks();
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
    names += to_qstring(type);
  fill(*types_, names, static_cast<int>(names.indexOf(to_qstring(place_.type()))));
}

void ViewTools::fill_masks() {
  const ParsedWorldPtr parsed = document_.parsed();
  QStringList names;
  for (const world::Scatter& scatter : parsed->world.scatter) {
    const std::string name(parsed->registry[scatter.model].name());
    const QString mask =
        scatter.mask.image.empty() ? tr("no mask") : to_qstring(scatter.mask.image);
    names += tr("%1: %2").arg(to_qstring(name), mask);
  }
  fill(*masks_, names, mask_.scatter() ? static_cast<int>(*mask_.scatter()) : -1);
  show_new_mask();
}

// Shows the controls of a new mask if the scatter has none, else those of the brush.
void ViewTools::show_new_mask() {
  const bool none = mask_.scatter() && !mask_.has_picture();
  for (QAction* part : new_mask_parts_)
    part->setVisible(none);
  for (QAction* part : brush_parts_)
    part->setVisible(!none);
  new_mask_->setEnabled(none);
  if (!none) return;
  const NewMask mask = mask_.new_mask();
  const bool is_endless = document_.world().is_endless();
  const QSignalBlocker quiet[] = {QSignalBlocker(new_area_), QSignalBlocker(new_side_),
                                  QSignalBlocker(new_pixel_)};
  if (is_endless && new_area_->count() > kWholeWorld) new_area_->removeItem(kWholeWorld);
  if (!is_endless && new_area_->count() == kWholeWorld) new_area_->addItem(tr("The whole world"));
  const bool whole = mask.whole_world && !is_endless;
  new_area_->setCurrentIndex(whole ? kWholeWorld : kAroundView);
  new_side_->setEnabled(!whole);
  // Does not replace a value while the user types it.
  if (new_side_->value() != mask.side_m) new_side_->setValue(mask.side_m);
  if (new_pixel_->value() != mask.pixel_m) new_pixel_->setValue(mask.pixel_m);
  const auto plan = plan_of(mask, document_.world(), {0, 0});
  new_size_->setText(
      plan ? tr("%1 × %2 pixels").arg(count_text(plan->width), count_text(plan->height))
           : tr("<b>too many pixels</b>"));
  new_size_->setToolTip(plan ? QString() : to_qstring(plan.error().message));
}

}  // namespace psygen::editor
