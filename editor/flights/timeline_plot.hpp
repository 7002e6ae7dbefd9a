// Curves over the time of a flight: one row per curve, one time axis, and a cursor that the user
// drags. Draws a second run over the first. Main thread.
#pragma once

#include <QWidget>
#include <functional>
#include <vector>

#include "editor/flights/flight_run.hpp"

namespace psygen::editor {

// Draws the speed of the path, and below it the curves of the runs.
class TimelinePlot final : public QWidget {
  Q_OBJECT

 public:
  explicit TimelinePlot(QWidget* parent = nullptr);
  // The duration of the flight in seconds, and its speed in m/s at even steps from 0 to the end.
  void set_path(double duration_s, std::vector<double> speed_m_s);
  // The runs to draw over each other: the first, and the last one.
  void set_runs(std::vector<FlightRun> runs);
  void set_cursor(double time_s);
  double cursor() const { return cursor_s_; }
  QSize sizeHint() const override { return {600, 260}; }

 Q_SIGNALS:
  // The user moved the cursor.
  void dragged(double time_s);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  struct Row {
    QString name, unit;
    std::function<const std::vector<double>&(const FlightRun&)> values;
  };
  QRectF area() const;
  double x_of(double time_s) const;
  void drag(double x);
  void draw_row(QPainter& painter, const Row& row, const QRectF& place) const;
  void draw_speed(QPainter& painter, const QRectF& place) const;
  void draw_names(QPainter& painter, const QRectF& place, const QString& name, double most,
                  const QStringList& now) const;

  std::vector<Row> rows_;
  std::vector<FlightRun> runs_;
  std::vector<double> speed_m_s_;
  double duration_s_ = 0, cursor_s_ = 0;
};

// The colours of the first and the second run.
QColor run_colour(std::size_t run);

}  // namespace psygen::editor
