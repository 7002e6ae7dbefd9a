#include "editor/gallery/contact_sheet.hpp"

#include <QAbstractButton>
#include <QComboBox>
#include <QCompleter>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPainter>
#include <QPushButton>
#include <QSettings>
#include <QSpinBox>
#include <algorithm>

#include "editor/document/field_value.hpp"
#include "editor/document/qt_text.hpp"
#include "editor/panels/message_log.hpp"
#include "editor/pictures/model_world.hpp"
#include "editor/pictures/picture_service.hpp"
#include "engine/world/files/text_edit.hpp"

namespace psygen::editor {
namespace {

constexpr int kMaxSide = 8;  // cells per side
constexpr int kCellMargin = 4;
constexpr std::uint32_t kSheetWidth = 320;
constexpr double kMaxSmaller = 5;  // maximum ratio of a model's size to its size in the image
constexpr const char* kGeometryKey = "contact_sheet/geometry";

QString shown_value(const std::string& toml) {
  QString text = to_qstring(toml);
  if (text.startsWith('"') && text.endsWith('"')) text = text.mid(1, text.size() - 2);
  return text;
}

// The values of a cell, for its caption.
QString caption_of(const SweepCell& cell) {
  QStringList values;
  for (const std::string& value : cell.values)
    values += shown_value(value);
  return values.join(" · ");
}

}  // namespace

// A small image with a caption, which the user can click. Shows a placeholder, the image or an
// error.
class PictureCell final : public QAbstractButton {
 public:
  PictureCell() {
    setFocusPolicy(Qt::StrongFocus);
    setAttribute(Qt::WA_Hover);
    setCursor(Qt::PointingHandCursor);
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  }

