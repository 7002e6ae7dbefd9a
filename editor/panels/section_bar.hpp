// The heading above the fields of a section: its name, and buttons for commands that act on all
// fields. Main thread.
#pragma once

#include <QWidget>

#include "engine/world/files/world_schema.hpp"

class QLabel;
class QToolButton;

namespace psygen::editor {

// The reset button is enabled if the text sets a field, even to its default.
class SectionBar final : public QWidget {
  Q_OBJECT

 public:
  explicit SectionBar(QWidget* parent = nullptr);
  // Shows a section; null hides the bar, for a list of fields from several sections.
  void show(const world::WorldSection* section);

 Q_SIGNALS:
  // The user clicked a button.
  void copy_requested();
  void paste_requested();
  void randomise_requested();
  void reset_requested();

 private:
  QLabel* title_;
  QToolButton* reset_;
};

}  // namespace psygen::editor
