#include "editor/shell/main_window.hpp"

#include <QAbstractSpinBox>
#include <QApplication>
#include <QCloseEvent>
#include <QComboBox>
#include <QDragEnterEvent>
#include <QMenuBar>
#include <QMimeData>
#include <QScrollBar>
#include <QSettings>
#include <QSlider>
#include <QStatusBar>
#include <QUndoView>
#include <algorithm>
#include <glm/trigonometric.hpp>

#include "editor/attach/remote_panel.hpp"
#include "editor/document/qt_text.hpp"
#include "editor/flights/timeline_panel.hpp"
#include "editor/gallery/library_panel.hpp"
#include "editor/gallery/picture_tools.hpp"
#include "editor/panels/cache_map.hpp"
#include "editor/panels/selection_panel.hpp"
#include "editor/panels/statistics_panel.hpp"
#include "editor/shell/command_palette.hpp"
#include "editor/shell/edit_feedback.hpp"
#include "editor/shell/file_commands.hpp"
#include "editor/shell/frame_status.hpp"
#include "editor/shell/remote_commands.hpp"
#include "editor/shell/section_commands.hpp"
#include "editor/shell/theme.hpp"
#include "editor/shell/view_bars.hpp"
#include "editor/shell/view_commands.hpp"
#include "editor/shell/view_container.hpp"
#include "editor/tools/view_tools.hpp"
#include "engine/core/camera.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {
namespace {

constexpr int kWarningsMs = 600;    // after the last change
constexpr double kEyeHeightM = 24;  // of the first pose, above the ground

core::CameraPose first_pose(const world::World& world) {
  core::CameraPose pose;
  pose.position = core::normalised({{}, {-1257, 0, 3978}}, world.block_size_m());
  pose.position.local.y = kEyeHeightM + world::surface_height_m(world, pose.position);
  pose.yaw = glm::radians(110.0);
  pose.pitch = glm::radians(-10.0);
  return pose;
}

// Rules of all number fields, sliders and combo boxes of the program: the wheel does not focus them
// and changes only a focused one, so that a panel scrolls past the others. A slider that
// disappears under the mouse is released.
class ControlRules final : public QObject {
 public:
  using QObject::QObject;
  bool eventFilter(QObject* object, QEvent* event) override {
    const QEvent::Type type = event->type();
    if (type != QEvent::Polish && type != QEvent::Hide && type != QEvent::Wheel) return false;
    auto* slider = qobject_cast<QAbstractSlider*>(object);
    const bool is_control = (slider && !qobject_cast<QScrollBar*>(object)) ||
                            qobject_cast<QAbstractSpinBox*>(object) ||
                            qobject_cast<QComboBox*>(object);
    if (!is_control) return false;
    auto* control = static_cast<QWidget*>(object);
    if (type == QEvent::Polish && control->focusPolicy() == Qt::WheelFocus)
      control->setFocusPolicy(Qt::StrongFocus);
    if (type == QEvent::Hide && slider != nullptr) slider->setSliderDown(false);
    if (type != QEvent::Wheel || control->hasFocus()) return false;
    event->ignore();
    return true;
  }
};

void add_flight_commands(QMenu& menu, TimelinePanel& timeline) {
  QAction* record = menu.addAction(tr("&Record the camera"), tr("Ctrl+Shift+R"), &timeline,
                                   &TimelinePanel::set_recording);
  record->setCheckable(true);
  QObject::connect(&timeline, &TimelinePanel::recording_changed, record, &QAction::setChecked);
  menu.addAction(tr("&Play from here"), &timeline, [&timeline] { timeline.play(true); });
  menu.addAction(tr("Re-run with the timeline's &settings"), &timeline, &TimelinePanel::fly);
  menu.addSeparator();
  menu.addAction(tr("&Open a path …"), &timeline, [&timeline] {
    show_panel(timeline);
    timeline.open_path();
  });
  menu.addAction(tr("Save the pat&h …"), &timeline, &TimelinePanel::save_path);
  menu.addAction(tr("Save as frame &test …"), &timeline, &TimelinePanel::save_test);
}

}  // namespace

