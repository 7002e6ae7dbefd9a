// Embeds the view of the world into the editor's window. Main thread.
#pragma once

class QWidget;

namespace psygen::editor {

class WorldView;

// The widget owns the view and can have the keyboard focus. On X11 the view itself gets the
// keyboard. A Wayland compositor knows only the editor's window, so the widget passes its keys on.
QWidget* make_view_container(WorldView& view, QWidget* parent);

}  // namespace psygen::editor
