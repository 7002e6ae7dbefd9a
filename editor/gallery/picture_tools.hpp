// What works with pictures beside the view: the contact sheet, the library, exports, and the
// comparison of two states A and B. It owns the service that draws and adds docks and commands to
// the window. Main thread.
#pragma once

#include <QObject>
#include <QPointer>
#include <QTime>
#include <QTimer>
#include <functional>
#include <optional>

#include "editor/document/document.hpp"
#include "editor/gallery/compare_window.hpp"
#include "editor/gallery/view_state.hpp"
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

class PictureTools final : public QObject {
  Q_OBJECT

 public:
  // `device`: part of the name of the Vulkan device, or empty.
  PictureTools(QMainWindow& window, Document& document, WorldView& view, const QString& device);

  // The dock, for the window to place.
  LibraryPanel& library() { return *library_; }
  // The field that the person was at last: what the contact sheet offers.
  void attend(const world::TextPath& field);
  // Whether the view shows the world, and its camera stands there.
  void set_on_world(bool on);
  void add_to_file_menu(QMenu& menu);
  void add_to_view_menu(QMenu& menu);
  void add_to_world_menu(QMenu& menu);

 Q_SIGNALS:
  void told(const QString& sentence);

 private:
  std::optional<ViewState> view_state() const;
  std::optional<std::pair<ComparedState, ComparedState>> states() const;
  // Puts the camera so high over the ground or water of the present text.
  void stand(double above_m);
  void open_sheet();
  void export_selection();
  void save_large_picture();
  void mark();
  void swap();
  void show_shown();
  void take_marked();

  QMainWindow& window_;
  Document& document_;
  WorldView& view_;
  PictureService service_;
  LibraryPanel* library_;
  ContactSheet* sheet_ = nullptr;
  CompareWindow* compare_ = nullptr;
  QLabel* shown_;  // in the status bar, while A is shown
  std::vector<QAction*> need_mark_;
  world::TextPath attended_, passed_;
  QTimer attention_;
  std::optional<std::string> marked_;  // the text A
  handmade::MemoryPicturesPtr marked_pictures_;
  std::filesystem::path marked_file_;
  QTime marked_at_;
  bool shows_marked_ = false, on_world_ = true;
};

}  // namespace psygen::editor
