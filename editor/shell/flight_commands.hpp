// The panel "Timeline" and the Flight menu: records the view's camera and replays it. Main thread.
#pragma once

#include <QObject>
#include <filesystem>

#include "editor/shell/editor_context.hpp"

class QMenu;

namespace psygen::editor {

class TimelinePanel;

// Owns no panel: the window puts it into a dock.
class FlightCommands final : public QObject {
  Q_OBJECT

 public:
  // `folder`: for recordings and runs.
  FlightCommands(const EditorContext& context, std::filesystem::path folder);

  // The panel "Timeline".
  TimelinePanel& panel() { return *panel_; }
  void add_to_menu(QMenu& menu);

 private:
  TimelinePanel* panel_;
};

}  // namespace psygen::editor
