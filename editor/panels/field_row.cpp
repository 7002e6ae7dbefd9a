#include "editor/panels/field_row.hpp"

#include <QApplication>
#include <QCheckBox>
#include <QClipboard>
#include <QColorDialog>
#include <QComboBox>
#include <QContextMenuEvent>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSlider>
#include <QToolButton>
#include <algorithm>
#include <cmath>

#include "editor/document/qt_text.hpp"
#include "editor/panels/cost_strip.hpp"
#include "editor/panels/message_log.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

using world::FieldKind;

constexpr int kLabelWidth = 116, kSliderSteps = 1000;

// A box that shows as many decimals as its value needs. It handles arrow keys and typed digits;
// undo and redo go to the window.
class NumberBox final : public QDoubleSpinBox {
 public:
  using QDoubleSpinBox::QDoubleSpinBox;

  QString textFromValue(double value) const override {
    return QLocale::c().toString(value, 'g', 7);
  }
  double valueFromText(const QString& text) const override { return number_in(text).value_or(0); }
  QValidator::State validate(QString& text, int&) const override {
    const auto value = number_in(text);
    return value && *value >= minimum() && *value <= maximum() ? QValidator::Acceptable
                                                               : QValidator::Intermediate;
  }

 protected:
  bool event(QEvent* event) override {
    if (event->type() == QEvent::ShortcutOverride) {
      const auto* key = static_cast<QKeyEvent*>(event);
      if (key->matches(QKeySequence::Undo) || key->matches(QKeySequence::Redo)) {
        event->ignore();
        return false;
      }
    }
    return QDoubleSpinBox::event(event);
  }

 private:
  std::optional<double> number_in(QString text) const {
    bool ok = false;
    const double value = QLocale::c().toDouble(text.remove(suffix()).trimmed(), &ok);
    return ok ? std::optional(value) : std::nullopt;
  }
};

// The step of a box: about a hundredth of the soft range, rounded to a power of ten.
double step_of(const Scale& scale) {
  if (scale.whole) return 1;
  return std::pow(10.0, std::floor(std::log10(std::max(scale.high - scale.low, 1e-9) / 50)));
}

QString suffix_of(const std::string& unit) {
  if (unit == "degrees") return QStringLiteral("°");
  return unit.empty() || unit == "1" ? QString() : " " + to_qstring(unit);
}

std::size_t count_of(FieldKind kind) {
  switch (kind) {
    case FieldKind::kIntegerRange:
    case FieldKind::kRealRange:
    case FieldKind::kIntegerPair:
    case FieldKind::kRealPair:
      return 2;
    default:
      return 1;
  }
}

bool has_roots(const world::WorldField& field) {
  return field.encoding == world::ColourEncoding::kSquareRoot;
}

// The colour of a field on the display (sRGB), divided by `strength`. Components above 1 become 1.
QColor shown(const world::WorldField& field, double strength = 1) {
  const auto part = [&](std::size_t i) {
    const double stored = i < field.numbers.size() ? field.numbers[i] / strength : 0.0;
    const double v = std::clamp(has_roots(field) ? stored * stored : stored, 0.0, 1.0);
    return static_cast<float>(v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
  };
  return QColor::fromRgbF(part(0), part(1), part(2));
}

// A component of a field from one of the display.
double stored(const world::WorldField& field, double display) {
  const double v = display <= 0.04045 ? display / 12.92 : std::pow((display + 0.055) / 1.055, 2.4);
  return std::round((has_roots(field) ? std::sqrt(v) : v) * 1e4) / 1e4;
}

QToolButton* small_button(const QString& text, const QString& help) {
  auto* button = new QToolButton;
  button->setText(text);
  button->setToolTip(help);
  button->setAccessibleName(help);
  button->setAutoRaise(true);
  return button;
}

}  // namespace

FieldRow::FieldRow(FieldHost& host, const world::WorldField& field)
    : host_(host), field_(field), scale_(scale_of(field)), label_(new QLabel), reset_(nullptr) {
  const QString name = to_qstring(field.label);
  setObjectName(to_qstring(field.path.text()));
  label_->setText(name);
  label_->setFixedWidth(kLabelWidth);
  label_->setWordWrap(true);
  setToolTip(to_qstring(field.doc));
  reset_ = small_button("↺", tr("Reset %1 to its default").arg(name));
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(2, 1, 2, 1);
  layout->addWidget(label_);
  build(*layout);
  layout->addWidget(reset_);
  connect(reset_, &QToolButton::clicked, this, &FieldRow::reset);
  show_lock();
  show(field);
}

