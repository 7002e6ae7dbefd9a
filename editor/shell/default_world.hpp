// The camera's pose in a newly opened world: the pose of the last visit, else the default pose.
// Also the world that the editor opens without a file: the valley of the README. Main thread.
#pragma once

#include <QObject>
#include <optional>

#include "editor/shell/editor_context.hpp"

namespace psygen::editor {

inline constexpr const char* kDefaultWorld = "silver_combe";
inline constexpr double kDefaultEyeHeightM = 24;  // above the ground
// The camera's pose in the default world; its height is not valid.
core::CameraPose default_pose();

// Keeps the pose of the last visit to each world file in QSettings.
class CameraMemory final : public QObject {
  Q_OBJECT

 public:
  // Restores the pose whenever the view opens a world.
  explicit CameraMemory(const EditorContext& context);

  // Replaces the pose that the next opened world gets, unless the user has visited it before. Its
  // height counts above the ground.
  void set_default_pose(const core::CameraPose& pose, double height_m);
  // Keeps the present pose for the next visit.
  void save();

 private:
  void restore();

  Document& document_;
  WorldView& view_;
  ModelView& model_;
  std::optional<core::CameraPose> default_pose_;
};

}  // namespace psygen::editor
