// Commands of the view: selection, debug views, a model alone, the grid, and saving its image. Main
// thread.
#pragma once

#include <QObject>

#include "editor/shell/editor_context.hpp"

class QMenu;

namespace psygen::editor {

// Without a session of the view, commands that need its scene do nothing or show a message.
class ViewCommands final : public QObject {
  Q_OBJECT

 public:
  // The objects of the context outlive this one.
  explicit ViewCommands(const EditorContext& context);

  void add_to_file_menu(QMenu& menu);
  void add_to_view_menu(QMenu& menu);
  // `paused`: synthesis is paused at first.
  void add_to_world_menu(QMenu& menu, bool paused);
  void add_to_help_menu(QMenu& menu);

 private:
  void add_debug_views(QMenu& menu);
  void add_model_alone(QMenu& menu);
  void add_grids(QMenu& menu);
  void save_image();
  void copy_command_line();
  void show_about();

  QMainWindow& window_;
  Document& document_;
  WorldView& view_;
  ModelView& model_;
  PropertiesPanel& properties_;
  MessageLog& messages_;
};

}  // namespace psygen::editor