  // The caption below the image: the value and its cost.
  void set_caption(const QString& value, const QString& cost) {
    value_ = value;
    cost_ = cost;
    setAccessibleName(value + (cost.isEmpty() ? "" : ", " + cost));
    update();
  }
  void set_image(const QImage& image) {
    image_ = image;
    error_.clear();
    setToolTip({});
    update();
  }
  void set_error(const QString& error) {
    error_ = error;
    setToolTip(value_ + ": " + error);
    update();
  }
  // Highlights the cell with the values of the present world.
  void set_present(bool present) {
    if (std::exchange(present_, present) != present) update();
  }
  QRect picture_area() const {
    const int lines = fontMetrics().height() + kCellMargin;
    return rect().adjusted(kCellMargin, kCellMargin, -kCellMargin, -kCellMargin - lines);
  }
  QSize sizeHint() const override { return {192, 150}; }
  QSize minimumSizeHint() const override { return {96, 84}; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override {
    if (event->key() == Qt::Key_Return) return click();
    QAbstractButton::keyPressEvent(event);
  }

 private:
  QImage image_;
  QString value_, cost_, error_;
  bool present_ = false;
};

void PictureCell::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  const QPalette& colours = palette();
  const bool light = underMouse() || hasFocus();
  if (present_ || light) {
    QColor colour = colours.color(QPalette::Highlight);
    if (!present_) colour.setAlpha(70);
    painter.fillRect(rect(), colour);
  }
  const QRect area = picture_area();
  if (image_.isNull()) {
    painter.fillRect(area, colours.color(QPalette::AlternateBase));
    painter.setPen(colours.color(QPalette::PlaceholderText));
    painter.drawText(area.adjusted(6, 4, -6, -4), Qt::AlignCenter | Qt::TextWordWrap,
                     error_.isEmpty() ? tr("…") : error_);
  } else {
    const QSize scaled = image_.size().scaled(area.size(), Qt::KeepAspectRatio);
    painter.drawImage(
        QRect(area.center() - QPoint(scaled.width() / 2, scaled.height() / 2), scaled), image_);
  }
  const QRect line(area.left(), area.bottom() + 1, area.width(), height() - area.bottom() - 2);
  painter.setPen(colours.color(present_ ? QPalette::HighlightedText : QPalette::WindowText));
  const int cost_width = cost_.isEmpty() ? 0 : fontMetrics().horizontalAdvance(cost_) + 6;
  painter.drawText(line.adjusted(2, 0, -cost_width, 0), Qt::AlignLeft | Qt::AlignVCenter,
                   fontMetrics().elidedText(value_, Qt::ElideRight, line.width() - cost_width));
  if (!present_) painter.setPen(colours.color(QPalette::PlaceholderText));
  painter.drawText(line.adjusted(0, 0, -2, 0), Qt::AlignRight | Qt::AlignVCenter, cost_);
}

ContactSheet::ContactSheet(Document& document, PictureService& service, MessageLog& messages,
                           AskView ask_view, QWidget* parent)
    : QDialog(parent),
      document_(document),
      service_(service),
      messages_(messages),
      ask_view_(std::move(ask_view)) {
  setWindowTitle(tr("Contact sheet"));
  setObjectName("contact_sheet");
  const auto add_box = [this](const QString& name) {
    auto* box = new QComboBox;
    box->setAccessibleName(name);
    box->setEditable(true);
    box->setInsertPolicy(QComboBox::NoInsert);
    box->completer()->setFilterMode(Qt::MatchContains);
    box->completer()->setCompletionMode(QCompleter::PopupCompletion);
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    box->setMinimumContentsLength(20);
    connect(box, &QComboBox::activated, this, [this] {
      page_ = 0;
      fill();
    });
    return box;
  };
  first_ = add_box(tr("Field along the columns"));
  second_ = add_box(tr("Field along the rows"));
  subject_ = new QComboBox;
  subject_->setAccessibleName(tr("Subject of the images"));
  subject_->addItems({tr("View of the world"), tr("Model alone")});
  connect(subject_, &QComboBox::activated, this, &ContactSheet::fill);
  const auto add_spin = [this](const QString& name) {
    auto* spin = new QSpinBox;
    spin->setAccessibleName(name);
    spin->setRange(1, kMaxSide);
    spin->setValue(4);
    spin->setKeyboardTracking(false);
    connect(spin, &QSpinBox::valueChanged, this, &ContactSheet::fill);
    return spin;
  };
  columns_ = add_spin(tr("Columns"));
  rows_ = add_spin(tr("Rows"));
  more_ = new QPushButton(tr("&Other seeds"));
  again_ = new QPushButton(tr("&Render again"));
  connect(more_, &QPushButton::clicked, this, [this] {
    ++page_;
    fill();
  });
  connect(again_, &QPushButton::clicked, this, &ContactSheet::fill);
  for (QPushButton* button : {more_, again_})
    button->setAutoDefault(false);
  auto* line = new QHBoxLayout;
  line->addWidget(first_, 2);
  line->addWidget(new QLabel(tr("and")));
  line->addWidget(second_, 2);
  line->addWidget(subject_);
  line->addWidget(columns_);
  line->addWidget(new QLabel("×"));
  line->addWidget(rows_);
  grid_ = new QGridLayout;
  grid_->setSpacing(2);
  status_ = new QLabel;
  auto* below = new QHBoxLayout;
  below->addWidget(status_, 1);
  below->addWidget(more_);
  below->addWidget(again_);
  auto* layout = new QVBoxLayout(this);
  layout->addLayout(line);
  layout->addLayout(grid_, 1);
  layout->addLayout(below);
  resize(880, 680);
  restoreGeometry(QSettings().value(kGeometryKey).toByteArray());
  connect(&document_, &Document::changed, this, [this](Change what) {
    if (!isVisible()) return;
    if (what == Change::kFile) return close(), void();
    list_fields();
    mark_present();
  });
}

void ContactSheet::showEvent(QShowEvent* event) {
  QDialog::showEvent(event);
  if (event->spontaneous()) return;
  list_fields();
  choose(suggested_.value_or(world::TextPath{"world", "seed"}));
  page_ = 0;
  fill();
}

void ContactSheet::hideEvent(QHideEvent* event) {
  service_.cancel(this);
  QSettings().setValue(kGeometryKey, saveGeometry());
  QDialog::hideEvent(event);
}

// Lists the fields of the present world and keeps the choice.
void ContactSheet::list_fields() {
  const QVariant chosen[] = {first_->currentData(), second_->currentData()};
  QComboBox* const boxes[] = {first_, second_};
  for (std::size_t i = 0; i < 2; ++i) {
    boxes[i]->clear();
    if (i == 1) boxes[i]->addItem(tr("(no second field)"), QString());
  }
  const auto list = [&](auto& self, const std::vector<world::WorldSection>& sections,
                        const QString& before) -> void {
    for (const world::WorldSection& section : sections) {
      const QString title = before + to_qstring(section.title);
      for (const world::WorldField& field : section.fields) {
        if (!can_sweep(field)) continue;
        for (QComboBox* box : boxes)
          box->addItem(title + ": " + to_qstring(field.label), to_qstring(field.path.text()));
      }
      self(self, section.parts, title + ", ");
    }
  };
  list(list, document_.sections(), {});
  for (std::size_t i = 0; i < 2; ++i)
    boxes[i]->setCurrentIndex(std::max(boxes[i]->findData(chosen[i]), 0));
}

void ContactSheet::choose(const world::TextPath& first) {
  const int index = first_->findData(to_qstring(first.text()));
  if (index >= 0) first_->setCurrentIndex(index);
  second_->setCurrentIndex(0);
  subject_->setCurrentIndex(subject_of(first) ? 1 : 0);
}

std::vector<world::WorldField> ContactSheet::fields() const {
  std::vector<world::WorldField> fields;
  for (const QComboBox* box : {first_, second_}) {
    const auto path = world::parse_text_path(box->currentData().toString().toStdString());
    const world::WorldField* field = path && !path->empty() ? document_.field(*path) : nullptr;
    if (field != nullptr && (fields.empty() || !(fields[0].path == field->path)))
      fields.push_back(*field);
  }
  return fields;
}

void ContactSheet::fill() {
  service_.cancel(this);
  swept_ = fields();
  const bool of_model = !swept_.empty() && subject_of(swept_[0].path).has_value();
  subject_->setEnabled(of_model);
  if (!of_model) subject_->setCurrentIndex(0);
  more_->setVisible(std::ranges::any_of(
      swept_, [](const auto& field) { return field.kind == world::FieldKind::kSeed; }));
  const auto columns = static_cast<std::size_t>(columns_->value());
  auto cells = sweep_cells(document_.text(), *document_.parsed(), swept_,
                           static_cast<std::size_t>(rows_->value()), columns, page_);
  for (const Shown& shown : shown_)
    delete shown.widget;
  shown_.clear();
  if (!cells) return status_->setText(to_qstring(cells.error().message));
  // The first of two fields may have fewer values than there are columns.
  const std::size_t wide =
      swept_.size() == 2 ? sweep_values(swept_[0], columns, page_).size() : columns;
  for (std::size_t i = 0; i < cells->size(); ++i) {
    auto* widget = new PictureCell;
    widget->set_caption(caption_of((*cells)[i]), {});
    connect(widget, &PictureCell::clicked, this, [this, i] { apply(i); });
    grid_->addWidget(widget, static_cast<int>(i / wide), static_cast<int>(i % wide));
    shown_.push_back({.cell = std::move((*cells)[i]), .widget = widget});
  }
  mark_present();
  ask_costs();
}

core::Result<PictureRequest> ContactSheet::request_of(const SweepCell& cell) const {
  PictureRequest request;
  request.file = document_.file().string();
  request.text = cell.text;
  const auto view = ask_view_();
  const QSize place = shown_.front().widget->picture_area().size();
  request.size = {kSheetWidth,
                  std::clamp(kSheetWidth * static_cast<std::uint32_t>(std::max(place.height(), 1)) /
                                 static_cast<std::uint32_t>(std::max(place.width(), 1)),
                             kSheetWidth / 4, kSheetWidth * 2)};
  const auto model = subject_of(swept_[0].path);
  if (subject_->currentIndex() == 1 && model) {
    auto text = portrait_of(cell.text, *model);
    if (!text) return tl::unexpected(text.error());
    request.kind = PictureKind::kPortrait;
    request.text = *std::move(text);
  } else if (view) {
    request.place = view->place;
    // The same height above other ground.
    request.place->at_m.y = view->above_m;
    request.place->above_ground = true;
    request.now_s = view->now_s;
  }
  return request;
}

// Requests the costs of all cells; then images follow, cheapest first.
void ContactSheet::ask_costs() {
  batch_ = service_.new_batch();
  drawn_ = 0;
  costs_left_ = shown_.size();
  const auto view = ask_view_();
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    PictureRequest request;
    request.kind = PictureKind::kCost;
    request.text = shown_[i].cell.text;
    request.file = document_.file().string();
    if (view) request.place = view->place;
    service_.ask(std::move(request), batch_, static_cast<double>(i), this,
                 [this, i](const PictureReply& reply) {
                   Shown& shown = shown_[i];
                   if (reply.cost) {
                     shown.seconds = reply.cost->seconds;
                     shown.widget->set_caption(caption_of(shown.cell),
                                               tr("%1 ms").arg(shown.seconds * 1000, 0, 'g', 3));
                   } else {
                     fail(i, to_qstring(reply.error));
                   }
                   if (--costs_left_ == 0) ask_distances();
                 });
  }
  update_status();
}

