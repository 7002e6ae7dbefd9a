#include "editor/flights/timeline_panel.hpp"

#include <fmt/format.h>

#include <QComboBox>
#include <QDateTime>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>
#include <QVBoxLayout>
#include <algorithm>
#include <glm/geometric.hpp>

#include "editor/document/qt_text.hpp"
#include "editor/flights/timeline_plot.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/render/renderer.hpp"
#include "engine/world/files/path_file.hpp"

namespace psygen::editor {
namespace {

constexpr double kSampleS = 0.1, kMinFlightS = 0.3;
constexpr std::size_t kSpeeds = 200;

// Speeds in m/s along a path, at even steps.
std::vector<double> speeds_of(const world::CameraPath& path, const world::World& world) {
  std::vector<double> speeds;
  const double step_s = path.duration_seconds() / static_cast<double>(kSpeeds);
  std::optional<core::CameraPose> before;
  for (std::size_t i = 0; i <= kSpeeds; ++i) {
    const core::CameraPose pose = path.pose_at(static_cast<double>(i) * step_s, world);
    if (before && step_s > 0) {
      const glm::dvec3 moved =
          core::offset_m(pose.position.block, before->position, world.block_size_m()) +
          pose.position.local;
      speeds.push_back(glm::length(moved) / step_s);
    }
    before = pose;
  }
  return speeds;
}

bool has_pictures(const world::World& world) {
  return std::ranges::any_of(world.palette.images,
                             [](const std::string& name) { return !name.empty(); });
}

}  // namespace

TimelinePanel::TimelinePanel(Document& document, WorldView& view, std::filesystem::path folder)
    : document_(document),
      view_(view),
      folder_(std::move(folder)),
      plot_(new TimelinePlot),
      record_(new QPushButton(tr("Record"))),
      play_(new QPushButton(tr("Play"))),
      fly_(new QPushButton(tr("Re-run"))),
      cancel_(new QPushButton(tr("Cancel"))),
      save_test_(new QPushButton(tr("Save as frame test …"))),
      save_path_(new QPushButton(tr("Save path …"))),
      open_(new QPushButton(tr("Open path …"))),
      clock_(new QComboBox),
      policy_(new QComboBox),
      modelers_(new QSpinBox),
      budget_(new QSpinBox),
      error_(new QDoubleSpinBox),
      legend_(new QLabel),
      state_(new QLabel) {
  record_->setCheckable(true);
  play_->setCheckable(true);
  clock_->addItems({tr("virtual clock"), tr("wall clock")});
  clock_->setAccessibleName(tr("Clock of the run"));
  clock_->setToolTip(
      tr("The virtual clock uses fixed costs, so the run is identical on every machine. The wall "
         "clock measures this machine."));
  for (const synthesis::Policy policy : synthesis::kAllPolicies) {
    const std::string_view name = synthesis::name_of(policy);
    policy_->addItem(to_qstring(name));
  }
  policy_->setCurrentText("deadline");
  policy_->setAccessibleName(tr("Order of synthesis"));
  modelers_->setRange(0, 256);
  modelers_->setSpecialValueText(tr("default"));
  modelers_->setAccessibleName(tr("Worker threads"));
  budget_->setRange(4, 1 << 16);
  budget_->setValue(512);
  budget_->setSuffix(" MiB");
  budget_->setAccessibleName(tr("Geometry budget"));
  error_->setRange(0.1, 1000);
  error_->setValue(4);
  error_->setDecimals(1);
  error_->setSuffix(" px");
  error_->setAccessibleName(tr("Allowed error"));
  legend_->setTextFormat(Qt::RichText);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(6, 4, 6, 4);
  auto* commands = new QHBoxLayout;
  for (QWidget* widget : std::initializer_list<QWidget*>{record_, play_, open_, save_path_})
    commands->addWidget(widget);
  commands->addSpacing(12);
  commands->addWidget(state_, 1);
  commands->addWidget(cancel_);
  commands->addWidget(save_test_);
  auto* with = new QHBoxLayout;
  with->addWidget(fly_);
  with->addWidget(new QLabel(tr("with")));
  with->addWidget(clock_);
  with->addWidget(new QLabel(tr("Worker threads:")));
  for (QWidget* widget : std::initializer_list<QWidget*>{modelers_, budget_, error_, policy_})
    with->addWidget(widget);
  with->addSpacing(12);
  with->addWidget(legend_, 1);
  layout->addLayout(commands);
  layout->addLayout(with);
  layout->addWidget(plot_, 1);
  connect(record_, &QPushButton::toggled, this, &TimelinePanel::set_recording);
  connect(play_, &QPushButton::toggled, this, &TimelinePanel::play);
  connect(fly_, &QPushButton::clicked, this, &TimelinePanel::fly);
  connect(cancel_, &QPushButton::clicked, &process_, &FlightProcess::cancel);
  connect(save_test_, &QPushButton::clicked, this, &TimelinePanel::save_test);
  connect(save_path_, &QPushButton::clicked, this, &TimelinePanel::save_path);
  connect(open_, &QPushButton::clicked, this, &TimelinePanel::open_path);
  connect(plot_, &TimelinePlot::dragged, this, [this](double time_s) {
    play_->setChecked(false);
    scrub(time_s);
  });
  connect(&view_, &WorldView::drawn, this, &TimelinePanel::on_frame_drawn);
  connect(&process_, &FlightProcess::flown, this, &TimelinePanel::show_run);
  connect(&process_, &FlightProcess::failed, this, [this](const QString& error) {
    state_->setText(error);
    Q_EMIT message_posted(error);
    update_buttons();
  });
  update_buttons();
}

void TimelinePanel::update_buttons() {
  const bool flying = process_.is_flying();
  play_->setEnabled(path_.has_value() && !is_recording());
  fly_->setEnabled(path_.has_value() && !flying && !is_recording());
  fly_->setText(runs_.empty() ? tr("Run") : tr("Re-run"));
  cancel_->setVisible(flying);
  save_test_->setEnabled(!runs_.empty() && !flying);
  save_path_->setEnabled(path_.has_value());
  open_->setEnabled(!is_recording() && !flying);
  record_->setEnabled(!flying);
  // The panel moves the camera itself while it plays.
  view_.set_background_work(BackgroundWork::kFlight, flying && !playing_.isValid());
  record_->setText(is_recording() ? tr("Stop") : tr("Record"));
}

void TimelinePanel::update_legend() {
  QStringList words;
  for (std::size_t i = 0; i < runs_.size(); ++i)
    words.push_back(QString("<font color=%1>■</font> %2")
                        .arg(run_colour(i).name(), settings_text(runs_[i].settings)));
  legend_->setText(words.join("<br>"));
}

void TimelinePanel::set_recording(bool on) {
  if (on == is_recording()) return;
  if (on && process_.is_flying()) {
    const QSignalBlocker quiet(record_);
    record_->setChecked(false);
    return Q_EMIT recording_changed(false);
  }
  play_->setChecked(false);
  const QSignalBlocker quiet(record_);
  record_->setChecked(on);
  if (on) {
    poses_.clear();
    recording_.start();
    state_->setText(tr("Recording. Fly the camera through the view."));
  } else {
    recording_.invalidate();
    if (poses_.size() < 2 || poses_.back().time_s - poses_.front().time_s < kMinFlightS) {
      state_->setText(tr("The recording was too short."));
    } else {
      const QString name = QDateTime::currentDateTime().toString("yyyy-MM-dd HH.mm.ss");
      show_path(world::recorded_path(name.toStdString(), poses_, document_.world()));
      fly();
    }
  }
  update_buttons();
  Q_EMIT recording_changed(on);
}

void TimelinePanel::show_progress() {
  state_->setText(tr("Rendering flight (%1 s long) … %2 s elapsed")
                      .arg(path_->duration_seconds(), 0, 'f', 1)
                      .arg(flying_.elapsed() / 1000));
}

void TimelinePanel::on_frame_drawn() {
  if (process_.is_flying() && path_) show_progress();
  if (is_recording()) {
    const double now_s = static_cast<double>(recording_.nsecsElapsed()) * 1e-9;
    if (!poses_.empty() && now_s < poses_.back().time_s + kSampleS) return;
    poses_.push_back({now_s, view_.camera().pose()});
    state_->setText(tr("Recording: %1 s. Press Ctrl+Shift+R to stop.").arg(now_s, 0, 'f', 1));
    if (poses_.size() == world::kMaxRecordedPoses) set_recording(false);
  }
  if (playing_.isValid() && path_) {
    const double now_s = play_from_s_ + static_cast<double>(playing_.nsecsElapsed()) * 1e-9;
    plot_->set_cursor(now_s);
    scrub(plot_->cursor());
    if (now_s >= path_->duration_seconds()) play_->setChecked(false);
  }
}

void TimelinePanel::play(bool on) {
  if (on != play_->isChecked()) return play_->setChecked(on);
  if (on && path_) {
    const bool at_end = plot_->cursor() >= path_->duration_seconds() - 1e-6;
    play_from_s_ = at_end ? 0 : plot_->cursor();
    playing_.start();
  } else {
    playing_.invalidate();
  }
  play_->setText(on ? tr("Stop playing") : tr("Play"));
  update_buttons();
}

void TimelinePanel::scrub(double time_s) {
  if (!path_) return;
  Q_EMIT pose_requested(path_->pose_at(time_s, document_.world()));
  if (!process_.is_flying() && !is_recording())
    state_->setText(
        tr("%1 s of %2 s").arg(time_s, 0, 'f', 2).arg(path_->duration_seconds(), 0, 'f', 1));
}

void TimelinePanel::show_path(world::CameraPath path) {
  path_ = std::move(path);
  runs_.clear();
  plot_->set_runs({});
  plot_->set_path(path_->duration_seconds(), speeds_of(*path_, document_.world()));
  plot_->set_cursor(0);
  update_legend();
  update_buttons();
}

FlightSettings TimelinePanel::settings() const {
  FlightSettings settings;
  settings.virtual_clock = clock_->currentIndex() == 0;
  settings.modelers = static_cast<unsigned>(modelers_->value());
  settings.budget_mib = budget_->value();
  settings.error_pixels = error_->value();
  settings.policy = synthesis::policy_from(policy_->currentText().toStdString())
                        .value_or(synthesis::Policy::kDeadline);
  if (app::Session* session = view_.session()) {
    settings.preset = session->renderer().preset();
    const core::Extent size = session->picture_size();
    if (size.width > 0 && size.height > 0) settings.size = size;
  }
  settings.warmup_s = path_ ? std::min(1.0, path_->duration_seconds() / 4) : 1.0;
  return settings;
}

void TimelinePanel::fly() {
  if (!path_ || process_.is_flying()) return;
  const QString time = QDateTime::currentDateTime().toString("yyyyMMdd-HHmmss");
  const auto folder = folder_ / fmt::format("{}-{}", time.toStdString(), ++number_);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const auto path_file = folder / "path.toml";
  auto written = core::replace_file(path_file, world::write_camera_path(*path_));
  const auto world_file = write_world(folder);
  if (written && !world_file) written = tl::unexpected(world_file.error());
  if (!written) return Q_EMIT message_posted(to_qstring(written.error().message));
  world_file_ = *world_file;
  run_world_ = document_.text();
  process_.fly(settings(), world_file_, path_file, folder / "run");
  flying_.start();
  show_progress();
  update_buttons();
}

void TimelinePanel::show_run(const FlightRun& run) {
  if (runs_.size() == 2) runs_.pop_back();
  runs_.push_back(run);
  plot_->set_runs(runs_);
  const double p50 = run.summary["frame_ms"].toObject()["p50"].toDouble();
  state_->setText(
      tr("%1 frames, median frame time %2 ms").arg(run.time_s.size()).arg(p50, 0, 'f', 2));
  update_legend();
  update_buttons();
}

// Writes the present world. It copies no ground images: a saved world uses its own file.
core::Result<std::filesystem::path> TimelinePanel::write_world(
    const std::filesystem::path& folder) const {
  if (!document_.is_modified() && !document_.file().empty()) return document_.file();
  const auto file = folder / "world.toml";
  return core::replace_file(file, document_.text()).map([&] { return file; });
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
  if (has_pictures(document_.world())) {
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
