// Commands for sections and fields of the world: edits from the properties, the Edit and World
// menus, and the context menu of a section. Main thread.
#pragma once

#include <QObject>
#include <random>
#include <vector>

#include "editor/shell/command_palette.hpp"
#include "editor/shell/editor_context.hpp"

class QMenu;
class QPoint;

namespace psygen::editor {

class LibraryPanel;

// Commands of the menus act on the section that is chosen in the properties.
class SectionCommands final : public QObject {
  Q_OBJECT

 public:
  // The library lists the presets that "Save section as preset" adds.
  SectionCommands(const EditorContext& context, LibraryPanel& library);

  void add_to_edit_menu(QMenu& menu);
  void add_to_world_menu(QMenu& menu);
  // One command per field of the world: it opens the field's section.
  std::vector<CommandPalette::Command> field_commands();

 private:
  void connect_properties();
  void open_section_of_selection();
  void randomise(const world::TextPath& path);
  void copy(const world::TextPath& path);
  void paste(const world::TextPath& path);
  void reset(const world::TextPath& path);
  void duplicate(const world::TextPath& path);
  void remove(const world::TextPath& path);
  void move(const world::TextPath& path, int by);
  void save_preset();
  void apply_preset();
  void show_context_menu(const world::TextPath& path, const QPoint& at);

  QMainWindow& window_;
  Document& document_;
  WorldView& view_;
  PropertiesPanel& properties_;
  MessageLog& messages_;
  LibraryPanel& library_;
  std::mt19937_64 random_{std::random_device{}()};
};

}  // namespace psygen::editor
