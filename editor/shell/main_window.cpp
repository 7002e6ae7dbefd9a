#include "editor/shell/main_window.hpp"

#include <QCloseEvent>
#include <QComboBox>
#include <QDateTime>
#include <QDockWidget>
#include <QDragEnterEvent>
#include <QLabel>
#include <QMenu>
#include <QMenuBar>
#include <QMimeData>
#include <QPlainTextEdit>
#include <QSettings>
#include <QStatusBar>
#include <QUndoView>
#include <QVBoxLayout>

#include "editor/cost/cost_worker.hpp"
#include "editor/gallery/library_panel.hpp"
#include "editor/gallery/model_view.hpp"
#include "editor/gallery/picture_tools.hpp"
#include "editor/panels/cache_map.hpp"
#include "editor/panels/properties_panel.hpp"
#include "editor/panels/statistics_panel.hpp"
#include "editor/shell/command_palette.hpp"
#include "editor/shell/docks.hpp"
#include "editor/tools/view_tools.hpp"
#include "engine/core/camera.hpp"
#include "engine/core/log.hpp"
#include "engine/models/registry.hpp"
#include "engine/render/types.hpp"
#include "engine/scene/frame/quality.hpp"
#include "engine/scene/scene.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {
namespace {

constexpr int kFiguresMs = 250;
constexpr double kSmoothing = 0.1;

QPlainTextEdit* reading_pane(const QString& name) {
  auto* pane = new QPlainTextEdit;
  pane->setReadOnly(true);
  pane->setAccessibleName(name);
  pane->setFrameShape(QFrame::NoFrame);
  return pane;
}

}  // namespace

MainWindow::MainWindow(MainWindowOptions options)
    : options_(std::move(options)),
      document_(options_.document),
      view_(new WorldView(options_.session)) {
  setObjectName("main");
  setAcceptDrops(true);
  setDockNestingEnabled(true);
  QWidget* container = QWidget::createWindowContainer(view_, this);
  container->setFocusPolicy(Qt::StrongFocus);
  container->setAccessibleName(tr("View of the world"));
  container->setMinimumSize(320, 240);
  setCentralWidget(container);
  view_->set_paused(options_.safe);
  costs_ = new CostWorker(options_.document.register_models, this);
  model_ = new ModelView(document_, *view_, this);
  palette_ = new CommandPalette(this);
  add_docks();
  add_tool_docks();
  add_toolbar();
  add_view_tools();
  add_menus();
  figures_ = new QLabel;
  statusBar()->addPermanentWidget(figures_);
  connect_document();
  connect_properties();
  connect_view();
  resize(1280, 800);
  first_layout_ = saveState();
  restore_layout();
  fit_title();
}

// The document goes before the view.
MainWindow::~MainWindow() {
  tools_->leave();
}

void MainWindow::add_docks() {
  properties_ = new PropertiesPanel;
  statistics_ = new StatisticsPanel;
  map_ = new CacheMap;
  selection_text_ = reading_pane(tr("What is selected"));
  selection_text_->setPlaceholderText(tr("Click on a tree, a rock or the ground."));
  log_ = reading_pane(tr("Messages"));
  log_->setPlaceholderText(tr("What was refused, saved or copied is listed here."));
  auto* history = new QUndoView(&document_.undo_stack());
  history->setEmptyLabel(tr("As opened"));
  history->setAccessibleName(tr("History of edits"));
  auto* colours = new QComboBox;
  colours->addItems({tr("State"), tr("Level"), tr("PLP layer"), tr("Cost"), tr("Age")});
  colours->setAccessibleName(tr("What colours of the map mean"));
  auto* legend = new QLabel(legend_text(MapColour::kState));
  legend->setWordWrap(true);
  legend->setMinimumHeight(2 * legend->fontMetrics().lineSpacing());
  legend->setAlignment(Qt::AlignTop);
  connect(colours, &QComboBox::activated, map_, [this, legend](int index) {
    map_->set_colour(static_cast<MapColour>(index));
    legend->setText(legend_text(static_cast<MapColour>(index)));
  });
  auto* map_box = new QWidget;
  auto* map_layout = new QVBoxLayout(map_box);
  map_layout->setContentsMargins(4, 4, 4, 4);
  map_layout->addWidget(colours);
  map_layout->addWidget(map_, 1);
  map_layout->addWidget(legend);
  add_dock(*this, "properties", tr("Properties"), properties_, Qt::LeftDockWidgetArea);
  auto* selection =
      add_dock(*this, "selection", tr("Selection"), selection_text_, Qt::RightDockWidgetArea);
  auto* steps = add_dock(*this, "history", tr("History"), history, Qt::RightDockWidgetArea);
  add_dock(*this, "map", tr("Cache map"), map_box, Qt::RightDockWidgetArea);
  pictures_ = new PictureTools(*this, document_, *view_,
                               QString::fromStdString(options_.session.device_name));
  connect(pictures_, &PictureTools::told, this, &MainWindow::say);
  connect(properties_, &PropertiesPanel::attended, pictures_, &PictureTools::attend);
  auto* library =
      add_dock(*this, "library", tr("Library"), &pictures_->library(), Qt::LeftDockWidgetArea);
  auto* figures =
      add_dock(*this, "statistics", tr("Statistics"), statistics_, Qt::BottomDockWidgetArea);
  auto* messages = add_dock(*this, "messages", tr("Messages"), log_, Qt::BottomDockWidgetArea);
  tabifyDockWidget(selection, steps);
  tabifyDockWidget(findChild<QDockWidget*>("properties"), library);
  findChild<QDockWidget*>("properties")->raise();
  tabifyDockWidget(figures, messages);
  selection->raise();
  figures->raise();
}

