#include "editor/attach/system_bars.hpp"

#include <QHelpEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>

namespace psygen::editor {

SystemBars::SystemBars(QWidget* parent) : QWidget(parent) {
  setAccessibleName(tr("System times"));
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setToolTip(" ");
}

int SystemBars::row_height() const {
  return fontMetrics().height() + 3;
}

QSize SystemBars::sizeHint() const {
  return {240, row_height() * std::max(1, static_cast<int>(bars_.size())) + 4};
}

void SystemBars::show_bars(std::vector<Bar> bars) {
  const bool other = bars.size() != bars_.size();
  bars_ = std::move(bars);
  if (other) updateGeometry();
  update();
}

void SystemBars::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  double max_ms = 0.1;
  int name_width = 0;
  for (const Bar& bar : bars_) {
    max_ms = std::max(max_ms, bar.max_ms);
    name_width = std::max(name_width, fontMetrics().horizontalAdvance(bar.name));
  }
  const int number_width = fontMetrics().horizontalAdvance("00.00 ms ");
  const int left = name_width + 8, room = std::max(10, width() - left - number_width - 4);
  int y = 2;
  for (const Bar& bar : bars_) {
    const auto length = [&](double ms) { return static_cast<int>(room * ms / max_ms); };
    painter.setPen(palette().color(QPalette::Text));
    painter.drawText(2, y, name_width, row_height(), Qt::AlignVCenter, bar.name);
    painter.fillRect(left, y + 3, std::max(1, length(bar.mean_ms)), row_height() - 6,
                     palette().color(QPalette::Highlight));
    painter.fillRect(left + length(bar.max_ms), y + 3, 2, row_height() - 6, QColor(230, 150, 40));
    painter.drawText(left + room, y, number_width, row_height(), Qt::AlignVCenter | Qt::AlignRight,
                     tr("%1 ms").arg(bar.mean_ms, 0, 'f', 2));
    y += row_height();
  }
}

bool SystemBars::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  const auto row = static_cast<std::size_t>(std::max(0, help->pos().y() - 2) / row_height());
  QToolTip::showText(help->globalPos(), row < bars_.size() ? bars_[row].tool_tip : QString(), this);
  return true;
}

}  // namespace psygen::editor
