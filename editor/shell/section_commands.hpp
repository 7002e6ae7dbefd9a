// Commands for sections of the world: the Edit and World menus, and the context menu of a section.
// They act on the section that is chosen in the properties. The objects of the context outlive the
// menus. Main thread.
#pragma once

#include <vector>

#include "editor/shell/command_palette.hpp"
#include "editor/shell/main_window.hpp"

namespace psygen::editor {

class LibraryPanel;

void add_section_commands(QMenu& edit_menu, const EditorContext& context);
// The library lists the presets that "Save section as preset" adds.
void add_world_commands(QMenu& world_menu, const EditorContext& context, LibraryPanel& library);
// Adds the context menu of a section, and opens the section of a model or ground that is picked.
void connect_sections(const EditorContext& context);
// One command per field of the world: it opens the field's section.
std::vector<CommandPalette::Command> field_commands(const EditorContext& context);

}  // namespace psygen::editor
