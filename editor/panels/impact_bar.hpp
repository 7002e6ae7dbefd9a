// The impact of the last change, below the fields: the number of meshes to rebuild, the time and
// the memory. It also asks for confirmation of costly edits, without a dialog. Its height is
// constant, so that the fields keep their place. Main thread.
#pragma once

#include <QFrame>

class QLabel;
class QPushButton;

namespace psygen::editor {

// One text, and two buttons while it asks.
class ImpactBar final : public QFrame {
  Q_OBJECT

 public:
  // Shows a placeholder at first.
  explicit ImpactBar(QWidget* parent = nullptr);

  // Shows an impact, after the answer to the present question.
  void show_impact(const QString& impact);
  // Shows a question with its two buttons; an empty one hides the buttons again.
  void ask(const QString& question);
  bool asks() const { return asks_; }

 Q_SIGNALS:
  // The user's answer to the question.
  void apply_requested();
  void discard_requested();

 private:
  void update_widgets();

  QLabel* text_;
  QPushButton *apply_, *discard_;
  QString impact_, question_;
  bool asks_ = false;
};

}  // namespace psygen::editor
