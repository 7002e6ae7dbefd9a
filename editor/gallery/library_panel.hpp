// The panel "Library": the presets with an image of each. A double click adds a species, rocks or
// grass, or applies a terrain or a sky, as one undo step. The rendering process makes each image
// once; the user's cache folder keeps them. Main thread.
#pragma once

#include <QWidget>
#include <vector>

#include "editor/document/document.hpp"
#include "editor/pictures/preset_library.hpp"

class QComboBox;
class QLineEdit;
class QListWidget;
class QListWidgetItem;

namespace psygen::editor {

class MessageLog;
class PictureService;
struct PictureReply;

// Loads the library when the panel first becomes visible.
class LibraryPanel final : public QWidget {
  Q_OBJECT

 public:
  // Document, service and messages outlive the panel.
  LibraryPanel(Document& document, PictureService& service, MessageLog& messages);

  // Reads the folders again.
  void reload();
  // Number of images that the rendering process has not finished yet.
  int awaited() const { return awaited_; }

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  void list();
  void ask_pictures();
  void apply(const QListWidgetItem& item);
  void show_menu(const QPoint& at);
  const Preset& preset_of(const QListWidgetItem& item) const;

  Document& document_;
  PictureService& service_;
  MessageLog& messages_;
  std::vector<Preset> presets_;
  QComboBox* heading_;
  QLineEdit* search_;
  QListWidget* list_;
  bool loaded_ = false;
  int awaited_ = 0;
};

}  // namespace psygen::editor
