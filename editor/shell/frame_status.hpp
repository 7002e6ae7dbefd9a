// The labels in the status bar: the water under the pointer; frame time, triangles, error, queued
// meshes and speed of the view.
// Main thread.
#pragma once

class QStatusBar;

namespace psygen::editor {

class WorldView;

// Adds the labels, which update their text four times a second. The status bar also shows how long
// each change takes. The view outlives the status bar.
void add_frame_status(QStatusBar& bar, WorldView& view);

}  // namespace psygen::editor
