// A number with a slider and a box. The slider shows a soft range, the box takes all that is
// allowed. Knows no document: it tells what the person wants. Main thread.
#pragma once

#include <QWidget>

#include "editor/document/scale.hpp"

class QDoubleSpinBox;
class QSlider;

namespace psygen::editor {

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
  // Pixels of the box, right of the slider.
  int box_width() const;
  // Tells nobody.
  void set_value(double value);

 Q_SIGNALS:
  // What the person wants now; many times while the slider is dragged.
  void wanted(double value);
  // The slider is taken, and let go.
  void drag_began();
  void drag_ended();

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