// All models of a sheet have the same distance, so that their sizes are comparable.
void ContactSheet::ask_distances() {
  distances_left_ = 0;
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    auto request = request_of(shown_[i].cell);
    if (shown_[i].failed || !request || request->kind != PictureKind::kPortrait) continue;
    request->kind = PictureKind::kMeasure;
    ++distances_left_;
    service_.ask(*std::move(request), batch_, static_cast<double>(i), this,
                 [this, i](const PictureReply& reply) {
                   shown_[i].distance_m = reply.distance_m;
                   if (!reply.error.empty()) fail(i, to_qstring(reply.error));
                   if (--distances_left_ == 0) ask_pictures();
                 });
  }
  if (distances_left_ == 0) ask_pictures();
}

// The cheapest cell comes first.
void ContactSheet::ask_pictures() {
  double farthest_m = 0;
  for (const Shown& shown : shown_)
    farthest_m = std::max(farthest_m, shown.distance_m);
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    if (shown_[i].failed) continue;
    auto request = request_of(shown_[i].cell);
    if (!request) {
      fail(i, to_qstring(request.error().message));
      continue;
    }
    request->distance_m = std::min(farthest_m, kMaxSmaller * shown_[i].distance_m);
    service_.ask(*std::move(request), batch_, shown_[i].seconds, this,
                 [this, i](const PictureReply& reply) {
                   if (reply.error.empty() && !reply.image.isNull()) {
                     shown_[i].widget->set_image(reply.image);
                   } else {
                     fail(i, reply.error.empty() ? tr("no image") : to_qstring(reply.error));
                   }
                   ++drawn_;
                   update_status();
                 });
  }
  update_status();
}

