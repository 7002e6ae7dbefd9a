#include "editor/panels/cost_strip.hpp"

#include <QHelpEvent>
#include <QPainter>
#include <QPainterPath>
#include <QToolTip>
#include <algorithm>
#include <cmath>

#include "editor/document/qt_text.hpp"

namespace psygen::editor {
namespace {

constexpr double kSideMargin = 7;  // half of a slider's handle
const QColor kRejected(200, 60, 50, 70);
const QColor kMeasured(230, 150, 40);

}  // namespace

QString cost_text(const BlockCost& cost) {
  QString text = tr("%1 models, %2 triangles, %3, %4 ms per block")
                     .arg(count_text(cost.models), count_text(cost.triangles),
                          bytes_text(cost.bytes), kEnglish.toString(cost.seconds * 1e3, 'g', 3));
  if (cost.measured_seconds)
    text += tr(" (measured: %1 ms)").arg(kEnglish.toString(*cost.measured_seconds * 1e3, 'g', 3));
  return text;
}

CostStrip::CostStrip(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setAccessibleName(tr("Predicted cost of each value"));
}

void CostStrip::set_points(std::vector<CostPoint> points) {
  points_ = std::move(points);
  max_s_ = 0;
  for (const CostPoint& point : points_) {
    if (point.cost)
      max_s_ = std::max({max_s_, point.cost->seconds, point.cost->measured_seconds.value_or(0)});
  }
  update();
}

void CostStrip::set_value(double value) {
  value_ = value;
  update();
}

double CostStrip::x_of(std::size_t point) const {
  const double share =
      points_.size() > 1 ? static_cast<double>(point) / static_cast<double>(points_.size() - 1) : 0;
  return kSideMargin + share * (width() - 2 * kSideMargin);
}

double CostStrip::y_of(double seconds) const {
  return height() - 2 - (height() - 5) * (max_s_ > 0 ? seconds / max_s_ : 0);
}

std::size_t CostStrip::nearest(double value) const {
  const auto closer = [value](const CostPoint& a, const CostPoint& b) {
    return std::abs(a.value - value) < std::abs(b.value - value);
  };
  return static_cast<std::size_t>(std::ranges::min_element(points_, closer) - points_.begin());
}

void CostStrip::paintEvent(QPaintEvent*) {
  if (points_.empty()) return;
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double step = x_of(1) - x_of(0);
  QPainterPath line;
  bool drawing = false;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const CostPoint& point = points_[i];
    if (!point.cost) {
      painter.fillRect(QRectF(x_of(i) - step / 2, 0, step, height()), kRejected);
      drawing = false;
      continue;
    }
    const QPointF at(x_of(i), y_of(point.cost->seconds));
    std::exchange(drawing, true) ? line.lineTo(at) : line.moveTo(at);
  }
  painter.setPen(QPen(palette().color(QPalette::Highlight), 1.5));
  painter.drawPath(line);
  painter.setPen(Qt::NoPen);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const auto& cost = points_[i].cost;
    if (!cost || !cost->measured_seconds) continue;
    painter.setBrush(kMeasured);
    painter.drawEllipse(QPointF(x_of(i), y_of(*cost->measured_seconds)), 2, 2);
  }
  painter.setPen(QPen(palette().color(QPalette::Text), 1, Qt::DotLine));
  const double x = x_of(nearest(value_));
  painter.drawLine(QPointF(x, 0), QPointF(x, height()));
}

bool CostStrip::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip || points_.empty()) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  const double share = (help->pos().x() - kSideMargin) / std::max(width() - 2 * kSideMargin, 1.0);
  const auto at = static_cast<std::size_t>(
      std::lround(std::clamp(share, 0.0, 1.0) * static_cast<double>(points_.size() - 1)));
  const CostPoint& point = points_[at];
  const QString value = QLocale::c().toString(point.value, 'g', 4);
  const QString text = point.cost ? cost_text(*point.cost) : to_qstring(point.error);
  QToolTip::showText(help->globalPos(), value + ": " + text, this);
  return true;
}

}  // namespace psygen::editor
