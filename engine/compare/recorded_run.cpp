#include "engine/compare/recorded_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>

#include "engine/core/utf8.hpp"

namespace psygen::compare {
namespace {

using Parsed = nlohmann::json;

constexpr std::size_t kMostShownBytes = 40;

tl::unexpected<core::Error> refuse(const std::string& where, std::string_view sentence) {
  return core::fail(core::ErrorCode::kParse, core::shown(fmt::format("{}: {}", where, sentence)));
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

// The columns that a comparison needs.
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

struct Sums {
  double missing = 0, coarse = 0, error = 0, holes = 0;
};

core::Result<double> number_in(std::string_view cell, const std::string& where,
                               std::string_view name) {
  double value = 0;
  const auto parsed = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (parsed.ec == std::errc() && parsed.ptr == cell.data() + cell.size() && value >= 0 &&
      value < 1e15)
    return value;
  return refuse(where, fmt::format("{}: '{}' is not a number from 0 on", name,
                                   core::shown(cell, kMostShownBytes)));
}

core::Result<std::array<std::size_t, kColumns>> find_columns(std::string_view header,
                                                             const std::string& where) {
  const std::vector<std::string_view> names = cells_of(header);
  std::array<std::size_t, kColumns> columns{};
  for (std::size_t i = 0; i < kColumns; ++i) {
    const auto found = std::ranges::find(names, kNames[i]);
    if (found == names.end())
      return refuse(where, fmt::format("the column {} is missing", kNames[i]));
    columns[i] = static_cast<std::size_t>(found - names.begin());
  }
  return columns;
}

core::Result<void> add_row(std::span<const std::string_view> cells,
                           const std::array<std::size_t, kColumns>& columns,
                           const std::string& where, double warmup_s, RecordedRun& run,
                           Sums& sums) {
  std::array<double, kColumns> values{};
  for (const Column column :
       {kColumnTime, kColumnFrame, kColumnError, kColumnHoles, kColumnMissing, kColumnCoarse}) {
    const auto value = number_in(cells[columns[column]], where, kNames[column]);
    if (!value) return tl::unexpected(value.error());
    values[column] = *value;
  }
  if (!(values[kColumnFrame] > 0)) return refuse(where, "frame_ms: a frame takes time");
  if (!run.time_s.empty() && values[kColumnTime] < run.time_s.back())
    return refuse(where, fmt::format("time_s: the clock goes backwards, from {} to {}",
                                     run.time_s.back(), values[kColumnTime]));
  if (values[kColumnTime] < warmup_s) return {};
  run.virtual_clock = cells[columns[kColumnCpu]].empty();
  run.time_s.push_back(values[kColumnTime]);
  run.frame_ms.push_back(values[kColumnFrame]);
  run.left_out.push_back(!cells[columns[kColumnApart]].empty());
  run.lacking.push_back(values[kColumnMissing] + values[kColumnCoarse]);
  run.error.push_back(values[kColumnError]);
  sums.missing += values[kColumnMissing];
  sums.coarse += values[kColumnCoarse];
  sums.error += values[kColumnError];
  sums.holes += values[kColumnHoles];
  return {};
}

void leave_out_suspended(RecordedRun& run) {
  std::vector<double> sorted = run.frame_ms;
  std::ranges::nth_element(sorted, sorted.begin() + std::ssize(sorted) / 2);
  const double limit = std::max(kSuspendedMs, kSuspendedRatio * sorted[sorted.size() / 2]);
  for (std::size_t i = 0; i < run.frame_ms.size(); ++i) {
    if (run.virtual_clock || run.frame_ms[i] <= limit) continue;
    run.left_out[i] = true;
    ++run.suspended;
  }
}

core::Result<void> parse_frames(std::string_view text, double warmup_s, RecordedRun& run) {
  const std::string file = run.folder + "/frames.csv";
  if (!text.ends_with('\n')) return refuse(file, "the file is cut: its last line has no end");
  std::array<std::size_t, kColumns> columns{};
  std::size_t cells_in_header = 0, number = 0;
  Sums sums;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(line.size() + 1);
    const std::string where = fmt::format("{}:{}", file, ++number);
    const std::vector<std::string_view> cells = cells_of(line);
    if (number == 1) {
      const auto found = find_columns(line, where);
      if (!found) return tl::unexpected(found.error());
      columns = *found;
      cells_in_header = cells.size();
      continue;
    }
    if (cells.size() != cells_in_header)
      return refuse(where, fmt::format("the line has {} cells, and the header {}", cells.size(),
                                       cells_in_header));
    if (auto ok = add_row(cells, columns, where, warmup_s, run, sums); !ok) return ok;
  }
  if (run.frame_ms.empty()) return refuse(file, "no frame is left after the warm-up");
  const auto count = static_cast<double>(run.frame_ms.size());
  run.missing_percent = sums.missing / count;
  run.coarse_percent = sums.coarse / count;
  run.error_pixels = sums.error / count;
  run.holes = static_cast<std::uint64_t>(sums.holes);
  leave_out_suspended(run);
  return {};
}

// The member at a path ("hash.world") if it has the kind that T needs.
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

core::Result<std::string> read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream) return core::fail(core::ErrorCode::kIo, file.string() + ": cannot be read");
  return text;
}

}  // namespace

core::Result<RecordedRun> parse_run(std::string_view frames_csv, std::string_view summary_json,
                                    const std::string& folder) {
  const std::string file = folder + "/summary.json";
  const Parsed json = Parsed::parse(summary_json, nullptr, false);
  if (json.is_discarded()) return refuse(file, "it is not JSON, or is cut");
  if (member<std::string>(json, "/schema") != "psygen.summary/1")
    return refuse(file, "schema: it must be \"psygen.summary/1\"");
  RecordedRun run;
  run.folder = folder;
  run.world_hash = member<std::string>(json, "/hash/world").value_or("");
  run.images_hash = member<std::string>(json, "/hash/images").value_or("");
  const auto pixels = [&json](const char* path) {
    return static_cast<std::uint64_t>(std::clamp(member<double>(json, path).value_or(0), 0.0, 1e6));
  };
  run.width = pixels("/run/width");
  run.height = pixels("/run/height");
  run.fixed_step = member<double>(json, "/run/fixed_step");
  const double warmup_s = member<double>(json, "/run/warmup_seconds").value_or(0);
  if (auto ok = parse_frames(frames_csv, warmup_s, run); !ok) return tl::unexpected(ok.error());
  return run;
}

core::Result<RecordedRun> read_run(const std::filesystem::path& folder) {
  const auto frames = read_text(folder / "frames.csv");
  if (!frames) return tl::unexpected(frames.error());
  const auto summary = read_text(folder / "summary.json");
  if (!summary) return tl::unexpected(summary.error());
  return parse_run(*frames, *summary, folder.string());
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
                      folder.string() + ": there is no run in it (frames.csv)");
  std::vector<RecordedRun> runs;
  for (const fs::path& each : folders) {
    auto run = read_run(each);
    if (!run) return tl::unexpected(run.error());
    runs.push_back(std::move(*run));
  }
  return runs;
}

}  // namespace psygen::compare
