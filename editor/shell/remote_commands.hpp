// Attaches to a running program: the panel "Attached", the command of the File menu, and the world
// and camera that the program gets from the editor. Main thread.
#pragma once

#include <QObject>
#include <string>

#include "editor/shell/main_window.hpp"

namespace psygen::editor {

class FileCommands;
class RemotePanel;
class RemoteSession;

// Owns no panel: the window puts it into a dock.
class RemoteCommands final : public QObject {
  Q_OBJECT

 public:
  // Attaching replaces the document, so `files` offers to save it first.
  RemoteCommands(const EditorContext& context, FileCommands& files);

  // The panel "Attached".
  RemotePanel& panel() { return *panel_; }
  // Asks for a program and attaches to it.
  void attach();

 private:
  void on_attached(const std::string& world_text);
  void send_world();

  const EditorContext context_;
  FileCommands& files_;
  RemoteSession* remote_;
  RemotePanel* panel_;
  std::string sent_world_;  // the world of the attached program
  bool follows_ = false;    // the program's camera follows the view
};

}  // namespace psygen::editor
