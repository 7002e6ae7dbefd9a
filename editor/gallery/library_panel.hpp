// The presets of the library with a picture of each. A double click adds a species, rocks or grass,
// or gives the world another terrain or sky, as one undo step. Pictures come from the drawing
// process once and are kept in the person's cache folder. Main thread.
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

class PictureService;
struct PictureReply;

class LibraryPanel final : public QWidget {
  Q_OBJECT

 public:
  LibraryPanel(Document& document, PictureService& service, QWidget* parent = nullptr);

  // Reads the folders again.
  void reload();
  // Pictures that are listed and not there yet.
  int awaited() const { return awaited_; }

 Q_SIGNALS:
  // What was done or refused, as a sentence.
  void told(const QString& sentence);

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
  std::vector<Preset> presets_;
  QComboBox* heading_;
  QLineEdit* search_;
  QListWidget* list_;
  bool loaded_ = false;
  int awaited_ = 0;
};

}  // namespace psygen::editor