MainWindow::MainWindow(MainWindowOptions options)
    : options_(std::move(options)),
      document_(options_.document),
      view_(new WorldView(options_.session)) {
  setObjectName("main");
  qApp->installEventFilter(new ControlRules(this));
  setAcceptDrops(true);
  setDockNestingEnabled(true);
  add_view();
  add_commands();
  panel_commands_ = add_panels(*this, panels());
  add_menus();
  add_frame_status(*statusBar(), *view_);
  connect_messages();
  resize(1280, 800);
  first_layout_ = saveState();
  const QSettings settings;
  restoreGeometry(settings.value("geometry").toByteArray());
  restore_layout(settings.value("layout").toByteArray());
  update_title();
}

// The tools and the drags of controls must release the document and the view before either ends.
MainWindow::~MainWindow() {
  hide();
  tools_->leave();
}

void MainWindow::add_view() {
  QWidget* container = make_view_container(*view_, this);
  container->setAccessibleName(tr("View of the world"));
  container->setMinimumSize(320, 240);
  setCentralWidget(container);
  view_->set_paused(options_.safe);
}

EditorContext MainWindow::context() {
  return {*this, document_, *view_, *model_, *properties_, *messages_};
}

// Objects that follow the document are notified in the order of their construction here.
void MainWindow::add_commands() {
  const auto set_dragging = [this](bool on) { feedback_->set_dragging(on); };
  messages_ = new MessageLog(*statusBar());
  properties_ = new PropertiesPanel(
      {.document = document_, .messages = *messages_, .set_dragging = set_dragging});
  model_ = new ModelView(document_, *view_, *messages_, this);
  palette_ = new CommandPalette(this);
  const EditorContext context = this->context();

  pictures_ = new PictureTools(*this, document_, *view_, *messages_,
                               to_qstring(options_.session.device_name));
  files_ = new FileCommands(context);
  const auto& state_folder = options_.document.state_folder;
  flights_ =
      new TimelinePanel(document_, *view_,
                        (state_folder.empty() ? default_state_folder() : state_folder) / "flights");
  connect(flights_, &TimelinePanel::message_posted, messages_, &MessageLog::show_message);
  connect(flights_, &TimelinePanel::pose_requested, model_, &ModelView::go_to_world);
  connect(flights_, &TimelinePanel::recording_changed, this, [this] {
    model_->close();
    show_panel(*flights_);
  });
  remote_ = new RemoteCommands(context, *files_);
  bars_ = new ViewBars(context, set_dragging);
  tools_ = new ViewTools(*this, document_, *view_, set_dragging);
  connect_sections(context);
  connect(view_, &WorldView::opened, this, [this](const QString& error) {
    if (error.isEmpty()) restore_camera();
  });
  CostLimits limits = options_.limits;
  limits.cache_bytes =
      std::min(limits.cache_bytes, static_cast<double>(options_.session.scene.budget_bytes));
  feedback_ = new EditFeedback(context, options_.document.register_models, limits);

  connect(properties_, &PropertiesPanel::field_focused, pictures_,
          &PictureTools::set_focused_field);
  connect(properties_, &PropertiesPanel::section_chosen, model_, &ModelView::follow);
  connect(model_, &ModelView::switched, this, [this] {
    if (model_->is_on()) tools_->leave();
    pictures_->set_on_world(!model_->is_on());
  });
  connect(tools_, &ViewTools::started, model_, &ModelView::close);
  connect(tools_, &ViewTools::chosen, properties_, &PropertiesPanel::go_to);
}

