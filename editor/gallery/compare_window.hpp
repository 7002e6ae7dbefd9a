// Two states of the world in one picture, from where the view's camera stands: left of a line A,
// right of it B. The line is dragged with the mouse. Pictures follow the camera when it rests, and
// the text when it changes. Main thread.
#pragma once

#include <QImage>
#include <QTimer>
#include <QWidget>
#include <functional>
#include <optional>
#include <string>

#include "editor/gallery/view_state.hpp"

namespace psygen::editor {

class PictureService;

// One of the two states.
struct ComparedState {
  std::string text, file;
  QString name;  // "A, 14:02"
};
// A and B as they are now; nothing while there is no A.
using AskStates = std::function<std::optional<std::pair<ComparedState, ComparedState>>()>;

class CompareWindow final : public QWidget {
  Q_OBJECT

 public:
  CompareWindow(PictureService& service, AskView ask_view, AskStates ask_states,
                QWidget* parent = nullptr);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  struct Half {
    ComparedState state;
    QImage image;
    QString failure;
    bool awaited = false;
  };
  void follow();
  void ask(Half& half, const ViewState& view, int batch);
  void move_line(double x);

  PictureService& service_;
  AskView ask_view_;
  AskStates ask_states_;
  QTimer timer_;
  std::optional<ViewState> seen_, drawn_;  // the camera at the last look, and of the pictures
  Half halves_[2];
  double line_ = 0.5;
};

}  // namespace psygen::editor
