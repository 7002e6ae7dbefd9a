// The panel "Timeline": records flights of the view's camera, renders them again, and shows their
// costs over time. Moves the camera of the view; changes no document. Main thread.
#pragma once

#include <QElapsedTimer>
#include <QWidget>
#include <filesystem>
#include <optional>
#include <vector>

#include "editor/document/document.hpp"
#include "editor/flights/flight_process.hpp"
#include "editor/view/world_view.hpp"
#include "engine/world/camera_path.hpp"

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSpinBox;

namespace psygen::editor {

class TimelinePlot;

// One path, and at most two runs of it.
class TimelinePanel final : public QWidget {
  Q_OBJECT

 public:
  // `folder`: for recordings and runs. Document and view outlive the panel.
  TimelinePanel(Document& document, WorldView& view, std::filesystem::path folder);

  bool is_recording() const { return recording_.isValid(); }
  void set_recording(bool on);
  void play(bool on);
  void fly();
  void save_test();
  void save_path();
  void open_path();
  // Opens a path file; posts a message on failure.
  void open_path_file(const std::filesystem::path& file);

 Q_SIGNALS:
  void message_posted(const QString& message);
  void recording_changed(bool on);
  // The view's camera should move to a pose of the path.
  void pose_requested(const psygen::core::CameraPose& pose);

 private:
  // Records the camera of a frame, or moves it along the path.
  void on_frame_drawn();
  void show_path(world::CameraPath path);
  void show_run(const FlightRun& run);
  void scrub(double time_s);
  void update_buttons();
  void update_legend();
  void show_progress();
  FlightSettings settings() const;
  core::Result<std::filesystem::path> write_world(const std::filesystem::path& folder) const;

  Document& document_;
  WorldView& view_;
  std::filesystem::path folder_;
  FlightProcess process_;
  std::optional<world::CameraPath> path_;
  std::filesystem::path world_file_;  // of the runs
  std::string run_world_;             // its text
  std::vector<FlightRun> runs_;
  QElapsedTimer recording_, playing_, flying_;
  std::vector<world::TimedPose> poses_;
  double play_from_s_ = 0;
  int number_ = 0;
  TimelinePlot* plot_;
  QPushButton *record_, *play_, *fly_, *cancel_, *save_test_, *save_path_, *open_;
  QComboBox *clock_, *policy_;
  QSpinBox *modelers_, *budget_;
  QDoubleSpinBox* error_;
  QLabel *legend_, *state_;
};

}  // namespace psygen::editor
