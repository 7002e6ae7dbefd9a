// The panel "Selection": the selected model or ground of the view, its levels of detail and its
// parameters, as text. Main thread.
#pragma once

class QWidget;

namespace psygen::editor {

class WorldView;

// Makes the panel, which updates its text whenever the selection changes. The view outlives it.
QWidget* make_selection_panel(WorldView& view);

}  // namespace psygen::editor
