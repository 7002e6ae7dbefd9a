// Files of the timeline: worlds, paths and frame tests.
#include <fmt/format.h>

#include <QFileDialog>
#include <algorithm>

#include "editor/document/qt_text.hpp"
#include "editor/flights/timeline_panel.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/world/files/path_file.hpp"
#include "engine/world/files/text_file.hpp"

namespace psygen::editor {
namespace {

bool has_pictures(const world::World& world) {
  return std::ranges::any_of(world.palette.images,
                             [](const std::string& name) { return !name.empty(); });
}

}  // namespace

// Writes the present world. It copies no ground images: a saved world uses its own file.
core::Result<std::filesystem::path> TimelinePanel::write_world(
    const std::filesystem::path& folder) const {
  if (auto saved = host_.saved_world(); !saved.empty()) return saved;
  const auto file = folder / "world.toml";
  if (auto ok = core::replace_file(file, host_.world_text()); !ok)
    return tl::unexpected(ok.error());
  return file;
}

void TimelinePanel::save_test() {
  if (runs_.empty() || !path_) return;
  QString file = QFileDialog::getSaveFileName(this, tr("Save as frame test"), "flight.toml",
                                              tr("Frame tests (*.toml)"));
  if (file.isEmpty()) return;
  if (!file.endsWith(".toml")) file += ".toml";
  const std::filesystem::path test = file.toStdString();
  const std::string stem = test.stem().string();
  const auto file_of = [&](const char* part) {
    return test.parent_path() / fmt::format("{}.{}.toml", stem, part);
  };
  core::Result<void> ok = core::replace_file(file_of("path"), world::write_camera_path(*path_));
  std::string world = file_of("world").filename().string();
  if (has_pictures(host_.world())) {
    world = world_file_.string();
  } else if (ok) {
    ok = core::replace_file(file_of("world"), run_world_);
  }
  if (ok) {
    ok = core::replace_file(
        test, frame_test_text(runs_.back(), stem, world, file_of("path").filename().string()));
  }
  Q_EMIT message_posted(
      ok ? tr("Saved %1 with its path and world. Run it with psygen test.").arg(file)
         : to_qstring(ok.error().message));
}

void TimelinePanel::save_path() {
  if (!path_) return;
  QString file = QFileDialog::getSaveFileName(this, tr("Save the path"), "path.toml",
                                              tr("Camera paths (*.toml)"));
  if (file.isEmpty()) return;
  if (!file.endsWith(".toml")) file += ".toml";
  const auto ok = core::replace_file(file.toStdString(), world::write_camera_path(*path_));
  Q_EMIT message_posted(ok ? tr("Saved %1.").arg(file) : to_qstring(ok.error().message));
}

void TimelinePanel::open_path() {
  const QString file =
      QFileDialog::getOpenFileName(this, tr("Open a path"), {}, tr("Camera paths (*.toml)"));
  if (!file.isEmpty()) open_path_file(file.toStdString());
}

void TimelinePanel::open_path_file(const std::filesystem::path& file) {
  auto path = world::load_camera_path(file);
  if (!path) return Q_EMIT message_posted(to_qstring(path.error().message));
  show_path(std::move(*path));
  scrub(0);
}

}  // namespace psygen::editor
