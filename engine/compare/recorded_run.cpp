#include "engine/compare/recorded_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "engine/captures/capture.hpp"
#include "engine/compare/csv_rows.hpp"
#include "engine/core/read_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/telemetry/summary.hpp"

namespace psygen::compare {
namespace {

using Parsed = nlohmann::json;

// Columns that a comparison needs.
enum Column {
  kColumnTime,
  kColumnFrame,
  kColumnCpu,
  kColumnApart,
  kColumnError,
  kColumnHoles,
  kColumnMissing,
  kColumnCoarse,
  kColumns
};
constexpr std::array<std::string_view, kColumns> kNames = {"time_s",
                                                           "frame_ms",
                                                           "main_cpu_ms",
                                                           "apart",
                                                           "error_pixels",
                                                           "holes",
                                                           "missing_pixels_percent",
                                                           "too_coarse_percent"};

constexpr std::string_view kResolution = "resolution";

struct Sums {
  double missing = 0, coarse = 0, error = 0, holes = 0;
};

// Older runs have no such column, and full resolution.
core::Result<double> resolution_in(CsvCells cells, const std::string& where) {
  if (cells.size() == kColumns) return 1.0;
  const auto value = number_in(cells[kColumns], where, kResolution);
  if (value && !(*value > 0 && *value <= 1))
    return refuse_file(where, "resolution: it must be above 0 and at most 1");
  return value;
}

core::Result<void> add_row(CsvCells cells, const std::string& where, double warmup_s,
                           RecordedRun& run, Sums& sums) {
  std::array<double, kColumns> values{};
  for (const Column column :
       {kColumnTime, kColumnFrame, kColumnError, kColumnHoles, kColumnMissing, kColumnCoarse}) {
    const auto value = number_in(cells[column], where, kNames[column]);
    if (!value) return tl::unexpected(value.error());
    values[column] = *value;
  }
  if (!(values[kColumnFrame] > 0)) return refuse_file(where, "frame_ms: it must be above 0");
  const auto resolution = resolution_in(cells, where);
  if (!resolution) return tl::unexpected(resolution.error());
  if (!run.time_s.empty() && values[kColumnTime] < run.time_s.back())
    return refuse_file(where, fmt::format("time_s: the clock goes backwards, from {} to {}",
                                          run.time_s.back(), values[kColumnTime]));
  if (values[kColumnTime] < warmup_s) return {};
  // On the virtual clock the processor time is empty.
  run.virtual_clock = cells[kColumnCpu].empty();
  if (!run.virtual_clock) {
    const auto cpu = number_in(cells[kColumnCpu], where, kNames[kColumnCpu]);
    if (!cpu) return tl::unexpected(cpu.error());
    run.cpu_ms.push_back(*cpu);
  }
  run.time_s.push_back(values[kColumnTime]);
  run.frame_ms.push_back(values[kColumnFrame]);
  run.left_out.push_back(!cells[kColumnApart].empty());
  run.lacking.push_back(values[kColumnMissing] + values[kColumnCoarse]);
  // Errors are in pixels of the image; at a lower render scale they count for more.
  const double error = values[kColumnError] / *resolution;
  run.error.push_back(error);
  sums.missing += values[kColumnMissing];
  sums.coarse += values[kColumnCoarse];
  sums.error += error;
  sums.holes += values[kColumnHoles];
  return {};
}

void leave_out_suspended(RecordedRun& run) {
  const double limit = captures::suspended_limit_ms(run.frame_ms);
  for (std::size_t i = 0; i < run.frame_ms.size(); ++i) {
    if (run.virtual_clock || run.frame_ms[i] <= limit) continue;
    run.left_out[i] = true;
    ++run.suspended;
  }
}

core::Result<void> parse_frames(std::string_view text, double warmup_s, RecordedRun& run) {
  const std::string file = run.folder + "/frames.csv";
  Sums sums;
  const auto read = read_csv(
      text, file, kNames,
      [&](CsvCells cells, const std::string& where) {
        return add_row(cells, where, warmup_s, run, sums);
      },
      kResolution);
  if (!read) return read;
  if (!run.cpu_ms.empty() && run.cpu_ms.size() != run.frame_ms.size())
    return refuse_file(file, "main_cpu_ms: only some frames have it");
  if (run.frame_ms.empty()) return refuse_file(file, "no frames after the warm-up");
  const auto count = static_cast<double>(run.frame_ms.size());
  run.missing_percent = sums.missing / count;
  run.coarse_percent = sums.coarse / count;
  run.error_pixels = sums.error / count;
  run.holes = static_cast<std::uint64_t>(sums.holes);
  leave_out_suspended(run);
  return {};
}

// The member at a path ("hash.world") if it has a type that T accepts.
template <class T>
std::optional<T> member(const Parsed& json, const char* path) {
  const Parsed::json_pointer pointer(path);
  if (!json.contains(pointer)) return std::nullopt;
  const Parsed& value = json[pointer];
  if constexpr (std::is_same_v<T, std::string>) {
    if (!value.is_string()) return std::nullopt;
  } else {
    if (!value.is_number()) return std::nullopt;
  }
  return value.get<T>();
}

// "GCC 12.2.0" for a text, "1.5" for a number, "true" for a boolean; "unknown" if there is none.
std::string text_at(const Parsed& json, const char* path) {
  const Parsed::json_pointer pointer(path);
  if (!json.contains(pointer) || json[pointer].is_null()) return "unknown";
  const Parsed& value = json[pointer];
  if (value.is_string()) return core::shown(value.get<std::string>(), 200);
  return value.is_number_float() ? fmt::format("{:.3g}", value.get<double>()) : value.dump();
}

void add_conditions(const Parsed& json, RecordedRun& run) {
  const auto add = [&json](std::vector<NamedText>& to, const char* name, const char* path) {
    to.push_back({name, text_at(json, path)});
  };
  add(run.required, "world hash", "/hash/world");
  run.required.push_back({"size", fmt::format("{}x{}", run.width, run.height)});
  if (!run.virtual_clock) {
    add(run.required, "CPU", "/machine/cpu");
    add(run.required, "cores", "/machine/cores");
    add(run.required, "quota of cores", "/machine/quota_cores");
    add(run.required, "device", "/device/name");
    add(run.required, "driver", "/device/driver");
    add(run.required, "preset", "/run/preset");
  }
  add(run.shown, "revision", "/build/revision");
  add(run.shown, "no changed files", "/build/clean");
  add(run.shown, "compiler", "/build/compiler");
  add(run.shown, "build type", "/build/type");
  if (run.virtual_clock) return;
  add(run.shown, "load before", "/load/before");
  add(run.shown, "processors used by others", "/load/others_cores");
  add(run.shown, "stolen time in percent", "/load/steal_percent");
}

// Leaves out what no run writes.
std::vector<RecordedFigure> figures_in(const Parsed& json) {
  std::vector<RecordedFigure> figures;
  const auto found = json.find("figures");
  if (found == json.end() || !found->is_object()) return figures;
  for (const auto& [name, figure] : found->items()) {
    if (!figure.is_object()) continue;
    figures.push_back({core::shown(name, 100),
                       core::shown(member<std::string>(figure, "/unit").value_or(""), 100),
                       member<double>(figure, "/mean")});
  }
  return figures;
}

core::Result<Parsed> summary_in(std::string_view text, const std::string& folder) {
  const std::string file = folder + "/summary.json";
  Parsed json = Parsed::parse(text, nullptr, false);
  if (json.is_discarded()) return refuse_file(file, "it is not JSON, or is truncated");
  if (member<std::string>(json, "/schema") != std::string(telemetry::kSummarySchema))
    return refuse_file(file, fmt::format("schema: it must be \"{}\"", telemetry::kSummarySchema));
  return json;
}

// A run without frames and conditions.
RecordedRun run_in(const Parsed& json, const std::string& folder) {
  RecordedRun run;
  run.folder = folder;
  run.path_hash = member<std::string>(json, "/hash/path").value_or("");
  run.images_hash = member<std::string>(json, "/hash/images").value_or("");
  const auto count = [&json](const char* path, double most) {
    return static_cast<std::uint64_t>(
        std::clamp(member<double>(json, path).value_or(0), 0.0, most));
  };
  run.width = count("/run/width", 1e6);
  run.height = count("/run/height", 1e6);
  run.measured_frames = count("/run/measured_frames", 1e15);
  run.fixed_step = member<double>(json, "/run/fixed_step");
  run.figures = figures_in(json);
  return run;
}

// More than a flight of a day.
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30;

}  // namespace

core::Result<std::string> read_text(const std::filesystem::path& file) {
  return core::read_file(file, kMaxBytes).map([](const std::vector<std::uint8_t>& bytes) {
    return std::string(bytes.begin(), bytes.end());
  });
}

core::Result<RecordedRun> parse_run(std::string_view frames_csv, std::string_view summary_json,
                                    const std::string& folder) {
  const auto json = summary_in(summary_json, folder);
  if (!json) return tl::unexpected(json.error());
  RecordedRun run = run_in(*json, folder);
  const double warmup_s = member<double>(*json, "/run/warmup_seconds").value_or(0);
  if (auto ok = parse_frames(frames_csv, warmup_s, run); !ok) return tl::unexpected(ok.error());
  add_conditions(*json, run);
  return run;
}

core::Result<RecordedRun> parse_conditions(std::string_view summary_json, const std::string& folder,
                                           bool virtual_clock) {
  const auto json = summary_in(summary_json, folder);
  if (!json) return tl::unexpected(json.error());
  RecordedRun run = run_in(*json, folder);
  run.virtual_clock = virtual_clock;
  add_conditions(*json, run);
  return run;
}

core::Result<RunFiles> read_run_files(const std::filesystem::path& folder) {
  auto frames = read_text(folder / "frames.csv");
  if (!frames) return tl::unexpected(frames.error());
  auto summary = read_text(folder / "summary.json");
  if (!summary) return tl::unexpected(summary.error());
  return RunFiles{std::move(*frames), std::move(*summary)};
}

core::Result<RecordedRun> read_run(const std::filesystem::path& folder) {
  const auto files = read_run_files(folder);
  if (!files) return tl::unexpected(files.error());
  return parse_run(files->frames_csv, files->summary_json, folder.string());
}

core::Result<std::vector<RecordedRun>> read_runs(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::vector<fs::path> folders;
  if (fs::exists(folder / "frames.csv", error)) folders.push_back(folder);
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error))
    if (it->path().filename() == "frames.csv" && it->path().parent_path() != folder)
      folders.push_back(it->path().parent_path());
  std::ranges::sort(folders);
  if (folders.empty())
    return core::fail(core::ErrorCode::kIo,
                      folder.string() + ": the folder has no run (frames.csv)");
  std::vector<RecordedRun> runs;
  for (const fs::path& each : folders) {
    auto run = read_run(each);
    if (!run) return tl::unexpected(run.error());
    runs.push_back(std::move(*run));
  }
  return runs;
}

std::vector<bool> left_out_of(std::span<const RecordedRun> a, std::span<const RecordedRun> b) {
  std::vector<bool> left_out(a.front().left_out.size(), false);
  for (const auto runs : {a, b})
    for (const RecordedRun& run : runs)
      for (std::size_t k = 0; k < std::min(left_out.size(), run.left_out.size()); ++k)
        left_out[k] = left_out[k] || run.left_out[k];
  return left_out;
}

}  // namespace psygen::compare
