// Compares two states of the world in one image, from the view's camera: A left of a line, B right
// of it. The user drags the line. Renders new images when the camera rests at another pose and when
// a text changes. Main thread.
#pragma once

#include <QImage>
#include <QTimer>
#include <QWidget>
#include <functional>
#include <optional>
#include <string>

#include "editor/pictures/picture_request.hpp"

namespace psygen::editor {

class PictureService;

// One of the two states.
struct ComparedState {
  std::string text, file;
  QString name;  // "A, 14:02"
};
// Returns the present A and B; nullopt while there is no A.
using AskStates = std::function<std::optional<std::pair<ComparedState, ComparedState>>()>;

// The window "A and B".
class CompareWindow final : public QWidget {
  Q_OBJECT

 public:
  // The service outlives the window.
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
    QString error;
    bool is_awaited = false;
  };
  void follow();
  void ask(Half& half, const ViewState& view, int batch);
  void move_line(double x);

  PictureService& service_;
  AskView ask_view_;
  AskStates ask_states_;
  QTimer timer_;
  std::optional<ViewState> seen_, drawn_;  // at the last check, and of the images
  Half halves_[2];
  double line_ = 0.5;
};

}  // namespace psygen::editor
