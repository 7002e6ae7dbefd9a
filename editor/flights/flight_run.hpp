// A flight recorded by `psygen fly`, as curves over its time. Reads and checks the files of its
// folder; draws nothing. Any thread.
#pragma once

#include <QJsonObject>
#include <QString>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/surface_provider.hpp"
#include "engine/render/types.hpp"
#include "engine/synthesis/policy.hpp"

namespace psygen::editor {

// Options of a flight.
struct FlightSettings {
  bool virtual_clock = true;
  unsigned modelers = 0;  // 0: the default of the machine
  int budget_mib = 512;
  double error_pixels = 4;
  synthesis::Policy policy = synthesis::Policy::kDeadline;
  core::Extent size{640, 360};
  render::Preset preset = render::Preset::kLow;
  double warmup_s = 1;
  friend bool operator==(const FlightSettings&, const FlightSettings&) = default;
};

// Returns a text such as "virtual clock, 2 worker threads, 512 MiB, 4 px, deadline".
QString settings_text(const FlightSettings& settings);

// Each curve has one value per frame; NaN: unknown.
struct FlightRun {
  FlightSettings settings;
  std::filesystem::path folder;
  std::vector<double> time_s;
  std::vector<double> frame_ms, queued, busy_percent, cache_mib, error_pixels, missing_percent;
  QJsonObject summary;
};

// The arguments of `psygen` for a flight.
QStringList flight_arguments(const FlightSettings& settings, const std::filesystem::path& world,
                             const std::filesystem::path& path, const std::filesystem::path& out);

// Reads frames.csv and summary.json of a folder. Fails with kIo and kParse, naming file and line.
core::Result<FlightRun> read_flight_run(const std::filesystem::path& folder,
                                        const FlightSettings& settings);
// Like read_flight_run(), from texts in memory.
core::Result<FlightRun> parse_flight_run(const std::string& frames_csv, const std::string& summary,
                                         const FlightSettings& settings);

// Returns the text of a frame test (docs/frame-tests.md) whose budgets the run keeps. On the
// virtual clock the budgets are the run's values; on the wall clock, which varies, 1.5 times the
// values. `world` and `path` are file names for the test.
std::string frame_test_text(const FlightRun& run, const std::string& name, const std::string& world,
                            const std::string& path);

}  // namespace psygen::editor
