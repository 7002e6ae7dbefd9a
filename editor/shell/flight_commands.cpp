#include "editor/shell/flight_commands.hpp"

#include <QAction>
#include <QMenu>

#include "editor/flights/timeline_panel.hpp"
#include "editor/shell/panel.hpp"
#include "engine/core/camera.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/facts/world_facts.hpp"

namespace psygen::editor {
namespace {

TimelineHost host_of(const EditorContext& context, std::filesystem::path folder) {
  Document& document = context.document;
  WorldView& view = context.view;
  TimelineHost host;
  host.world = [&document]() -> const world::World& { return document.world(); };
  host.world_text = [&document] { return document.text(); };
  host.saved_world = [&document] {
    return document.is_modified() ? std::filesystem::path() : document.file();
  };
  host.pose = [&view] { return view.camera().pose(); };
  host.set_pose = [&model = context.model](const core::CameraPose& pose) {
    model.go_to_world(pose);
  };
  host.size = [&view] {
    return view.session() != nullptr ? view.session()->picture_size() : core::Extent{};
  };
  host.preset = [&view] {
    return view.session() != nullptr ? view.session()->renderer().preset() : render::Preset::kLow;
  };
  host.folder = std::move(folder);
  return host;
}

}  // namespace

FlightCommands::FlightCommands(const EditorContext& context, std::filesystem::path folder)
    : QObject(&context.window), panel_(new TimelinePanel(host_of(context, std::move(folder)))) {
  connect(panel_, &TimelinePanel::message_posted, &context.messages, &MessageLog::show_message);
  connect(panel_, &TimelinePanel::recording_changed, this, [this, &model = context.model] {
    model.close();
    show_panel(*panel_);
  });
  connect(panel_, &TimelinePanel::needs_processors, &context.view, [&view = context.view](bool on) {
    view.set_background_work(BackgroundWork::kFlight, on);
  });
  connect(&context.view, &WorldView::drawn, panel_, &TimelinePanel::on_frame_drawn);
}

void FlightCommands::add_to_menu(QMenu& menu) {
  QAction* record = menu.addAction(tr("&Record the camera"), tr("Ctrl+Shift+R"), panel_,
                                   &TimelinePanel::set_recording);
  record->setCheckable(true);
  connect(panel_, &TimelinePanel::recording_changed, record, &QAction::setChecked);
  menu.addAction(tr("&Play from here"), panel_, [this] { panel_->play(true); });
  menu.addAction(tr("Re-run with the timeline's &settings"), panel_, &TimelinePanel::fly);
  menu.addSeparator();
  menu.addAction(tr("&Open a path …"), panel_, [this] {
    show_panel(*panel_);
    panel_->open_path();
  });
  menu.addAction(tr("Save the pat&h …"), panel_, &TimelinePanel::save_path);
  menu.addAction(tr("Save as frame &test …"), panel_, &TimelinePanel::save_test);
}

}  // namespace psygen::editor
