// The panel "Selection": the selected model or ground of the view, its levels of detail and its
// parameters, as text. Main thread.
#pragma once

#include <QPlainTextEdit>

#include "editor/view/picking.hpp"

namespace psygen::scene {
class Scene;
}

namespace psygen::editor {

class WorldView;

// Updates the text whenever the selection changes.
class SelectionPanel final : public QPlainTextEdit {
  Q_OBJECT

 public:
  // The view outlives the panel.
  explicit SelectionPanel(WorldView& view);
};

// The text of the panel.
QString describe(const Selection& selection, const scene::Scene& scene);

}  // namespace psygen::editor
