// The camera's pose in a newly opened world: the pose of the last visit, else the world's home. The
// world that the editor opens without a file has a pose of its own. Main thread.
#pragma once

#include <QObject>

#include "editor/shell/main_window.hpp"

namespace psygen::editor {

// The world that the editor opens without a file: the valley of the README.
inline constexpr const char* kFirstWorld = "silver_combe";

// Keeps the pose of the last visit to each world file in QSettings.
class CameraMemory final : public QObject {
 public:
  // Restores the pose whenever the view opens a world.
  explicit CameraMemory(const EditorContext& context);

  // Gives the next opened world the pose for kFirstWorld, unless the user has visited it before.
  void use_first_pose() { use_first_pose_ = true; }
  // Keeps the present pose for the next visit.
  void save() const;

 private:
  void restore();

  const EditorContext context_;
  bool use_first_pose_ = false;
};

}  // namespace psygen::editor
