#include "editor/flights/timeline_plot.hpp"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

namespace psygen::editor {
namespace {

constexpr double kLeftPx = 150, kRightPx = 90, kAxisPx = 18, kGapPx = 4;
constexpr double kKeyStepS = 0.1;

double max_of(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) {
    if (std::isfinite(value)) most = std::max(most, value);
  }
  return most;
}

// Index of the last frame that began before a time.
std::size_t frame_at(const std::vector<double>& time_s, double t) {
  const auto after = std::ranges::upper_bound(time_s, t);
  return after == time_s.begin() ? 0 : static_cast<std::size_t>(after - time_s.begin()) - 1;
}

QString short_number(double value) {
  if (!std::isfinite(value)) return "–";
  if (std::abs(value) < 0.0005) return "0";
  return QString::number(value, value != 0 && std::abs(value) < 100 ? 'g' : 'f',
                         std::abs(value) < 100 ? 3 : 0);
}

// Step of the axis: 1, 2 or 5 times a power of ten, at most ten steps.
double axis_step(double duration_s) {
  const double unit = std::pow(10.0, std::floor(std::log10(std::max(duration_s, 1e-3) / 4)));
  for (const double times : {1.0, 2.0, 5.0}) {
    if (duration_s / (unit * times) <= 10) return unit * times;
  }
  return unit * 10;
}

}  // namespace

QColor run_colour(std::size_t run) {
  return run == 0 ? QColor(96, 156, 220) : QColor(235, 150, 50);
}

TimelinePlot::TimelinePlot(QWidget* parent)
    : QWidget(parent),
      rows_{{tr("frame time"), "ms", std::mem_fn(&FlightRun::frame_ms)},
            {tr("queue"), tr("requests"), std::mem_fn(&FlightRun::queued)},
            {tr("modelers busy"), "%", std::mem_fn(&FlightRun::busy_percent)},
            {tr("cache"), "MiB", std::mem_fn(&FlightRun::cache_mib)},
            {tr("error"), "px", std::mem_fn(&FlightRun::error_pixels)},
            {tr("missing"), "%", std::mem_fn(&FlightRun::missing_percent)}} {
  setMinimumHeight(180);
  setFocusPolicy(Qt::StrongFocus);
  setCursor(Qt::SizeHorCursor);
  setAccessibleName(tr("Timeline of the flight"));
}

void TimelinePlot::set_path(double duration_s, std::vector<double> speed_m_s) {
  duration_s_ = duration_s;
  speed_m_s_ = std::move(speed_m_s);
  cursor_s_ = std::min(cursor_s_, duration_s_);
  update();
}

void TimelinePlot::set_runs(std::vector<FlightRun> runs) {
  runs_ = std::move(runs);
  update();
}

void TimelinePlot::set_cursor(double time_s) {
  cursor_s_ = std::clamp(time_s, 0.0, duration_s_);
  update();
}

QRectF TimelinePlot::area() const {
  return QRectF(kLeftPx, kGapPx, std::max(10.0, width() - kLeftPx - kRightPx),
                std::max(10.0, height() - kAxisPx - 2 * kGapPx));
}

double TimelinePlot::x_of(double time_s) const {
  const QRectF all = area();
  return all.left() + all.width() * (duration_s_ > 0 ? time_s / duration_s_ : 0);
}

void TimelinePlot::draw_names(QPainter& painter, const QRectF& place, const QString& name,
                              double most, const QStringList& now) const {
  painter.setPen(palette().color(QPalette::Text));
  const double line = fontMetrics().height();
  painter.drawText(QRectF(4, place.top(), kLeftPx - 8, line), Qt::AlignLeft, name);
  painter.setPen(palette().color(QPalette::PlaceholderText));
  if (place.height() > 2 * line)
    painter.drawText(QRectF(4, place.top() + line, kLeftPx - 8, line), Qt::AlignLeft,
                     tr("max %1").arg(short_number(most)));
  double y = place.top();
  for (int i = 0; i < now.size(); ++i) {
    painter.setPen(run_colour(static_cast<std::size_t>(i)));
    if (now.size() == 2 && place.height() < 2 * line) {
      const double half = (kRightPx - 8) / 2;
      painter.drawText(QRectF(width() - kRightPx + 4 + half * i, y, half, line), Qt::AlignLeft,
                       now[i]);
      continue;
    }
    painter.drawText(QRectF(width() - kRightPx + 6, y, kRightPx - 8, line), Qt::AlignLeft, now[i]);
    y += line;
  }
}

