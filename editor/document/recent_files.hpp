// Recently opened worlds, kept in the settings of the user. Main thread.
#pragma once

#include <QSettings>
#include <filesystem>
#include <vector>

namespace psygen::editor {

inline constexpr std::size_t kMaxRecentFiles = 12;

// The files, newest first. Missing files stay in the list, because a disk may be mounted again.
std::vector<std::filesystem::path> recent_files(const QSettings& settings);
// Puts a file at the front; it is in the list only once.
void note_recent_file(QSettings& settings, const std::filesystem::path& file);

}  // namespace psygen::editor