// The panels. A new panel is one entry here; its widget is a class in editor/panels.
std::vector<Panel> MainWindow::panels() {
  return {
      {.name = "properties",
       .title = tr("Properties"),
       .place = PanelPlace::kLeft,
       .shortcut = tr("Alt+1"),
       .make = [this] { return properties_; }},
      {.name = "library",
       .title = tr("Library"),
       .place = PanelPlace::kLeft,
       .shortcut = tr("Alt+2"),
       .make = [this] { return &pictures_->library(); }},
      {.name = "selection",
       .title = tr("Selection"),
       .place = PanelPlace::kTopRight,
       .shortcut = tr("Alt+3"),
       .make = [this] { return make_selection_panel(*view_); }},
      {.name = "history",
       .title = tr("History"),
       .place = PanelPlace::kTopRight,
       .shortcut = tr("Alt+4"),
       .make =
           [this] {
             auto* history = new QUndoView(&document_.undo_stack());
             history->setEmptyLabel(tr("As opened"));
             history->setAccessibleName(tr("History of edits"));
             return history;
           }},
      {.name = "map",
       .title = tr("Cache map"),
       .place = PanelPlace::kBottomRight,
       .shortcut = tr("Alt+5"),
       .make = [this] { return make_cache_map_panel(*view_); }},
      {.name = "attached",
       .title = tr("Attached"),
       .place = PanelPlace::kBottomRight,
       .shortcut = tr("Alt+6"),
       .is_open = false,
       .make = [this] { return &remote_->panel(); }},
      {.name = "statistics",
       .title = tr("Statistics"),
       .place = PanelPlace::kBottom,
       .shortcut = tr("Alt+7"),
       .make =
           [this] {
             auto* statistics = new StatisticsPanel(*view_);
             connect(feedback_, &EditFeedback::block_cost_changed, statistics,
                     &StatisticsPanel::show_block_cost);
             return statistics;
           }},
      {.name = "messages",
       .title = tr("Messages"),
       .place = PanelPlace::kBottom,
       .shortcut = tr("Alt+8"),
       .make = [this] { return messages_; }},
      {.name = "timeline",
       .title = tr("Timeline"),
       .place = PanelPlace::kBottom,
       .shortcut = tr("Alt+9"),
       .is_open = false,
       .make = [this] { return flights_; }},
  };
}

void MainWindow::add_menus() {
  QMenu* file = menuBar()->addMenu(tr("&File"));
  files_->add_to_menu(*file);
  file->addSeparator();
  add_image_commands(*file, context());
  pictures_->add_to_file_menu(*file);
  file->addSeparator();
  file->addAction(tr("A&ttach …"), remote_, &RemoteCommands::attach);
  file->addAction(tr("&Quit"), QKeySequence::Quit, this, &QWidget::close);
  add_edit_menu();
  add_view_menu();
  QMenu* world = menuBar()->addMenu(tr("&World"));
  add_world_commands(*world, context(), pictures_->library());
  world->addSeparator();
  world->addAction(tr("&Contact sheet …"), tr("Ctrl+K"), pictures_, &PictureTools::open_sheet);
  add_pause_command(*world, context(), options_.safe);
  tools_->add_to_menu(*menuBar()->addMenu(tr("&Tools")));
  add_flight_commands(*menuBar()->addMenu(tr("F&light")), *flights_);
  add_help_commands(*menuBar()->addMenu(tr("&Help")), context());
}

void MainWindow::add_edit_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Edit"));
  QAction* undo = document_.undo_stack().createUndoAction(this, tr("&Undo"));
  undo->setShortcut(QKeySequence::Undo);
  QAction* redo = document_.undo_stack().createRedoAction(this, tr("&Redo"));
  redo->setShortcut(QKeySequence::Redo);
  menu->addActions({undo, redo});
  menu->addSeparator();
  add_section_commands(*menu, context());
  menu->addSeparator();
  menu->addAction(tr("Find a command or field …"), tr("Ctrl+Shift+P"), this, [this] {
    std::vector<CommandPalette::Command> commands = commands_of(*this);
    std::ranges::move(field_commands(context()), std::back_inserter(commands));
    palette_->ask(std::move(commands));
  });
}

void MainWindow::add_view_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&View"));
  add_view_commands(*menu, context());
  pictures_->add_to_view_menu(*menu);
  menu->addSeparator();
  QMenu* panels = menu->addMenu(tr("Pan&els"));
  for (QAction* command : panel_commands_)
    panels->addAction(command);
  menu->addAction(tr("&Reset the layout"), this, [this] { restore_layout(first_layout_); });
  add_theme_menus(*menu);
}

