// The label in the status bar: frame time, triangles, error, queued meshes and speed of the view.
// Main thread.
#pragma once

#include <QLabel>
#include <QTimer>

class QStatusBar;

namespace psygen::editor {

class WorldView;

// Updates its text four times a second.
class FrameStatus final : public QLabel {
  Q_OBJECT

 public:
  // Adds itself to the status bar, which also shows how long each change takes. The view outlives
  // the label.
  FrameStatus(QStatusBar& bar, WorldView& view);

 private:
  void update_text();

  WorldView& view_;
  QTimer timer_;
  double frame_ms_ = 0;     // smoothed; 0 before the first frame
  double answered_ms_ = 0;  // from the last change to its first frame
};

}  // namespace psygen::editor