void ContactSheet::fail(std::size_t i, const QString& error) {
  shown_[i].failed = true;
  shown_[i].widget->set_error(error);
}

void ContactSheet::apply(std::size_t i) {
  if (i >= shown_.size()) return;
  const std::vector<std::string> values = shown_[i].cell.values;
  const auto view = ask_view_();
  const auto done =
      document_.edit(tr("Apply %1").arg(to_qstring(swept_[0].label)), [&](std::string_view before) {
        core::Result<std::string> text{std::string(before)};
        for (std::size_t f = 0; text && f < swept_.size(); ++f)
          text = with_field_value(*text, *document_.parsed(), swept_[f].path, values[f]);
        return text;
      });
  if (messages_.check(done) && view && subject_->currentIndex() == 0)
    Q_EMIT value_applied(view->above_m);
}

// Compares texts, so that undo marks the previous image.
void ContactSheet::mark_present() {
  for (const Shown& shown : shown_)
    shown.widget->set_present(shown.cell.text == document_.text());
  update_status();
}

void ContactSheet::update_status() {
  const auto is_present = [this](const Shown& shown) {
    return shown.cell.text == document_.text();
  };
  const std::size_t failed = static_cast<std::size_t>(
      std::ranges::count_if(shown_, [](const Shown& shown) { return shown.failed; }));
  QString text;
  if (costs_left_ > 0) {
    text = tr("Predicting costs …");
  } else if (drawn_ + failed < shown_.size()) {
    text = tr("%1 of %2 images ready").arg(drawn_).arg(shown_.size());
  } else {
    text = tr("Click a picture to use its value. Costs are per block.");
  }
  if (costs_left_ == 0 && std::ranges::none_of(shown_, is_present) && page_ == 0 &&
      document_.undo_stack().canUndo())
    text += tr("  The world no longer matches this sheet.");
  status_->setText(text);
}

}  // namespace psygen::editor
