// The editor's window: arranges the view, the panels, the toolbars and the menus around one
// document. Each panel is one entry of panels(); commands are in other classes. Main thread.
#pragma once

#include <QMainWindow>
#include <QTimer>
#include <string>
#include <vector>

#include "editor/cost/edit_cost.hpp"
#include "editor/document/document.hpp"
#include "editor/gallery/model_view.hpp"
#include "editor/panels/message_log.hpp"
#include "editor/panels/properties_panel.hpp"
#include "editor/shell/panel.hpp"
#include "editor/view/world_view.hpp"

namespace psygen::editor {

class CommandPalette;
class EditFeedback;
class FileCommands;
class PictureTools;
class RemoteCommands;
class TimelinePanel;
class ViewBars;
class ViewTools;

// The world that the editor opens without a file: the valley of the README.
inline constexpr const char* kFirstWorld = "silver_combe";

// The objects of a window that its commands work with. MainWindow owns them all.
struct EditorContext {
  QMainWindow& window;  // parent of dialogs, actions and command objects
  Document& document;
  WorldView& view;
  ModelView& model;  // a model shown alone in the view
  PropertiesPanel& properties;
  MessageLog& messages;
};

struct MainWindowOptions {
  app::SessionOptions session;
  DocumentOptions document;
  bool safe = false;  // opens with synthesis paused
  // Edits beyond these ask first. The cache limit is at most the budget of the session.
  CostLimits limits;
};

// The main window. Its object name and those of its docks and toolbars are in saved layouts.
class MainWindow final : public QMainWindow {
  Q_OBJECT

 public:
  // Shows a new world at first, with the layout of the last session.
  explicit MainWindow(MainWindowOptions options);
  ~MainWindow() override;

  // Opens a world file. Fails like Document::open(); the error also becomes a message.
  core::Result<void> open_file(const std::filesystem::path& file);
  // Gives the next opened world the pose for kFirstWorld, unless the user has visited it before.
  void use_first_pose() { use_first_pose_ = true; }
  Document& document() { return document_; }
  WorldView& view() { return *view_; }

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  EditorContext context();
  void add_view();
  void add_commands();
  std::vector<Panel> panels();
  void add_menus();
  void add_view_menu();
  void add_edit_menu();
  void connect_messages();
  void show_warnings();
  void restore_camera();
  QString camera_key() const;
  void restore_layout(const QByteArray& layout);
  void update_title();

  MainWindowOptions options_;
  Document document_;
  WorldView* view_;
  // Children of the window.
  PropertiesPanel* properties_ = nullptr;
  MessageLog* messages_ = nullptr;
  ModelView* model_ = nullptr;
  PictureTools* pictures_ = nullptr;
  FileCommands* files_ = nullptr;
  TimelinePanel* flights_ = nullptr;
  RemoteCommands* remote_ = nullptr;
  EditFeedback* feedback_ = nullptr;
  ViewBars* bars_ = nullptr;
  ViewTools* tools_ = nullptr;
  CommandPalette* palette_ = nullptr;
  std::vector<QAction*> panel_commands_;
  QByteArray first_layout_;
  bool use_first_pose_ = false;
  QTimer warnings_timer_{this};
  std::vector<std::string> shown_warnings_;  // of the world, already in the messages
};

}  // namespace psygen::editor
