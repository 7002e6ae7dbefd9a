#include "editor/panels/number_edit.hpp"

#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QSignalBlocker>
#include <QSlider>
#include <algorithm>
#include <cmath>

namespace psygen::editor {
namespace {

constexpr int kSteps = 1000;

// A box that shows as many decimals as its value needs. It handles arrow keys and typed digits;
// undo and redo go to the window.
class NumberBox final : public QDoubleSpinBox {
 public:
  using QDoubleSpinBox::QDoubleSpinBox;

  QString textFromValue(double value) const override {
    return QLocale::c().toString(value, 'g', 7);
  }
  double valueFromText(const QString& text) const override {
    QString number = text;
    number.remove(suffix());
    return QLocale::c().toDouble(number.trimmed());
  }
  QValidator::State validate(QString& text, int&) const override {
    QString number = text;
    number.remove(suffix());
    bool ok = false;
    const double value = QLocale::c().toDouble(number.trimmed(), &ok);
    if (!ok) return QValidator::Intermediate;
    return value >= minimum() && value <= maximum() ? QValidator::Acceptable
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
};

// The step of the box: about a hundredth of the soft range, rounded to a power of ten.
double step_of(const NumberEdit::Range& range) {
  if (range.scale.whole) return 1;
  const double span = std::max(range.scale.high - range.scale.low, 1e-9);
  return std::pow(10.0, std::floor(std::log10(span / 50)));
}

}  // namespace

NumberEdit::NumberEdit(const Range& range, const QString& name, QWidget* parent)
    : QWidget(parent), range_(range), slider_(new QSlider(Qt::Horizontal)), box_(new NumberBox) {
  const double span = range.scale.high - range.scale.low;
  slider_->setRange(0, range.scale.whole && span < kSteps ? static_cast<int>(span) : kSteps);
  slider_->setAccessibleName(name);
  slider_->setFocusPolicy(Qt::StrongFocus);
  box_->setDecimals(range.scale.whole ? 0 : 10);
  box_->setRange(range.hard_min, range.hard_max);
  box_->setSingleStep(step_of(range));
  box_->setKeyboardTracking(false);
  box_->setAccessibleName(name);
  // Equally wide for all short units, so that rows are aligned.
  const QString unit = range.unit == "degrees" ? QStringLiteral("°")
                       : range.unit.isEmpty()  ? QString()
                                               : " " + range.unit;
  const auto width_of = [this](const QString& text) {
    return box_->fontMetrics().horizontalAdvance(text);
  };
  box_->setFixedWidth(width_of("0000000000") + std::max(width_of(unit), width_of(" m")));
  box_->setSuffix(unit);
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(slider_, 1);
  layout->addWidget(box_);
  setFocusProxy(slider_);
  connect(slider_, &QSlider::valueChanged, this, &NumberEdit::slide);
  connect(slider_, &QSlider::sliderPressed, this, [this] { Q_EMIT dragged(true); });
  connect(slider_, &QSlider::sliderReleased, this, [this] { Q_EMIT dragged(false); });
  connect(box_, &QDoubleSpinBox::valueChanged, this, &NumberEdit::type);
}

double NumberEdit::value() const {
  return box_->value();
}

int NumberEdit::box_width() const {
  return box_->width();
}

void NumberEdit::set_value(double value) {
  const QSignalBlocker quiet_slider(slider_), quiet_box(box_);
  slider_->setValue(position_of(value));
  box_->setValue(value);
}

double NumberEdit::value_at(int position) const {
  return range_.scale.at(static_cast<double>(position) / std::max(slider_->maximum(), 1));
}

int NumberEdit::position_of(double value) const {
  return static_cast<int>(std::lround(range_.scale.fraction_of(value) * slider_->maximum()));
}

void NumberEdit::slide(int position) {
  const double value = value_at(position);
  const QSignalBlocker quiet(box_);
  box_->setValue(value);
  Q_EMIT change_requested(value);
}

void NumberEdit::type(double value) {
  const QSignalBlocker quiet(slider_);
  slider_->setValue(position_of(value));
  Q_EMIT change_requested(value);
}

}  // namespace psygen::editor