void MainWindow::connect_view() {
  connect(view_, &WorldView::opened, this, [this](const QString& error) {
    if (!error.isEmpty()) return say(error);
    statistics_->forget();
    restore_place();
    ask_costs();
  });
  connect(view_, &WorldView::lost, this, [this] {
    say(tr("The graphics device was lost. The view is opened again; the document is as it was."));
  });
  connect(view_, &WorldView::refused, this, &MainWindow::say);
  connect(view_, &WorldView::refused, costs_, &CostWorker::go_on);
  connect(view_, &WorldView::answered, this, [this](double ms) {
    answered_ms_ = ms;
    costs_->go_on();
  });
  connect(view_, &WorldView::settled, this, [this](double ms) {
    statusBar()->showMessage(
        tr("The first picture came %1 ms after the change, the last mesh after %2 ms.")
            .arg(answered_ms_, 0, 'f', 0)
            .arg(ms, 0, 'f', 0),
        4000);
  });
  connect(view_, &WorldView::drawn, this, [this](double ms) {
    frame_ms_ += (ms - frame_ms_) * (frame_ms_ == 0 ? 1 : kSmoothing);
    statistics_->note(view_->session()->scene());
  });
  connect(view_, &WorldView::selected, this, [this] {
    const auto& selection = view_->selection();
    if (!selection) return selection_text_->clear();
    const scene::Scene& scene = view_->session()->scene();
    selection_text_->setPlainText(describe(*selection, scene));
    const std::string name(scene.registry()[selection->model].name());
    for (const world::WorldSection& section : document_.sections()) {
      if (section.title == name || (section.kind == world::SectionKind::kTerrain &&
                                    selection->kind == query::HitKind::kGround))
        return properties_->go_to(section.path);
    }
  });
  connect(model_, &ModelView::told, this, &MainWindow::say);
  connect(model_, &ModelView::switched, this,
          [this] { pictures_->set_on_world(!model_->is_on()); });
  connect(properties_, &PropertiesPanel::section_chosen, model_, &ModelView::follow);
  connect(&figures_timer_, &QTimer::timeout, this, &MainWindow::show_figures);
  figures_timer_.start(kFiguresMs);
}

void MainWindow::show_figures() {
  if (view_->session() == nullptr) return figures_->setText(tr("No picture"));
  const scene::Scene& scene = view_->session()->scene();
  figures_->setText(
      tr("%1 ms  ·  %2 triangles  ·  error %3 px  ·  %4 waiting  ·  %5 m/s")
          .arg(frame_ms_, 0, 'f', 1)
          .arg(QLocale(QLocale::English).toString(static_cast<qulonglong>(scene.drawn().triangles)))
          .arg(scene.quality().error_pixels, 0, 'f', 1)
          .arg(scene.meshes().outstanding())
          .arg(view_->camera().speed_m_s(), 0, 'f', 0));
  if (statistics_->isVisible()) statistics_->show(scene);
  map_->note(scene);
  if (map_->isVisible()) map_->show(scene);
}

bool MainWindow::tell(const core::Result<void>& result) {
  if (!result) say(QString::fromStdString(result.error().message));
  return result.has_value();
}

void MainWindow::say(const QString& sentence) {
  statusBar()->showMessage(sentence, 10'000);
  log_->appendPlainText(QDateTime::currentDateTime().toString("HH:mm:ss  ") + sentence);
}

void MainWindow::fit_title() {
  const QString name = document_.file().empty()
                           ? tr("new world")
                           : QString::fromStdString(document_.file().filename().string());
  const QString shown = document_.is_read_only() ? tr("%1 (read-only)").arg(name) : name;
  setWindowTitle(tr("%1[*] – psygen editor").arg(shown));
  setWindowModified(document_.is_modified());
}

void MainWindow::restore_layout() {
  const QSettings settings;
  restoreGeometry(settings.value("geometry").toByteArray());
  restoreState(settings.value("layout").toByteArray());
  Q_EMIT model_->switched();  // its bar is shown with it only
}

void MainWindow::set_first_place(const core::CameraPose& pose, double height_m) {
  first_place_ = pose;
  first_place_->position.local.y = height_m;
}

// Where the person was in this world before, else the first place, else the world's usual one.
void MainWindow::restore_place() {
  const QSettings settings;
  const QVariantList kept = settings.value("places/" + file_key(document_.file())).toList();
  if (kept.size() == 7) {
    core::CameraPose pose;
    pose.position.block = {kept[0].toInt(), kept[1].toInt()};
    pose.position.local = {kept[2].toDouble(), kept[3].toDouble(), kept[4].toDouble()};
    pose.yaw = kept[5].toDouble();
    pose.pitch = kept[6].toDouble();
    return view_->camera().set_pose(pose);
  }
  view_->focus();
  if (!first_place_) return;
  core::CameraPose pose = *std::exchange(first_place_, std::nullopt);
  const world::World& world = document_.world();
  pose.position = core::normalised(pose.position, world.block_size_m());
  pose.position.local.y += world::surface_height_m(world, pose.position);
  view_->camera().set_pose(pose);
}

void MainWindow::keep_place() {
  if (view_->session() == nullptr || document_.file().empty()) return;
  const core::CameraPose pose = model_->world_pose();
  QSettings().setValue(
      "places/" + file_key(document_.file()),
      QVariantList{pose.position.block.x, pose.position.block.z, pose.position.local.x,
                   pose.position.local.y, pose.position.local.z, pose.yaw, pose.pitch});
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
  if (may_discard()) open_file(event->mimeData()->urls()[0].toLocalFile().toStdString());
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!may_discard()) return event->ignore();
  QSettings settings;
  settings.setValue("geometry", saveGeometry());
  settings.setValue("layout", saveState());
  keep_place();
  event->accept();
}

}  // namespace psygen::editor
