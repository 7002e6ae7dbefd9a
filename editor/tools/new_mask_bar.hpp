// Where a new mask shall lie and how fine it shall be: a row of controls for a toolbar. It shows
// how many pixels come of it, or why it cannot be made. It makes nothing. Main thread.
#pragma once

#include <QWidget>

#include "editor/tools/new_mask.hpp"

class QComboBox;
class QDoubleSpinBox;
class QLabel;

namespace psygen::editor {

class NewMaskBar final : public QWidget {
  Q_OBJECT

 public:
  explicit NewMaskBar(QWidget* parent = nullptr);
  void show_plan(const NewMask& mask, const world::World& world);

 Q_SIGNALS:
  // The person changed a value.
  void edited(const psygen::editor::NewMask& mask);

 private:
  QDoubleSpinBox* add_metres(const QString& label, const QString& name, double least, double most,
                             int decimals);
  NewMask shown() const;

  QComboBox* where_;
  QDoubleSpinBox* side_;
  QDoubleSpinBox* pixel_;
  QLabel* pixels_;
};

}  // namespace psygen::editor
