#include "editor/gallery/compare_window.hpp"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QSettings>
#include <algorithm>

#include "editor/document/qt_text.hpp"
#include "editor/pictures/picture_service.hpp"

namespace psygen::editor {
namespace {

constexpr int kCheckMs = 300;  // the camera rests if it has not moved since the last check
constexpr double kLineStep = 0.02;
constexpr const char* kCompareGeometryKey = "compare/geometry";

bool same_view(const ViewState& a, const ViewState& b) {
  return a.place.at_m == b.place.at_m && a.place.yaw == b.place.yaw &&
         a.place.pitch == b.place.pitch && a.now_s == b.now_s && a.size == b.size;
}

}  // namespace

CompareWindow::CompareWindow(PictureService& service, AskView ask_view, AskStates ask_states,
                             QWidget* parent)
    : QWidget(parent, Qt::Window),
      service_(service),
      ask_view_(std::move(ask_view)),
      ask_states_(std::move(ask_states)) {
  setObjectName("compare");
  setWindowTitle(tr("A and B"));
  setFocusPolicy(Qt::StrongFocus);
  setCursor(Qt::SplitHCursor);
  setAttribute(Qt::WA_OpaquePaintEvent);
  resize(760, 480);
  restoreGeometry(QSettings().value(kCompareGeometryKey).toByteArray());
  connect(&timer_, &QTimer::timeout, this, &CompareWindow::follow);
}

void CompareWindow::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  drawn_.reset();
  follow();
  timer_.start(kCheckMs);
}

void CompareWindow::hideEvent(QHideEvent* event) {
  timer_.stop();
  service_.cancel(this);
  QSettings().setValue(kCompareGeometryKey, saveGeometry());
  QWidget::hideEvent(event);
}

void CompareWindow::follow() {
  auto view = ask_view_();
  const auto states = ask_states_();
  if (!view || !states) return update();
  // The aspect ratio of the view, in the size of this window.
  const QSize size = QSize(static_cast<int>(view->size.width), static_cast<int>(view->size.height))
                         .scaled(this->size() * devicePixelRatioF(), Qt::KeepAspectRatio);
  view->size = {static_cast<std::uint32_t>(std::max(size.width(), 16)),
                static_cast<std::uint32_t>(std::max(size.height(), 16))};
  const bool rests = !seen_ || same_view(*seen_, *view);
  seen_ = view;
  if (!rests) return;
  const bool moved = !drawn_ || !same_view(*drawn_, *view);
  const ComparedState* const present[] = {&states->first, &states->second};
  bool changed = moved;
  for (int i = 0; i < 2; ++i) {
    changed = changed || halves_[i].state.text != present[i]->text;
    halves_[i].state.name = present[i]->name;
  }
  if (!changed) return;
  service_.cancel(this);
  const int batch = service_.new_batch();
  for (int i = 0; i < 2; ++i) {
    const bool stays =
        !moved && halves_[i].state.text == present[i]->text && !halves_[i].is_awaited;
    halves_[i].state = *present[i];
    if (!stays) ask(halves_[i], *view, batch);
  }
  drawn_ = view;
  update();
}

void CompareWindow::ask(Half& half, const ViewState& view, int batch) {
  PictureRequest request;
  request.text = half.state.text;
  request.file = half.state.file;
  request.size = view.size;
  request.place = view.place;
  request.now_s = view.now_s;
  half.is_awaited = true;
  service_.ask(std::move(request), batch, &half == halves_ ? 0 : 1, this,
               [this, &half](const PictureReply& reply) {
                 half.is_awaited = false;
                 half.error = to_qstring(reply.error);
                 if (reply.error.empty()) half.image = reply.image;
                 update();
               });
}

void CompareWindow::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.fillRect(rect(), palette().color(QPalette::Base));
  const int line = static_cast<int>(line_ * width());
  for (int i = 0; i < 2; ++i) {
    const Half& half = halves_[i];
    const QRect part =
        i == 0 ? QRect(0, 0, line, height()) : QRect(line, 0, width() - line, height());
    painter.setClipRect(part);
    if (!half.image.isNull()) {
      const QSize scaled = half.image.size().scaled(size(), Qt::KeepAspectRatio);
      painter.drawImage(
          QRect(QPoint((width() - scaled.width()) / 2, (height() - scaled.height()) / 2), scaled),
          half.image);
    }
    QString text = half.state.name;
    if (half.is_awaited) text += tr("  …");
    if (!half.error.isEmpty()) text += "  " + half.error;
    const QRect words = painter.fontMetrics().boundingRect(text).adjusted(-8, -4, 8, 4);
    const QRect at(i == 0 ? 8 : width() - words.width() - 8, 8, words.width(), words.height());
    painter.fillRect(at, QColor(0, 0, 0, 140));
    painter.setPen(Qt::white);
    painter.drawText(at, Qt::AlignCenter, text);
  }
  painter.setClipping(false);
  painter.fillRect(QRect(line - 1, 0, 2, height()), QColor(255, 255, 255, 200));
}

void CompareWindow::move_line(double x) {
  line_ = std::clamp(x, 0.0, 1.0);
  update();
}

void CompareWindow::mousePressEvent(QMouseEvent* event) {
  mouseMoveEvent(event);
}

void CompareWindow::mouseMoveEvent(QMouseEvent* event) {
  if ((event->buttons() & Qt::LeftButton) != 0)
    move_line(event->position().x() / std::max(width(), 1));
}

void CompareWindow::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Left) return move_line(line_ - kLineStep);
  if (event->key() == Qt::Key_Right) return move_line(line_ + kLineStep);
  if (event->key() == Qt::Key_Escape) return hide();
  QWidget::keyPressEvent(event);
}

}  // namespace psygen::editor
