// Docks and menus of what works beside the panels: tools of the view, attached programs, recorded
// flights.
#include <QDockWidget>
#include <QMenu>
#include <QMenuBar>

#include "editor/attach/attach_dialog.hpp"
#include "editor/attach/remote_panel.hpp"
#include "editor/attach/remote_session.hpp"
#include "editor/flights/timeline_panel.hpp"
#include "editor/gallery/model_view.hpp"
#include "editor/panels/properties_panel.hpp"
#include "editor/shell/docks.hpp"
#include "editor/shell/main_window.hpp"
#include "editor/tools/view_tools.hpp"
#include "engine/core/camera.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/facts/prepared_world.hpp"
#include "engine/scene/scene.hpp"

namespace psygen::editor {
namespace {

QDockWidget* add_hidden_dock(QMainWindow& window, const QString& name, const QString& title,
                             QWidget* content, Qt::DockWidgetArea area) {
  QDockWidget* dock = add_dock(window, name, title, content, area);
  dock->hide();
  return dock;
}

void reveal(QDockWidget* dock) {
  dock->show();
  dock->raise();
}

}  // namespace

void MainWindow::add_tool_docks() {
  remote_ = new RemoteSession(this);
  auto* panel = new RemotePanel(*remote_);
  auto* attached =
      add_hidden_dock(*this, "attached", tr("Attached"), panel, Qt::RightDockWidgetArea);
  tabifyDockWidget(findChild<QDockWidget*>("map"), attached);
  connect(panel, &RemotePanel::go_to, this,
          [this](const core::CameraPose& pose) { model_->stand_in_world(pose); });
  connect(panel, &RemotePanel::follow_me, this, [this](bool on) {
    remote_follows_ = on && remote_->is_attached();
    if (!on && remote_->is_attached()) remote_->set_pose(std::nullopt);
  });
  connect(remote_, &RemoteSession::attached, this,
          [this, attached](const QJsonObject&, const std::string& text) {
            reveal(attached);
            resizeDocks({findChild<QDockWidget*>("properties"), attached},
                        {kPropertiesPx, kAttachedPx}, Qt::Horizontal);
            if (text != document_.text()) {
              if (!may_discard()) return remote_->detach(false);
              tell(document_.make_new(text));
            }
            remote_has_ = document_.text();
            say(tr("Attached: your changes go to process %1 too.").arg(remote_->endpoint().pid));
          });
  connect(remote_, &RemoteSession::told, this,
          [this](const QString& sentence) { say(tr("Attached program: %1").arg(sentence)); });
  connect(remote_, &RemoteSession::ended, this, [this](const QString& sentence) {
    remote_follows_ = false;
    say(sentence.isEmpty() ? tr("Detached.") : sentence);
  });
  connect(&document_, &Document::changed, this, [this] {
    if (!remote_->is_attached() || document_.text() == remote_has_) return;
    remote_has_ = document_.text();
    remote_->set_world(remote_has_);
  });

  TimelineHost host;
  host.world = [this]() -> const world::World& { return document_.world(); };
  host.world_text = [this] { return document_.text(); };
  host.saved_world = [this] {
    return document_.is_modified() ? std::filesystem::path() : document_.file();
  };
  host.pose = [this] { return view_->camera().pose(); };
  host.set_pose = [this](const core::CameraPose& pose) { model_->stand_in_world(pose); };
  host.size = [this] {
    return view_->session() != nullptr ? view_->session()->picture_size() : core::Extent{};
  };
  host.preset = [this] {
    return view_->session() != nullptr ? view_->session()->renderer().preset()
                                       : render::Preset::kLow;
  };
  host.folder = (options_.document.state_folder.empty() ? default_state_folder()
                                                        : options_.document.state_folder) /
                "flights";
  timeline_ = new TimelinePanel(std::move(host));
  auto* dock =
      add_hidden_dock(*this, "timeline", tr("Timeline"), timeline_, Qt::BottomDockWidgetArea);
  tabifyDockWidget(findChild<QDockWidget*>("statistics"), dock);
  // Docks that are added take the sizes of the others with them.
  resizeDocks({findChild<QDockWidget*>("properties"), findChild<QDockWidget*>("selection")},
              {kPropertiesPx, kSelectionPx}, Qt::Horizontal);
  resizeDocks({findChild<QDockWidget*>("statistics")}, {kStatisticsPx}, Qt::Vertical);
  connect(timeline_, &TimelinePanel::told, this, &MainWindow::say);
  connect(timeline_, &TimelinePanel::recording_changed, this, [this, dock](bool) {
    model_->close();
    reveal(dock);
  });
  connect(timeline_, &TimelinePanel::needs_processors, this,
          [this](bool on) { view_->set_yielding(Beside::kFlight, on); });
  connect(view_, &WorldView::drawn, this, [this] {
    timeline_->picture_drawn();
    if (remote_follows_) remote_->set_pose(model_->world_pose());
  });
}

void MainWindow::add_view_tools() {
  tools_ = new ViewTools(*this, document_, *view_, [this](bool on) { set_dragging(on); });
  connect(tools_, &ViewTools::told, this, &MainWindow::say);
  connect(tools_, &ViewTools::started, model_, &ModelView::close);
  connect(tools_, &ViewTools::chosen, properties_, &PropertiesPanel::go_to);
  connect(model_, &ModelView::switched, this, [this] {
    if (model_->is_on()) tools_->leave();
  });
}

void MainWindow::add_tools_menu() {
  tools_->add_to_menu(*menuBar()->addMenu(tr("&Tools")));
}

void MainWindow::add_attach_action(QMenu* menu) {
  menu->addAction(tr("A&ttach …"), this, [this] {
    if (remote_->is_attached()) return say(tr("Detach first: the Attached panel has the button."));
    AttachDialog dialog(this);
    if (dialog.exec() != QDialog::Accepted) return;
    if (const auto endpoint = dialog.chosen()) tell(remote_->attach(*endpoint));
  });
}

void MainWindow::add_flight_menu() {
  QMenu* menu = menuBar()->addMenu(tr("F&light"));
  QAction* record = menu->addAction(tr("&Record the camera"), tr("Ctrl+Shift+R"), this,
                                    [this](bool on) { timeline_->set_recording(on); });
  record->setCheckable(true);
  connect(timeline_, &TimelinePanel::recording_changed, record, &QAction::setChecked);
  menu->addAction(tr("&Play from here"), this, [this] { timeline_->play(true); });
  menu->addAction(tr("Run &again with the timeline's settings"), this,
                  [this] { timeline_->fly(); });
  menu->addSeparator();
  menu->addAction(tr("&Open a path …"), this, [this] {
    reveal(findChild<QDockWidget*>("timeline"));
    timeline_->open_path();
  });
  menu->addAction(tr("Save the pat&h …"), this, [this] { timeline_->save_path(); });
  menu->addAction(tr("Save as frame &test …"), this, [this] { timeline_->save_test(); });
}

}  // namespace psygen::editor