void FieldRow::set_value(const std::string& toml) {
  if (!host_.messages.check(host_.document.set_value(field_.path, toml))) show(field_);
}

void FieldRow::reset() {
  host_.messages.check(host_.document.reset_value(field_.path));
}

void FieldRow::randomise() {
  host_.messages.check(host_.document.randomise(field_.path, host_.random));
}

void FieldRow::build(QHBoxLayout& layout) {
  switch (field_.kind) {
    case FieldKind::kColour:
      return add_colour(layout);
    case FieldKind::kSeed:
      return add_seed(layout);
    case FieldKind::kChoice:
      return add_choice(layout);
    case FieldKind::kBoolean:
      return add_switch(layout);
    case FieldKind::kText:
    case FieldKind::kImage:
    case FieldKind::kToml:
      return add_text(layout);
    default:
      break;
  }
  const QString name = to_qstring(field_.label);
  auto* column = new QVBoxLayout;
  column->setSpacing(0);
  const std::size_t count = count_of(field_.kind);
  for (std::size_t i = 0; i < count; ++i) {
    const bool pair = field_.kind == FieldKind::kIntegerPair || field_.kind == FieldKind::kRealPair;
    const QString part =
        i == 0 ? (pair ? tr("along x") : tr("minimum")) : (pair ? tr("along z") : tr("maximum"));
    auto* line = new QHBoxLayout;
    line->setSpacing(layout.spacing());
    add_number(*line, count == 1 ? name : name + ", " + part);
    column->addLayout(line);
  }
  layout.addLayout(column, 1);
  if (!has_cost_curve(field_)) return;
  // The strip is as wide as the slider above it. It exists before its costs are known, so that rows
  // keep their place.
  auto* line = new QHBoxLayout;
  cost_ = new CostStrip;
  line->addWidget(cost_, 1);
  line->addSpacing(numbers_.front().box->width() + layout.spacing());
  column->addLayout(line);
}

void FieldRow::add_number(QHBoxLayout& line, const QString& name) {
  auto* slider = new QSlider(Qt::Horizontal);
  const double span = scale_.high - scale_.low;
  slider->setRange(0, scale_.whole && span < kSliderSteps ? static_cast<int>(span) : kSliderSteps);
  slider->setAccessibleName(name);
  slider->setFocusPolicy(Qt::StrongFocus);
  auto* box = new NumberBox;
  box->setDecimals(scale_.whole ? 0 : 10);
  box->setRange(field_.hard_min, field_.hard_max);
  box->setSingleStep(step_of(scale_));
  box->setKeyboardTracking(false);
  box->setAccessibleName(name);
  // Equally wide for all short units, so that rows are aligned.
  const QString suffix = suffix_of(field_.unit);
  const auto width_of = [box](const QString& text) {
    return box->fontMetrics().horizontalAdvance(text);
  };
  box->setFixedWidth(width_of("0000000000") + std::max(width_of(suffix), width_of(" m")));
  box->setSuffix(suffix);
  line.addWidget(slider, 1);
  line.addWidget(box);
  const std::size_t at = numbers_.size();
  numbers_.push_back({slider, box});
  setFocusProxy(numbers_.front().slider);
  connect(slider, &QSlider::sliderPressed, this, [this] { host_.set_dragging(true); });
  connect(slider, &QSlider::sliderReleased, this, [this] { host_.set_dragging(false); });
  connect(slider, &QSlider::valueChanged, this, [this, slider, box, at](int position) {
    const QSignalBlocker quiet(box);
    box->setValue(scale_.at(static_cast<double>(position) / std::max(slider->maximum(), 1)));
    want_numbers(at);
  });
  connect(box, &QDoubleSpinBox::valueChanged, this, [this, slider, at](double value) {
    const QSignalBlocker quiet(slider);
    slider->setValue(position_of(value, *slider));
    want_numbers(at);
  });
}

