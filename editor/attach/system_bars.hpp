// The times of systems as bars, one below the other: the mean, and a mark at the longest. Main
// thread.
#pragma once

#include <QString>
#include <QWidget>
#include <vector>

namespace psygen::editor {

class SystemBars final : public QWidget {
  Q_OBJECT

 public:
  struct Bar {
    QString name;
    double mean_ms = 0, longest_ms = 0;
    QString words;  // what the mouse says
  };
  explicit SystemBars(QWidget* parent = nullptr);
  void show_bars(std::vector<Bar> bars);
  QSize sizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;

 private:
  int row_height() const;
  std::vector<Bar> bars_;
};

}  // namespace psygen::editor
