// Takes the pictures of the manual (docs/editor.md): goes through the panels of an open window as a
// person would and saves each as a JPEG. It edits the document and saves nothing of it. Main
// thread.
#pragma once

#include <QString>
#include <filesystem>

namespace psygen::editor {

class MainWindow;

// Writes NAME-THEME-WIDTH.jpg into a folder for each picture, or only for that of the window.
// Minutes. False, with a sentence on stderr, for what cannot be taken.
bool take_manual_pictures(MainWindow& window, const std::filesystem::path& folder,
                          const QString& theme, bool only_window);

}  // namespace psygen::editor