int FieldRow::position_of(double value, const QSlider& slider) const {
  return static_cast<int>(std::lround(scale_.fraction_of(value) * slider.maximum()));
}

// Moving one end of a range past the other moves both.
void FieldRow::want_numbers(std::size_t changed) {
  std::vector<double> values;
  for (const Number& number : numbers_)
    values.push_back(number.box->value());
  const bool range =
      field_.kind == FieldKind::kIntegerRange || field_.kind == FieldKind::kRealRange;
  if (range && values[0] > values[1]) values[1 - changed] = values[changed];
  const auto whole = [](double v) { return static_cast<std::int64_t>(std::llround(v)); };
  if (range || field_.kind == FieldKind::kRealPair)
    return set_value(world::toml_range(values[0], values[1], is_whole(field_.kind)));
  if (field_.kind == FieldKind::kIntegerPair) return set_value(world::toml_vector(values));
  set_value(is_whole(field_.kind) ? world::toml_number(whole(values[0]))
                                  : world::toml_number(values[0]));
}

void FieldRow::add_choice(QHBoxLayout& layout) {
  auto* box = new QComboBox;
  for (const std::string& choice : field_.choices)
    box->addItem(to_qstring(choice));
  box->setAccessibleName(label_->text());
  layout.addWidget(box, 1);
  setFocusProxy(box);
  connect(box, &QComboBox::textActivated, this,
          [this](const QString& text) { set_value(world::toml_string(text.toStdString())); });
  refresh_ = [this, box] { box->setCurrentText(to_qstring(field_.plain)); };
}

void FieldRow::add_text(QHBoxLayout& layout) {
  auto* line = new QLineEdit;
  line->setAccessibleName(label_->text());
  layout.addWidget(line, 1);
  setFocusProxy(line);
  const bool toml = field_.kind == FieldKind::kToml;
  const auto shown_text = [this, toml] { return toml ? field_.value : field_.plain; };
  connect(line, &QLineEdit::editingFinished, this, [this, line, toml, shown_text] {
    const std::string text = line->text().toStdString();
    if (text != shown_text()) set_value(toml ? text : world::toml_string(text));
  });
  refresh_ = [line, shown_text] {
    line->setText(to_qstring(shown_text()));
    if (!line->hasFocus()) line->setCursorPosition(0);  // shows the beginning of the text
  };
}

void FieldRow::add_switch(QHBoxLayout& layout) {
  auto* box = new QCheckBox;
  box->setAccessibleName(label_->text());
  layout.addWidget(box, 1);
  setFocusProxy(box);
  connect(box, &QCheckBox::toggled, this, [this](bool on) { set_value(on ? "true" : "false"); });
  refresh_ = [this, box] {
    const QSignalBlocker quiet(box);
    box->setChecked(field_.value == "true");
  };
}

void FieldRow::add_colour(QHBoxLayout& layout) {
  auto* button = new QPushButton;
  button->setAccessibleName(label_->text());
  layout.addWidget(button, 1);
  setFocusProxy(button);
  connect(button, &QPushButton::clicked, this, &FieldRow::choose_colour);
  refresh_ = [this, button] {
    const QColor colour = shown(field_);
    const QColor ink = colour.lightnessF() > 0.5F ? Qt::black : Qt::white;
    button->setText(to_qstring(field_.value));
    button->setStyleSheet(QString("QPushButton { background: %1; color: %2; border: 1px solid "
                                  "palette(mid); padding: 3px; }")
                              .arg(colour.name(), ink.name()));
  };
}

// All colours of the dialog are one drag, which Cancel undoes.
void FieldRow::choose_colour() {
  // Radiance may be brighter than the display: the dialog sets the hue, the strength stays.
  double strength = 1;
  for (const double part : field_.numbers)
    strength = std::max(strength, part);
  auto* dialog = new QColorDialog(shown(field_, strength), this);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(label_->text());
  host_.set_dragging(true);
  connect(dialog, &QColorDialog::currentColorChanged, this, [this, strength](const QColor& c) {
    const double parts[] = {stored(field_, c.redF()) * strength,
                            stored(field_, c.greenF()) * strength,
                            stored(field_, c.blueF()) * strength};
    set_value(world::toml_vector(parts));
  });
  connect(dialog, &QDialog::finished, this, [this](int result) {
    if (result != QDialog::Accepted) host_.messages.check(host_.document.cancel_drag());
    host_.set_dragging(false);
  });
  dialog->open();
}

