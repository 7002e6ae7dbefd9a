// Commands of the view: selection, debug views, a model alone, the grid, saving its image, and
// help. Without a session of the view, commands that need its scene do nothing or show a message.
// The objects of the context outlive the menus. Main thread.
#pragma once

#include "editor/shell/main_window.hpp"

namespace psygen::editor {

void add_image_commands(QMenu& file_menu, const EditorContext& context);
void add_view_commands(QMenu& view_menu, const EditorContext& context);
// `paused`: synthesis is paused at first.
void add_pause_command(QMenu& world_menu, const EditorContext& context, bool paused);
void add_help_commands(QMenu& help_menu, const EditorContext& context);

}  // namespace psygen::editor
