// The editor's window: the view of the world in the middle, panels around it, menus in the usual
// order. It connects document, view and panels; what each does is its own. Main thread.
#pragma once

#include <QElapsedTimer>
#include <QMainWindow>
#include <QTimer>

#include "editor/cost/edit_cost.hpp"
#include "editor/cost/world_impact.hpp"
#include "editor/document/document.hpp"
#include "editor/view/world_view.hpp"

class QComboBox;
class QLabel;
class QPlainTextEdit;
class QToolBar;

namespace psygen::editor {

class CacheMap;
class CommandPalette;
class CostWorker;
class ModelView;
class PictureTools;
class PropertiesPanel;
class RemoteSession;
class StatisticsPanel;
class TimelinePanel;
class ViewTools;

struct MainWindowOptions {
  app::SessionOptions session;
  DocumentOptions document;
  bool safe = false;  // opens with synthesis paused
  CostLimits limits;  // beyond which values ask first; the cache is at most that of the session
};

class MainWindow final : public QMainWindow {
  Q_OBJECT

 public:
  explicit MainWindow(MainWindowOptions options);
  ~MainWindow() override;

  // Opens a world file, or says why not.
  bool open_file(const std::filesystem::path& file);
  // Where the camera stands when the world is first seen, unless the person has been there before.
  void set_first_place(const core::CameraPose& pose, double height_m);
  Document& document() { return document_; }
  WorldView& view() { return *view_; }

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  void add_docks();
  void add_tool_docks();
  void add_menus();
  void add_file_menu();
  void add_edit_menu();
  void add_view_menu();
  void add_world_menu();
  void add_view_tools();
  void add_tools_menu();
  void add_flight_menu();
  void add_attach_action(QMenu* menu);
  void add_help_menu();
  void add_toolbar();
  void add_hour(QToolBar& bar);
  void add_weather(QToolBar& bar, const QString& label, const QString& help,
                   const world::TextPath& path);
  void add_model_bar();
  void add_model_action(QMenu& menu);
  void add_grid_menu(QMenu& menu);
  void connect_document();
  void connect_properties();
  void connect_costs();
  void connect_view();
  void restore_layout();
  void restore_place();
  void keep_place();
  void offer_recovery();

  // Says what went wrong in the status bar, and keeps it in the log. True if nothing did.
  bool tell(const core::Result<void>& result);
  void say(const QString& sentence);
  bool may_discard();
  void choose_file();
  bool save();
  bool save_as();
  void show_diff();
  void fill_recent_files();
  void note_file();

  void document_changed(Changes what);
  void disk_changed(DiskState state, bool conflict);
  void fit_title();
  void set_dragging(bool on);
  void look_at_scene();
  void ask_costs();
  void show_figures();
  void randomise(const world::TextPath& path);
  void copy_section(const world::TextPath& path);
  void paste_section(const world::TextPath& path);
  void section_menu(const world::TextPath& path, const QPoint& at);
  void set_theme(const QString& name);
  void set_scale(int percent);

  MainWindowOptions options_;
  Document document_;
  WorldView* view_;
  PropertiesPanel* properties_ = nullptr;
  StatisticsPanel* statistics_ = nullptr;
  CacheMap* map_ = nullptr;
  QPlainTextEdit* selection_text_ = nullptr;
  QPlainTextEdit* log_ = nullptr;
  CommandPalette* palette_ = nullptr;
  CostWorker* costs_ = nullptr;
  ModelView* model_ = nullptr;
  PictureTools* pictures_ = nullptr;
  RemoteSession* remote_ = nullptr;
  TimelinePanel* timeline_ = nullptr;
  ViewTools* tools_ = nullptr;
  std::string remote_has_;  // the world of the attached program
  bool remote_follows_ = false;
  QLabel* figures_ = nullptr;
  QMenu* recent_menu_ = nullptr;
  QMenu* panels_menu_ = nullptr;
  QTimer figures_timer_, costs_timer_;
  int costs_put_off_ = 0;  // times, because the view awaited meshes
  // What the scene's cache held and its cost model knew, when it was looked at last.
  CacheContents contents_;
  std::shared_ptr<const synthesis::CostModel> learnt_;
  QElapsedTimer looked_;
  ParsedWorldPtr drag_from_;    // null: nothing is dragged
  ParsedWorldPtr last_parsed_;  // before the last change
  QByteArray first_layout_;
  std::optional<core::CameraPose> first_place_;  // its height: above the ground
  decltype(world::Palette::images) shown_images_;
  double frame_ms_ = 0;     // smoothed
  double answered_ms_ = 0;  // of the last change
};

}  // namespace psygen::editor
