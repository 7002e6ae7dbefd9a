// The panel "Properties": an outline of the world's sections, the fields of the chosen section, and
// a search over all fields. It recreates its controls only when the sections change, so that a
// dragged slider stays under the pointer. Below the fields it shows the impact of the last change,
// or asks for confirmation of a costly edit. Main thread.
#pragma once

#include <QWidget>
#include <vector>

#include "editor/panels/field_row.hpp"

class QFrame;
class QLabel;
class QLineEdit;
class QPushButton;
class QScrollArea;
class QToolButton;
class QTreeWidget;
class QTreeWidgetItem;
class QVBoxLayout;

namespace psygen::editor {

// Edits the document; show() sets the sections that it shows.
class PropertiesPanel final : public QWidget {
  Q_OBJECT

 public:
  // Without sections at first.
  explicit PropertiesPanel(FieldHost host);

  void show(const std::vector<world::WorldSection>& sections);
  // Opens a section and scrolls to it.
  void go_to(const world::TextPath& section);
  // The fields with a control at present.
  std::vector<world::WorldField> shown_fields() const;
  // The chosen section.
  const world::TextPath& section() const { return chosen_; }
  // The control of a field; null if its section is not shown.
  FieldRow* row(const world::TextPath& path) const;
  // Shows the impact of the last change, after the answer to the present question.
  void show_impact(const QString& impact);

  // Act on the chosen section: random values, defaults, and its text in the clipboard.
  void randomise();
  void reset();
  void copy();
  void paste();

 Q_SIGNALS:
  // As FieldRow::field_focused().
  void field_focused(const world::TextPath& path);
  // Another section was chosen.
  void section_chosen(const world::TextPath& path);
  // The user asks for the context menu of the chosen section; `at`: global position.
  void section_menu_requested(const QPoint& at);

 private:
  QWidget* make_heading();
  QFrame* make_impact();
  void update_impact();
  void show_heading(const world::WorldSection* section);
  void list(const std::vector<world::WorldSection>& sections);
  QTreeWidgetItem* group_of(world::SectionKind kind);
  void add_item(const world::WorldSection& section, QTreeWidgetItem* parent);
  void mark(const std::vector<world::WorldSection>& sections);
  void search(const QString& text);
  void add_row(const world::WorldField& field);
  const world::WorldSection* chosen() const;

  FieldHost host_;
  std::vector<world::WorldSection> sections_;
  world::TextPath chosen_;
  QLineEdit* search_;
  QTreeWidget* tree_;
  QWidget* heading_;  // above the fields: the title of the section, and buttons
  QLabel* title_;
  QToolButton* reset_;
  QScrollArea* scroll_;
  QFrame* impact_;  // below the fields
  QLabel* impact_label_;
  QPushButton *apply_, *discard_;  // answers to a question
  QString impact_text_;
  QVBoxLayout* lines_ = nullptr;
  std::vector<FieldRow*> rows_;
};

}  // namespace psygen::editor
