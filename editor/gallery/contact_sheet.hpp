// A sheet of small pictures of the world with other values: of one field, or of two, the first
// along the columns. What is cheap comes first. A click takes the values over as one undo step. It
// is a window of its own; pictures come from the drawing process. Main thread.
#pragma once

#include <QDialog>
#include <vector>

#include "editor/document/document.hpp"
#include "editor/gallery/view_state.hpp"
#include "editor/pictures/sweep.hpp"

class QComboBox;
class QGridLayout;
class QLabel;
class QPushButton;
class QSpinBox;

namespace psygen::editor {

class PictureCell;
class PictureService;

class ContactSheet final : public QDialog {
  Q_OBJECT

 public:
  ContactSheet(Document& document, PictureService& service, AskView ask_view,
               QWidget* parent = nullptr);

  // The field that is offered when the sheet is opened next.
  void suggest(const world::TextPath& field) { suggested_ = field; }

 Q_SIGNALS:
  // Values were taken over from a picture whose camera was so high over the ground or water.
  void adopted(double above_m);
  // Values that the document refused.
  void refused(const QString& sentence);

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  struct Shown {
    SweepCell cell;
    PictureCell* widget = nullptr;
    std::optional<double> seconds;
    double distance_m = 0;  // at which a portrait shows the model whole
    bool failed = false;
  };
  void list_fields();
  void choose(const world::TextPath& first);
  const world::WorldField* field_of(const QComboBox& box) const;
  std::vector<world::WorldField> fields() const;
  void fill();
  void ask_costs();
  void note_cost(std::size_t i, const PictureReply& reply);
  void ask_distances();
  void ask_pictures();
  void note_picture(std::size_t i, const PictureReply& reply);
  core::Result<PictureRequest> request_of(const SweepCell& cell) const;
  void adopt(std::size_t i);
  void mark_present();
  void tell();

  Document& document_;
  PictureService& service_;
  AskView ask_view_;
  std::optional<world::TextPath> suggested_;
  QComboBox *first_, *second_, *what_;
  QSpinBox *rows_, *columns_;
  QPushButton *more_, *again_;
  QLabel* told_;
  QGridLayout* grid_;
  std::vector<Shown> shown_;
  std::vector<world::WorldField> swept_;
  int batch_ = 0;
  std::uint64_t page_ = 0;
  std::size_t costs_left_ = 0, distances_left_ = 0, drawn_ = 0;
  bool listing_ = false;
};

}  // namespace psygen::editor
