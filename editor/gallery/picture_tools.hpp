// Tools that render images outside of the view: the contact sheet, the library, exports, and the
// comparison of two states A and B. Owns the picture service and adds commands to the window. Main
// thread.
#pragma once

#include <QObject>
#include <QTime>
#include <QTimer>
#include <optional>

#include "editor/document/document.hpp"
#include "editor/gallery/compare_window.hpp"
#include "editor/pictures/picture_request.hpp"
#include "editor/pictures/picture_service.hpp"
#include "editor/view/world_view.hpp"

class QAction;
class QDockWidget;
class QLabel;
class QMainWindow;
class QMenu;

namespace psygen::editor {

class ContactSheet;
class LibraryPanel;
class MessageLog;

// One per window.
class PictureTools final : public QObject {
 public:
  // `device`: render::RendererOptions::device_name.
  PictureTools(QMainWindow& window, Document& document, WorldView& view, MessageLog& messages,
               const QString& device);

  // The panel "Library".
  LibraryPanel& library() { return *library_; }
  // Records the field under the pointer or with the focus, for the contact sheet.
  void set_focused_field(const world::TextPath& field);
  // True while the view shows the world, not a model alone.
  void set_on_world(bool on);
  void add_to_file_menu(QMenu& menu);
  void add_to_view_menu(QMenu& menu);
  // Shows the contact sheet, for the focused field.
  void open_sheet();

 private:
  std::optional<ViewState> view_state() const;
  std::optional<std::pair<ComparedState, ComparedState>> states() const;
  // Sets the camera's height above the ground or water of the present text.
  void set_camera_height(double above_m);
  void export_selection();
  void save_large_picture();
  void mark();
  void swap();
  void update_label();
  void use_marked();

  QMainWindow& window_;
  Document& document_;
  WorldView& view_;
  MessageLog& messages_;
  PictureService service_;
  LibraryPanel* library_;
  ContactSheet* sheet_ = nullptr;
  CompareWindow* compare_ = nullptr;
  QLabel* label_;  // in the status bar, while there is an A
  std::vector<QAction*> need_mark_;
  world::TextPath focused_field_, field_under_pointer_;
  QTimer focus_delay_;
  std::optional<std::string> marked_;  // the text A
  handmade::MemoryPicturesPtr marked_pictures_;
  QTime marked_at_;
  bool shows_marked_ = false, on_world_ = true;
};

}  // namespace psygen::editor
