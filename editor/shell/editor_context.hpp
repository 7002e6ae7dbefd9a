// The objects of a window that its commands work with. MainWindow owns them all. Main thread.
#pragma once

#include <QMainWindow>

#include "editor/document/document.hpp"
#include "editor/gallery/model_view.hpp"
#include "editor/panels/properties_panel.hpp"
#include "editor/shell/message_log.hpp"
#include "editor/view/world_view.hpp"

namespace psygen::editor {

struct EditorContext {
  QMainWindow& window;  // parent of dialogs, actions and command objects
  Document& document;
  WorldView& view;
  ModelView& model;  // a model shown alone in the view
  PropertiesPanel& properties;
  MessageLog& messages;
};

}  // namespace psygen::editor
