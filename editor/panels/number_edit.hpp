// A number with a slider for the soft range and a box for the hard range. It emits requests and
// changes no document. Main thread.
#pragma once

#include <QWidget>

#include "editor/document/scale.hpp"

class QDoubleSpinBox;
class QSlider;

namespace psygen::editor {

// Slider and box always show the same value.
class NumberEdit final : public QWidget {
  Q_OBJECT

 public:
  struct Range {
    double hard_min = 0, hard_max = 1;
    Scale scale;  // of the slider
    QString unit;
  };
  explicit NumberEdit(const Range& range, const QString& name, QWidget* parent = nullptr);

  double value() const;
  // Width of the box right of the slider, in pixels.
  int box_width() const;
  // Shows a value; emits nothing.
  void set_value(double value);

 Q_SIGNALS:
  // The user sets a value; many times during a drag of the slider.
  void change_requested(double value);
  // The user presses (true) or releases the slider.
  void dragged(bool on);

 private:
  double value_at(int position) const;
  int position_of(double value) const;
  void slide(int position);
  void type(double value);

  Range range_;
  QSlider* slider_;
  QDoubleSpinBox* box_;
};

}  // namespace psygen::editor
