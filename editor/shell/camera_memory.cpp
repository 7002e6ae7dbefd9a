#include "editor/shell/camera_memory.hpp"

#include <QSettings>
#include <glm/trigonometric.hpp>
#include <utility>

#include "engine/core/camera.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {
namespace {

constexpr double kEyeHeightM = 24;  // above the ground

core::CameraPose first_pose(const world::World& world) {
  core::CameraPose pose;
  pose.position = core::normalised({{}, {-1257, 0, 3978}}, world.block_size_m());
  pose.position.local.y = kEyeHeightM + world::surface_height_m(world, pose.position);
  pose.yaw = glm::radians(110.0);
  pose.pitch = glm::radians(-10.0);
  return pose;
}

}  // namespace

CameraMemory::CameraMemory(const EditorContext& context)
    : QObject(&context.window), context_(context) {
  connect(&context.view, &WorldView::opened, this, [this](const QString& error) {
    if (error.isEmpty()) restore();
  });
}

void CameraMemory::restore() {
  const bool first = std::exchange(use_first_pose_, false);
  const QSettings settings;
  const QVariantList kept = settings.value("places/" + file_key(context_.document.file())).toList();
  ViewCamera& camera = context_.view.camera();
  if (kept.size() == 7) {
    core::CameraPose pose;
    pose.position.block = {kept[0].toInt(), kept[1].toInt()};
    pose.position.local = {kept[2].toDouble(), kept[3].toDouble(), kept[4].toDouble()};
    pose.yaw = kept[5].toDouble();
    pose.pitch = kept[6].toDouble();
    return camera.set_pose(pose);
  }
  context_.view.focus();
  if (first) camera.set_pose(first_pose(context_.document.world()));
}

void CameraMemory::save() const {
  if (context_.view.session() == nullptr || context_.document.file().empty()) return;
  const core::CameraPose pose = context_.model.world_pose();
  QSettings().setValue(
      "places/" + file_key(context_.document.file()),
      QVariantList{pose.position.block.x, pose.position.block.z, pose.position.local.x,
                   pose.position.local.y, pose.position.local.z, pose.yaw, pose.pitch});
}

}  // namespace psygen::editor
