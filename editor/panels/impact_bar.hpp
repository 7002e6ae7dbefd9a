// What the last change does to the world, below the fields: how many meshes change and how long
// that takes. Where a value is costly it asks, without a window in the way. It keeps its height, so
// nothing jumps. Main thread.
#pragma once

#include <QFrame>

class QLabel;
class QPushButton;

namespace psygen::editor {

class ImpactBar final : public QFrame {
  Q_OBJECT

 public:
  explicit ImpactBar(QWidget* parent = nullptr);

  // Shows an impact, unless something is asked.
  void show_impact(const QString& sentence);
  // Asks, until another sentence comes; empty: no more.
  void ask(const QString& sentence);
  bool asks() const { return asks_; }

 Q_SIGNALS:
  void apply_wanted();
  void keep_wanted();

 private:
  void fit();

  QLabel* text_;
  QPushButton *apply_, *keep_;
  QString impact_, question_;
  bool asks_ = false;
};

}  // namespace psygen::editor
