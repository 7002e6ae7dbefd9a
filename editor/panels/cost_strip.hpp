// What each value of a slider would cost, as a small curve under it: predicted time per block, with
// measured points. Values that are refused are shaded red; the mouse says the numbers. Main thread.
#pragma once

#include <QWidget>
#include <vector>

#include "editor/cost/block_cost.hpp"

namespace psygen::editor {

class CostStrip final : public QWidget {
  Q_OBJECT

 public:
  explicit CostStrip(QWidget* parent = nullptr);
  // Points by growing value, of the slider's range; and the present value.
  void set_points(std::vector<CostPoint> points);
  void set_value(double value);
  QSize sizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;

 private:
  double x_of(std::size_t point) const;
  double y_of(double seconds) const;
  std::size_t nearest(double value) const;

  std::vector<CostPoint> points_;
  double max_s_ = 0;  // of all points
  double value_ = 0;
};

// "23 models, 118,000 triangles, 1.9 MB, 0.84 ms a block".
QString cost_text(const BlockCost& cost);

}  // namespace psygen::editor
