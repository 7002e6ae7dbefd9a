#include "editor/shell/default_world.hpp"

#include <QSettings>
#include <glm/trigonometric.hpp>
#include <utility>

#include "engine/core/camera.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {

core::CameraPose default_pose() {
  core::CameraPose pose;
  pose.position.local = {-1257, 0, 3978};
  pose.yaw = glm::radians(110.0);
  pose.pitch = glm::radians(-10.0);
  return pose;
}

CameraMemory::CameraMemory(const EditorContext& context)
    : QObject(&context.window),
      document_(context.document),
      view_(context.view),
      model_(context.model) {
  connect(&view_, &WorldView::opened, this, [this](const QString& error) {
    if (error.isEmpty()) restore();
  });
}

void CameraMemory::set_default_pose(const core::CameraPose& pose, double height_m) {
  default_pose_ = pose;
  default_pose_->position.local.y = height_m;
}

void CameraMemory::restore() {
  const QSettings settings;
  const QVariantList kept = settings.value("places/" + file_key(document_.file())).toList();
  if (kept.size() == 7) {
    core::CameraPose pose;
    pose.position.block = {kept[0].toInt(), kept[1].toInt()};
    pose.position.local = {kept[2].toDouble(), kept[3].toDouble(), kept[4].toDouble()};
    pose.yaw = kept[5].toDouble();
    pose.pitch = kept[6].toDouble();
    return view_.camera().set_pose(pose);
  }
  view_.focus();
  if (!default_pose_) return;
  core::CameraPose pose = *std::exchange(default_pose_, std::nullopt);
  const world::World& world = document_.world();
  pose.position = core::normalised(pose.position, world.block_size_m());
  pose.position.local.y += world::surface_height_m(world, pose.position);
  view_.camera().set_pose(pose);
}

void CameraMemory::save() {
  if (view_.session() == nullptr || document_.file().empty()) return;
  const core::CameraPose pose = model_.world_pose();
  QSettings().setValue(
      "places/" + file_key(document_.file()),
      QVariantList{pose.position.block.x, pose.position.block.z, pose.position.local.x,
                   pose.position.local.y, pose.position.local.z, pose.yaw, pose.pitch});
}

}  // namespace psygen::editor
