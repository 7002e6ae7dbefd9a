// The look of the editor: a light and a dark palette of one style, and the size of its text. Main
// thread.
#pragma once

#include <QString>

class QMenu;

namespace psygen::editor {

// "light" or "dark"; other names are dark.
void apply_theme(const QString& name);
// Percent of the system's text size, 50 to 300.
void apply_scale(int percent);
// Applies the theme and the size of text that the user has chosen last.
void apply_saved_look();
// Adds menus that change both, and keep the choice in QSettings.
void add_theme_menus(QMenu& menu);

}  // namespace psygen::editor
