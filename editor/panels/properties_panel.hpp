// The panel "Properties": an outline of the world's sections, the fields of the chosen section, and
// a search over all fields. It recreates its controls only when the sections change, so that a
// dragged slider stays under the pointer. Main thread.
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

// Knows no document: show() sets its sections.
class PropertiesPanel final : public QWidget {
  Q_OBJECT

 public:
  // Without sections at first.
  explicit PropertiesPanel(QWidget* parent = nullptr);

  void show(const std::vector<world::WorldSection>& sections);
  // Opens a section and scrolls to it.
  void go_to(const world::TextPath& section);
  // The fields with a control at present.
  std::vector<world::WorldField> shown_fields() const;
  // The chosen section.
  const world::TextPath& section() const { return chosen_; }
  // The control of a field; null if its section is not shown.
  FieldRow* row(const world::TextPath& path) const;
  // The impact of the last change, and the question before costly edits.
  ImpactBar& impact() { return *impact_; }

 Q_SIGNALS:
  // Requests of the fields (field_row.hpp).
  void change_requested(const world::TextPath& path, const std::string& toml);
  void reset_requested(const world::TextPath& path);
  void step_requested(const world::TextPath& path, int steps);
  void randomise_requested(const world::TextPath& path);
  void drag_began();
  void drag_ended();
  void field_focused(const world::TextPath& path);
  void lock_requested(const world::TextPath& path, bool locked);
  // A control was created.
  void row_created(psygen::editor::FieldRow* row);
  // Another section was chosen.
  void section_chosen(const world::TextPath& path);
  // The user asks for the context menu of a section; `at`: global position.
  void section_menu_requested(const world::TextPath& path, const QPoint& at);
  // Buttons above the fields, with the chosen section.
  void copy_requested(const world::TextPath& path);
  void paste_requested(const world::TextPath& path);
  void section_reset_requested(const world::TextPath& path);

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
