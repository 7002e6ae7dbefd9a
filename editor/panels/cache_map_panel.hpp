// The panel "Cache map": the map of the view's cache, a list of colourings, and their legend. Reads
// the scene, changes nothing. Main thread.
#pragma once

#include <QTimer>
#include <QWidget>

namespace psygen::editor {

class WorldView;

// Updates the map four times a second.
class CacheMapPanel final : public QWidget {
  Q_OBJECT

 public:
  // The view outlives the panel.
  explicit CacheMapPanel(WorldView& view);

 private:
  QTimer timer_;
};

}  // namespace psygen::editor
