#include "editor/gallery/picture_cell.hpp"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>

namespace psygen::editor {
namespace {

constexpr int kCellMargin = 4;

// The largest centred rectangle with this aspect ratio in another rectangle.
QRect fitted(QSize size, const QRect& into) {
  const QSize scaled = size.scaled(into.size(), Qt::KeepAspectRatio);
  return {into.center() - QPoint(scaled.width() / 2, scaled.height() / 2), scaled};
}

}  // namespace

PictureCell::PictureCell(QWidget* parent) : QWidget(parent) {
  setFocusPolicy(Qt::StrongFocus);
  setCursor(Qt::PointingHandCursor);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void PictureCell::set_caption(const QString& value, const QString& cost) {
  value_ = value;
  cost_ = cost;
  setAccessibleName(value + (cost.isEmpty() ? "" : ", " + cost));
  update();
}

void PictureCell::set_image(const QImage& image) {
  image_ = image;
  error_.clear();
  setToolTip({});
  update();
}

void PictureCell::set_error(const QString& error) {
  error_ = error;
  setToolTip(value_ + ": " + error);
  update();
}

void PictureCell::set_present(bool present) {
  if (std::exchange(present_, present) != present) update();
}

QRect PictureCell::picture_area() const {
  const int lines = fontMetrics().height() + kCellMargin;
  return rect().adjusted(kCellMargin, kCellMargin, -kCellMargin, -kCellMargin - lines);
}

void PictureCell::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  const QPalette& colours = palette();
  const bool light = hovered_ || hasFocus();
  if (present_ || light) {
    QColor colour = colours.color(QPalette::Highlight);
    if (!present_) colour.setAlpha(70);
    painter.fillRect(rect(), colour);
  }
  const QRect area = picture_area();
  if (image_.isNull()) {
    painter.fillRect(area, colours.color(QPalette::AlternateBase));
    painter.setPen(colours.color(QPalette::PlaceholderText));
    painter.drawText(area.adjusted(6, 4, -6, -4), Qt::AlignCenter | Qt::TextWordWrap,
                     error_.isEmpty() ? tr("…") : error_);
  } else {
    painter.drawImage(fitted(image_.size(), area), image_);
  }
  const QRect line(area.left(), area.bottom() + 1, area.width(), height() - area.bottom() - 2);
  painter.setPen(colours.color(present_ ? QPalette::HighlightedText : QPalette::WindowText));
  const int cost_width = cost_.isEmpty() ? 0 : fontMetrics().horizontalAdvance(cost_) + 6;
  painter.drawText(line.adjusted(2, 0, -cost_width, 0), Qt::AlignLeft | Qt::AlignVCenter,
                   fontMetrics().elidedText(value_, Qt::ElideRight, line.width() - cost_width));
  if (!present_) painter.setPen(colours.color(QPalette::PlaceholderText));
  painter.drawText(line.adjusted(0, 0, -2, 0), Qt::AlignRight | Qt::AlignVCenter, cost_);
}

void PictureCell::mouseReleaseEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton && rect().contains(event->pos())) Q_EMIT clicked();
}

void PictureCell::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Space) {
    Q_EMIT clicked();
  } else {
    QWidget::keyPressEvent(event);
  }
}

void PictureCell::enterEvent(QEnterEvent*) {
  hovered_ = true;
  update();
}

void PictureCell::leaveEvent(QEvent*) {
  hovered_ = false;
  update();
}

}  // namespace psygen::editor