// The panel shows other rows now: the drag of the dialog ends.
void FieldRow::hideEvent(QHideEvent* event) {
  auto* dialog = findChild<QColorDialog*>();
  if (dialog != nullptr && !event->spontaneous()) dialog->accept();
}

void FieldRow::add_seed(QHBoxLayout& layout) {
  auto* line = new QLineEdit;
  line->setAccessibleName(label_->text());
  auto* less = small_button("−", tr("Previous seed"));
  auto* more = small_button("+", tr("Next seed"));
  auto* dice = small_button("⚄", tr("Random seed"));
  for (QWidget* widget : std::initializer_list<QWidget*>{line, less, more, dice})
    layout.addWidget(widget, widget == line ? 1 : 0);
  setFocusProxy(line);
  const auto step = [this](int by) {
    return [this, by] { host_.messages.check(host_.document.step_value(field_.path, by)); };
  };
  connect(less, &QToolButton::clicked, this, step(-1));
  connect(more, &QToolButton::clicked, this, step(1));
  connect(dice, &QToolButton::clicked, this, &FieldRow::randomise);
  connect(line, &QLineEdit::editingFinished, this, [this, line] {
    bool ok = false;
    const std::uint64_t seed = line->text().toULongLong(&ok);
    if (!ok) return line->setText(to_qstring(field_.plain));
    if (line->text().toStdString() != field_.plain) set_value(world::toml_seed(seed));
  });
  refresh_ = [this, line] { line->setText(to_qstring(field_.plain)); };
}

bool FieldRow::is_locked() const {
  return host_.document.locks().is_locked(field_.path);
}

void FieldRow::set_locked(bool locked) {
  host_.document.locks().set_locked(field_.path, locked);
  show_lock();
}

void FieldRow::show_lock() {
  QFont font = label_->font();
  font.setItalic(is_locked());
  label_->setFont(font);
}

// Commands of every field.
void FieldRow::contextMenuEvent(QContextMenuEvent* event) {
  QMenu menu;
  QAction* lock =
      menu.addAction(tr("Exclude from Randomise"), this, [this](bool on) { set_locked(on); });
  lock->setCheckable(true);
  lock->setChecked(is_locked());
  menu.addAction(tr("Random value"), this, &FieldRow::randomise);
  menu.addAction(tr("Reset to default"), this, &FieldRow::reset)->setEnabled(reset_->isEnabled());
  menu.addSeparator();
  menu.addAction(tr("Copy value"), this,
                 [this] { QApplication::clipboard()->setText(to_qstring(field_.value)); });
  menu.addAction(tr("Paste value"), this,
                 [this] { set_value(QApplication::clipboard()->text().trimmed().toStdString()); });
  menu.exec(event->globalPos());
}

void FieldRow::show(const world::WorldField& field) {
  field_ = field;
  for (std::size_t i = 0; i < numbers_.size() && !field_.numbers.empty(); ++i) {
    const auto [slider, box] = numbers_[i];
    const double value = field_.numbers[std::min(i, field_.numbers.size() - 1)];
    const QSignalBlocker quiet_slider(slider), quiet_box(box);
    slider->setValue(position_of(value, *slider));
    box->setValue(value);
  }
  if (refresh_) refresh_();
  if (cost_ != nullptr && !field_.numbers.empty()) cost_->set_value(field_.numbers.back());
  // A field that the text sets is bold and can be reset.
  QFont font = label_->font();
  font.setBold(field_.is_set);
  label_->setFont(font);
  reset_->setEnabled(field_.is_set && !field_.required);
}

void FieldRow::show_cost(std::vector<CostPoint> points) {
  if (cost_ != nullptr) cost_->set_points(std::move(points));
}

void FieldRow::enterEvent(QEnterEvent* event) {
  Q_EMIT field_focused(field_.path);
  QWidget::enterEvent(event);
}

}  // namespace psygen::editor
