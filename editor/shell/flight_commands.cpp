#include "editor/shell/flight_commands.hpp"

#include <QAction>
#include <QMenu>

#include "editor/document/qt_text.hpp"
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

TimelinePanel* make_timeline(const EditorContext& context, std::filesystem::path folder) {
  auto* panel = new TimelinePanel(host_of(context, std::move(folder)));
  QObject::connect(panel, &TimelinePanel::message_posted, &context.messages,
                   &MessageLog::show_message);
  QObject::connect(panel, &TimelinePanel::recording_changed, panel,
                   [panel, &model = context.model] {
                     model.close();
                     show_panel(*panel);
                   });
  QObject::connect(
      panel, &TimelinePanel::needs_processors, &context.view,
      [&view = context.view](bool on) { view.set_background_work(BackgroundWork::kFlight, on); });
  QObject::connect(&context.view, &WorldView::drawn, panel, &TimelinePanel::on_frame_drawn);
  return panel;
}

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

}  // namespace psygen::editor
