#include "editor/shell/command_line.hpp"

#include <algorithm>
#include <glm/trigonometric.hpp>

#include "engine/app/session.hpp"
#include "engine/render/preset.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/settings.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {

QString picture_command(app::Session& session, const std::filesystem::path& world_file,
                        const core::CameraPose& pose) {
  const scene::Scene& scene = session.scene();
  const world::World& world = scene.world();
  const double block_m = world.block_size_m();
  const core::WorldPosition& at = pose.position;
  const double surface_m = world::surface_height_m(world, at);
  const render::Preset preset = session.renderer().preset();
  const std::string_view name = render::to_string(preset);
  QString file = QString::fromStdString(world_file.string());
  if (file.contains(' ')) file = "'" + file + "'";
  return QString(
             "psygen picture --world %1 --at=%2,%3 --height %4 --yaw %5 --pitch=%6 --preset %7 "
             "--error %8 --out picture.png")
      .arg(file)
      .arg(at.block.x * block_m + at.local.x, 0, 'f', 1)
      .arg(at.block.z * block_m + at.local.z, 0, 'f', 1)
      .arg(std::max(at.local.y - surface_m, 0.1), 0, 'f', 1)
      .arg(glm::degrees(pose.yaw), 0, 'f', 1)
      .arg(glm::degrees(pose.pitch), 0, 'f', 1)
      .arg(QString::fromUtf8(name.data(), static_cast<int>(name.size())))
      .arg(scene.settings().max_error_pixels, 0, 'g', 4);
}

}  // namespace psygen::editor
