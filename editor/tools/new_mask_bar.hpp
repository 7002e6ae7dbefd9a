// The controls of a toolbar for the area and the resolution of a new mask. Shows the resulting
// image size, or the error. It makes no mask. Main thread.
#pragma once

#include <QWidget>

#include "editor/tools/new_mask.hpp"

class QComboBox;
class QDoubleSpinBox;
class QLabel;

namespace psygen::editor {

// Disables the side of a mask of the whole world.
class NewMaskBar final : public QWidget {
  Q_OBJECT

 public:
  explicit NewMaskBar(QWidget* parent = nullptr);
  // Shows the values of a mask, and its image size in the world.
  void show_plan(const NewMask& mask, const world::World& world);

 Q_SIGNALS:
  // The user changed a value.
  void edited(const psygen::editor::NewMask& mask);

 private:
  QDoubleSpinBox* add_metres(const QString& label, const QString& name);
  NewMask shown() const;

  QComboBox* area_;
  QDoubleSpinBox* side_;
  QDoubleSpinBox* pixel_;
  QLabel* pixels_;
};

}  // namespace psygen::editor
