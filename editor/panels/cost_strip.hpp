// A small curve under a slider: the predicted time per block for each of its values, with measured
// points. Invalid values are shaded red; a tool tip shows the numbers. Main thread.
#pragma once

#include <QWidget>
#include <vector>

#include "editor/cost/block_cost.hpp"

namespace psygen::editor {

// Points and value are independent: both may change at any time.
class CostStrip final : public QWidget {
  Q_OBJECT

 public:
  explicit CostStrip(QWidget* parent = nullptr);
  // Points of the slider's range, sorted by value.
  void set_points(std::vector<CostPoint> points);
  // The present value of the slider.
  void set_value(double value);
  QSize sizeHint() const override { return {80, 22}; }

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

// Returns a text such as "23 models, 118,000 triangles, 1.9 MB, 0.84 ms per block".
QString cost_text(const BlockCost& cost);

}  // namespace psygen::editor
