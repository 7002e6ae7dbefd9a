// How the editor looks: a light and a dark palette of one style, and the size of its text. Main
// thread.
#pragma once

#include <QString>

namespace psygen::editor {

// "light" or "dark"; others are dark.
void apply_theme(const QString& name);
// Percent of the system's text size, 50 to 300.
void apply_scale(int percent);

}  // namespace psygen::editor