void TimelinePlot::draw_row(QPainter& painter, const Row& row, const QRectF& place) const {
  double most = 1e-9;
  QStringList now;
  for (const FlightRun& run : runs_) {
    const std::vector<double>& values = row.values(run);
    most = std::max(most, max_of(values));
    now.push_back(short_number(values[frame_at(run.time_s, cursor_s_)]));
  }
  painter.fillRect(place, palette().color(QPalette::Base));
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const std::vector<double>& values = row.values(runs_[i]);
    QPainterPath line;
    bool drawing = false;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (!std::isfinite(values[k])) {
        drawing = false;
        continue;
      }
      const QPointF at(x_of(runs_[i].time_s[k]),
                       place.bottom() - 1 - (place.height() - 2) * values[k] / most);
      std::exchange(drawing, true) ? line.lineTo(at) : line.moveTo(at);
    }
    painter.setPen(QPen(run_colour(i), 1.2));
    painter.drawPath(line);
  }
  draw_names(painter, place, QString("%1, %2").arg(row.name, row.unit), most, now);
}

void TimelinePlot::draw_speed(QPainter& painter, const QRectF& place) const {
  painter.fillRect(place, palette().color(QPalette::Base));
  const double most = std::max(max_of(speed_m_s_), 1e-9);
  QPainterPath line;
  const auto steps = static_cast<double>(std::max<std::size_t>(speed_m_s_.size(), 2) - 1);
  for (std::size_t i = 0; i < speed_m_s_.size(); ++i) {
    const QPointF at(x_of(duration_s_ * static_cast<double>(i) / steps),
                     place.bottom() - 1 - (place.height() - 2) * speed_m_s_[i] / most);
    i == 0 ? line.moveTo(at) : line.lineTo(at);
  }
  painter.setPen(QPen(palette().color(QPalette::Text), 1.2));
  painter.drawPath(line);
  const auto at = static_cast<std::size_t>(
      std::clamp(std::round(steps * (duration_s_ > 0 ? cursor_s_ / duration_s_ : 0)), 0.0, steps));
  draw_names(painter, place, tr("camera, m/s"), most, {});
  painter.setPen(palette().color(QPalette::Text));
  painter.drawText(
      QRectF(width() - kRightPx + 6, place.top(), kRightPx - 8, fontMetrics().height()),
      Qt::AlignLeft, at < speed_m_s_.size() ? short_number(speed_m_s_[at]) : QString());
}

void TimelinePlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  if (duration_s_ <= 0) {
    painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap,
                     tr("Record a flight (Ctrl+Shift+R), or open a path."));
    return;
  }
  const QRectF all = area();
  const std::size_t count = runs_.empty() ? 1 : rows_.size() + 1;
  const double high =
      (all.height() - kGapPx * static_cast<double>(count - 1)) / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const QRectF place(all.left(), all.top() + static_cast<double>(i) * (high + kGapPx),
                       all.width(), high);
    i == 0 ? draw_speed(painter, place) : draw_row(painter, rows_[i - 1], place);
  }
  painter.setPen(palette().color(QPalette::PlaceholderText));
  const double step = axis_step(duration_s_);
  for (double t = 0; t <= duration_s_ * 1.0001; t += step) {
    painter.drawLine(QPointF(x_of(t), all.bottom()), QPointF(x_of(t), all.bottom() + 4));
    painter.drawText(QRectF(x_of(t) - 40, all.bottom() + 3, 80, kAxisPx), Qt::AlignHCenter,
                     QString::number(t) + " s");
  }
  painter.setPen(QPen(palette().color(QPalette::Text), 1));
  painter.drawLine(QPointF(x_of(cursor_s_), all.top()), QPointF(x_of(cursor_s_), all.bottom() + 4));
}

void TimelinePlot::drag(double x) {
  if (duration_s_ <= 0) return;
  const QRectF all = area();
  set_cursor(duration_s_ * (x - all.left()) / all.width());
  Q_EMIT dragged(cursor_s_);
}

void TimelinePlot::mousePressEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton) drag(event->position().x());
}

void TimelinePlot::mouseMoveEvent(QMouseEvent* event) {
  if ((event->buttons() & Qt::LeftButton) != 0) drag(event->position().x());
}

void TimelinePlot::keyPressEvent(QKeyEvent* event) {
  const int direction = event->key() == Qt::Key_Right ? 1 : event->key() == Qt::Key_Left ? -1 : 0;
  if (direction == 0 || duration_s_ <= 0) return QWidget::keyPressEvent(event);
  set_cursor(cursor_s_ + direction * kKeyStepS * (event->modifiers() & Qt::ShiftModifier ? 10 : 1));
  Q_EMIT dragged(cursor_s_);
}

}  // namespace psygen::editor
