#include "editor/shell/view_container.hpp"

#include <QCoreApplication>
#include <QKeyEvent>
#include <QWidget>

#include "editor/view/world_view.hpp"

namespace psygen::editor {
namespace {

// Passes keys from the widget to the view, and focuses the widget when the user clicks the view.
// Ends with the view, because the widget may lose the focus while it deletes the view.
class KeyboardOfView final : public QObject {
 public:
  KeyboardOfView(WorldView& view, QWidget& container)
      : QObject(&view), view_(view), container_(container) {
    view.installEventFilter(this);
    container.installEventFilter(this);
  }

  bool eventFilter(QObject* watched, QEvent* event) override {
    if (watched == &view_) {
      if (event->type() == QEvent::MouseButtonPress) container_.setFocus(Qt::MouseFocusReason);
      return false;
    }
    switch (event->type()) {
      case QEvent::KeyPress:
      case QEvent::KeyRelease: {
        const int key = static_cast<QKeyEvent*>(event)->key();
        if (key == Qt::Key_Tab || key == Qt::Key_Backtab) return false;  // moves the focus
        QCoreApplication::sendEvent(&view_, event);
        return true;
      }
      case QEvent::FocusOut:
        QCoreApplication::sendEvent(&view_, event);
        return false;
      case QEvent::FocusIn:
        return true;  // Qt would activate the view, which Wayland cannot
      default:
        return false;
    }
  }

 private:
  WorldView& view_;
  QWidget& container_;
};

}  // namespace

QWidget* make_view_container(WorldView& view, QWidget* parent) {
  QWidget* container = QWidget::createWindowContainer(&view, parent);
  container->setFocusPolicy(Qt::StrongFocus);
  if (runs_on_wayland()) new KeyboardOfView(view, *container);
  return container;
}

}  // namespace psygen::editor
