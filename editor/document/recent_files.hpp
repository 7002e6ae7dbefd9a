// The worlds that were opened last, kept in the settings of the user. Main thread.
#pragma once

#include <QSettings>
#include <filesystem>
#include <vector>

namespace psygen::editor {

inline constexpr std::size_t kMaxRecentFiles = 12;

// The files, newest first. Files that are gone stay in the list: a disk may be back tomorrow.
std::vector<std::filesystem::path> recent_files(const QSettings& settings);
// Puts a file in front, once.
void note_recent_file(QSettings& settings, const std::filesystem::path& file);
// Takes a file out.
void forget_recent_file(QSettings& settings, const std::filesystem::path& file);

}  // namespace psygen::editor
