// The panel "Timeline" and the Flight menu: records the view's camera and replays it. Main thread.
#pragma once

#include <filesystem>

#include "editor/shell/main_window.hpp"

namespace psygen::editor {

class TimelinePanel;

// Makes the panel; the caller puts it into a dock. `folder`: for recordings and runs. The objects
// of the context outlive the panel.
TimelinePanel* make_timeline(const EditorContext& context, std::filesystem::path folder);
void add_flight_commands(QMenu& menu, TimelinePanel& timeline);

}  // namespace psygen::editor
