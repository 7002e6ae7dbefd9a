// The head of a section's fields: its name, and buttons for what can be done with all of them.
// Tells what is wanted. Main thread.
#pragma once

#include <QWidget>

#include "engine/world/files/world_schema.hpp"

class QLabel;
class QToolButton;

namespace psygen::editor {

class SectionBar final : public QWidget {
  Q_OBJECT

 public:
  explicit SectionBar(QWidget* parent = nullptr);
  // Null: fields of several sections are shown, and the bar is hidden.
  void show(const world::WorldSection* section);

 Q_SIGNALS:
  void copy();
  void paste();
  void dice();
  void reset();

 private:
  QLabel* title_;
  QToolButton* reset_;
};

}  // namespace psygen::editor