void MainWindow::connect_messages() {
  connect(view_, &WorldView::opened, messages_, [this](const QString& error) {
    if (!error.isEmpty()) messages_->show_message(error);
  });
  connect(view_, &WorldView::lost, messages_, [this] {
    messages_->show_message(
        tr("The graphics device was lost. The view opens it again; the document is unchanged."));
  });
  connect(view_, &WorldView::world_rejected, messages_, &MessageLog::show_message);
  connect(tools_, &ViewTools::message_posted, messages_, &MessageLog::show_message);
  // A drag changes the warnings many times; the last ones count.
  warnings_timer_.setObjectName("warnings");
  warnings_timer_.setSingleShot(true);
  warnings_timer_.setInterval(kWarningsMs);
  connect(&document_, &Document::changed, &warnings_timer_, [this](Change what) {
    if (what == Change::kFile) shown_warnings_.clear();
    warnings_timer_.start();
  });
  connect(&warnings_timer_, &QTimer::timeout, this, &MainWindow::show_warnings);
  connect(&document_, &Document::modified_changed, this, &MainWindow::update_title);
  connect(&document_, &Document::file_changed, this, &MainWindow::update_title);
}

// Shows the warnings of the world that the last change brought.
void MainWindow::show_warnings() {
  const std::vector<std::string>& now = document_.world().shaped.warnings;
  for (const std::string& warning : now) {
    if (std::ranges::find(shown_warnings_, warning) == shown_warnings_.end())
      messages_->show_message(tr("Warning: %1").arg(to_qstring(warning)));
  }
  shown_warnings_ = now;
}

core::Result<void> MainWindow::open_file(const std::filesystem::path& file) {
  return files_->open(file);
}

QString MainWindow::camera_key() const {
  return "places/" + file_key(document_.file());
}

// Gives a newly opened world the pose of the last visit, else the first pose or the world's home.
void MainWindow::restore_camera() {
  const bool first = std::exchange(use_first_pose_, false);
  const QVariantList kept = QSettings().value(camera_key()).toList();
  ViewCamera& camera = view_->camera();
  if (kept.size() == 7) {
    core::CameraPose pose;
    pose.position.block = {kept[0].toInt(), kept[1].toInt()};
    pose.position.local = {kept[2].toDouble(), kept[3].toDouble(), kept[4].toDouble()};
    pose.yaw = kept[5].toDouble();
    pose.pitch = kept[6].toDouble();
    return camera.set_pose(pose);
  }
  view_->focus();
  if (first) camera.set_pose(first_pose(document_.world()));
}

void MainWindow::update_title() {
  const QString name =
      document_.file().empty() ? tr("new world") : to_qstring(document_.file().filename().string());
  const QString shown = document_.is_template()    ? tr("%1 (template)").arg(name)
                        : document_.is_read_only() ? tr("%1 (read-only)").arg(name)
                                                   : name;
  setWindowTitle(tr("%1[*] – psygen editor").arg(shown));
  setWindowModified(document_.is_modified());
}

void MainWindow::restore_layout(const QByteArray& layout) {
  restoreState(layout);
  bars_->update_model_bar();
}

void MainWindow::changeEvent(QEvent* event) {
  if (event->type() == QEvent::ActivationChange && isActiveWindow()) document_.check_disk();
  QMainWindow::changeEvent(event);
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  const auto urls = event->mimeData()->urls();
  if (urls.size() == 1 && urls[0].isLocalFile()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  if (files_->may_discard()) open_file(event->mimeData()->urls()[0].toLocalFile().toStdString());
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!files_->may_discard()) return event->ignore();
  QSettings settings;
  settings.setValue("geometry", saveGeometry());
  settings.setValue("layout", saveState());
  if (view_->session() != nullptr && !document_.file().empty()) {
    const core::CameraPose pose = model_->world_pose();
    const core::WorldPosition& at = pose.position;
    settings.setValue(camera_key(), QVariantList{at.block.x, at.block.z, at.local.x, at.local.y,
                                                 at.local.z, pose.yaw, pose.pitch});
  }
  event->accept();
}

}  // namespace psygen::editor
