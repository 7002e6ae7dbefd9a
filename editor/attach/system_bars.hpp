// System times as bars: the mean, and a mark at the maximum. Main thread.
#pragma once

#include <QString>
#include <QWidget>
#include <vector>

namespace psygen::editor {

// One bar per system, in the given order.
class SystemBars final : public QWidget {
  Q_OBJECT

 public:
  // Times of one system per frame.
  struct Bar {
    QString name;
    double mean_ms = 0, max_ms = 0;
    QString tool_tip = {};
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
