// All fields of the world: sections on top of each other, as the schema lists them, and a line to
// search in. Makes its controls anew only when the sections change, so that a dragged slider stays
// under the mouse. Main thread.
#pragma once

#include <QWidget>
#include <vector>

#include "engine/world/files/world_schema.hpp"

class QLineEdit;
class QScrollArea;
class QTreeWidget;
class QTreeWidgetItem;
class QVBoxLayout;

namespace psygen::editor {

class FieldRow;
class ImpactBar;
class SectionBar;

class PropertiesPanel final : public QWidget {
  Q_OBJECT

 public:
  explicit PropertiesPanel(QWidget* parent = nullptr);

  void show(const std::vector<world::WorldSection>& sections);
  // Opens a section and scrolls to it.
  void go_to(const world::TextPath& section);
  // The fields whose controls are shown.
  std::vector<world::WorldField> shown_fields() const;
  // The section that is chosen.
  const world::TextPath& section() const { return chosen_; }
  // The control of a field, null while its section is not shown.
  FieldRow* row(const world::TextPath& path) const;
  // What a change does to the world, and what is asked before.
  ImpactBar& impact() { return *impact_; }

 Q_SIGNALS:
  void wanted(const world::TextPath& path, const std::string& toml);
  void reset_wanted(const world::TextPath& path);
  void step_wanted(const world::TextPath& path, int steps);
  void dice_wanted(const world::TextPath& path);
  void drag_began();
  void drag_ended();
  void attended(const world::TextPath& path);
  void lock_wanted(const world::TextPath& path, bool locked);
  // A control was made.
  void row_made(psygen::editor::FieldRow* row);
  // The section whose fields are shown.
  void section_chosen(const world::TextPath& path);
  // From the menu of a section.
  void section_menu(const world::TextPath& path, const QPoint& at);
  // What the buttons over the fields are for, with the section that is chosen.
  void copy_wanted(const world::TextPath& path);
  void paste_wanted(const world::TextPath& path);
  void section_reset_wanted(const world::TextPath& path);

 private:
  bool same_shape(const std::vector<world::WorldSection>& sections) const;
  void list(const std::vector<world::WorldSection>& sections);
  QTreeWidgetItem* group_of(world::SectionKind kind);
  void add_item(const world::WorldSection& section, QTreeWidgetItem* parent);
  void mark(const std::vector<world::WorldSection>& sections);
  void show_section();
  void search(const QString& text);
  void add_row(const world::WorldField& field);
  const world::WorldSection* chosen() const;

  std::vector<world::WorldSection> sections_;
  world::TextPath chosen_;
  QLineEdit* search_;
  QTreeWidget* tree_;
  SectionBar* section_bar_;
  QScrollArea* scroll_;
  ImpactBar* impact_;
  QWidget* form_ = nullptr;
  QVBoxLayout* lines_ = nullptr;
  std::vector<FieldRow*> rows_;
};

}  // namespace psygen::editor
