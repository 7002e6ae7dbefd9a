#include "editor/document/recent_files.hpp"

#include <QStringList>
#include <algorithm>

#include "editor/document/qt_text.hpp"

namespace psygen::editor {
namespace {

QString recent_key() {
  return QStringLiteral("recent_files");
}

QString whole_name(const std::filesystem::path& file) {
  std::error_code error;
  const auto whole = std::filesystem::absolute(file, error);
  return to_qstring((error ? file : whole.lexically_normal()).string());
}

}  // namespace

std::vector<std::filesystem::path> recent_files(const QSettings& settings) {
  std::vector<std::filesystem::path> files;
  for (const QString& name : settings.value(recent_key()).toStringList())
    files.emplace_back(name.toStdString());
  return files;
}

void note_recent_file(QSettings& settings, const std::filesystem::path& file) {
  QStringList names = settings.value(recent_key()).toStringList();
  names.removeAll(whole_name(file));
  names.prepend(whole_name(file));
  settings.setValue(recent_key(), names.mid(0, static_cast<qsizetype>(kMaxRecentFiles)));
}

}  // namespace psygen::editor
