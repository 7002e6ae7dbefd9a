// A window with small images of the world for other values of one or two fields, the first along
// the columns. Cheap worlds come first. A click applies the values as one undo step. The rendering
// process makes the images. Main thread.
#pragma once

#include <QDialog>
#include <vector>

#include "editor/document/document.hpp"
#include "editor/pictures/picture_request.hpp"
#include "editor/pictures/sweep.hpp"

class QComboBox;
class QGridLayout;
class QLabel;
class QPushButton;
class QSpinBox;

namespace psygen::editor {

class MessageLog;
class PictureCell;
class PictureService;

// The window "Contact sheet".
class ContactSheet final : public QDialog {
  Q_OBJECT

 public:
  // Document, service and messages outlive the window.
  ContactSheet(Document& document, PictureService& service, MessageLog& messages, AskView ask_view,
               QWidget* parent);

  // The field that the sheet shows when it opens next.
  void suggest(const world::TextPath& field) { suggested_ = field; }

 Q_SIGNALS:
  // The user applied the values of an image. `above_m`: height of its camera above ground or water.
  void value_applied(double above_m);

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  struct Shown {
    SweepCell cell;
    PictureCell* widget = nullptr;
    double seconds = 0;     // cost of a block
    double distance_m = 0;  // at which a portrait shows the whole model
    bool failed = false;
  };
  void list_fields();
  void choose(const world::TextPath& first);
  std::vector<world::WorldField> fields() const;
  void fill();
  void ask_costs();
  void ask_distances();
  void ask_pictures();
  core::Result<PictureRequest> request_of(const SweepCell& cell) const;
  void fail(std::size_t i, const QString& error);
  void apply(std::size_t i);
  void mark_present();
  void update_status();

  Document& document_;
  PictureService& service_;
  MessageLog& messages_;
  AskView ask_view_;
  std::optional<world::TextPath> suggested_;
  QComboBox *first_, *second_, *subject_;
  QSpinBox *rows_, *columns_;
  QPushButton *more_, *again_;
  QLabel* status_;
  QGridLayout* grid_;
  std::vector<Shown> shown_;
  std::vector<world::WorldField> swept_;
  int batch_ = 0;
  std::uint64_t page_ = 0;
  std::size_t costs_left_ = 0, distances_left_ = 0, drawn_ = 0;
};

}  // namespace psygen::editor
