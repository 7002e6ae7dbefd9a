// The panel "Timeline": records flights of the view's camera, renders them again, and shows their
// costs over time. Moves the camera of the view; changes no document. Main thread.
#pragma once

#include <QElapsedTimer>
#include <QWidget>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "editor/flights/flight_process.hpp"
#include "engine/world/camera_path.hpp"

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSpinBox;

namespace psygen::editor {

class TimelinePlot;

// Functions that give the panel access to the rest of the editor.
struct TimelineHost {
  std::function<const world::World&()> world;
  std::function<std::string()> world_text;
  // The file of the world if it has the same text, else empty.
  std::function<std::filesystem::path()> saved_world;
  std::function<core::CameraPose()> pose;
  std::function<void(const core::CameraPose&)> set_pose;
  std::function<core::Extent()> size;
  std::function<render::Preset()> preset;
  std::filesystem::path folder;  // for recordings and runs
};

// One path, and at most two runs of it.
class TimelinePanel final : public QWidget {
  Q_OBJECT

 public:
  // The objects behind the host's functions outlive the panel.
  explicit TimelinePanel(TimelineHost host, QWidget* parent = nullptr);
  ~TimelinePanel() override;

  bool is_recording() const { return recording_.isValid(); }
  void set_recording(bool on);
  void play(bool on);
  void fly();
  void save_test();
  void save_path();
  void open_path();
  // Opens a path file; posts a message on failure.
  void open_path_file(const std::filesystem::path& file);
  // To be called after every frame of the view: records the camera, or moves it along the path.
  void on_frame_drawn();

 Q_SIGNALS:
  void message_posted(const QString& message);
  void recording_changed(bool on);
  // A flight in the background starts or stops to need the processors while the view is still.
  void needs_processors(bool on);

 private:
  void show_path(world::CameraPath path);
  void show_run(const FlightRun& run);
  void scrub(double time_s);
  void update_buttons();
  void update_legend();
  void show_progress();
  FlightSettings settings() const;
  core::Result<std::filesystem::path> write_world(const std::filesystem::path& folder) const;

  TimelineHost host_;
  FlightProcess process_;
  std::optional<world::CameraPath> path_;
  std::filesystem::path path_file_, world_file_;  // of the runs
  std::string run_world_;                         // world text of the runs
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
