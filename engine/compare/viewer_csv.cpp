#include "engine/compare/viewer_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <vector>

#include "engine/compare/csv_rows.hpp"
#include "engine/compare/recorded_run.hpp"

namespace psygen::compare {
namespace {

// Columns of frames.csv that viewers show.
enum ViewerColumn { kFrameMs, kPresentMs, kGpuMs, kCacheBytes, kApart, kUsed };
constexpr std::array<std::string_view, kUsed> kUsedNames = {"frame_ms", "present_ms", "gpu_ms",
                                                            "cache_bytes", "apart"};

struct ViewerRow {
  double frame_ms = 0, present_ms = 0, gpu_ms = 0, cache_bytes = 0;
  bool drawn = true;
  double end_s = 0;  // sum up to and including this frame
};

struct ViewerRun {
  std::string device, driver, world;
  std::vector<ViewerRow> rows;
};

core::Result<ViewerRow> row_of(CsvCells cells, const std::string& where) {
  std::array<double, kApart> values{};
  for (std::size_t i = 0; i < kApart; ++i) {
    if (cells[i].empty() && i != kFrameMs) continue;  // unknown
    const auto value = number_in(cells[i], where, kUsedNames[i]);
    if (!value) return tl::unexpected(value.error());
    values[i] = *value;
  }
  if (!(values[kFrameMs] > 0)) return refuse_file(where, "frame_ms: it must be above 0");
  return ViewerRow{values[kFrameMs], values[kPresentMs], values[kGpuMs], values[kCacheBytes],
                   cells[kApart] != "not_drawn"};
}

// A name as one cell: viewers parse these formats without quotes, and spreadsheets take cells that
// begin with an operator for formulas.
std::string cell_of(const nlohmann::json& json, const char* path) {
  const nlohmann::json::json_pointer pointer(path);
  if (!json.contains(pointer) || !json[pointer].is_string()) return {};
  std::string text = json[pointer].get<std::string>();
  std::ranges::replace_if(
      text, [](char c) { return c == ',' || c == '"' || static_cast<unsigned char>(c) < ' '; },
      ' ');
  const std::size_t first = text.find_first_not_of(' ');
  if (first != std::string::npos &&
      std::string_view("=+-@").find(text[first]) != std::string_view::npos)
    text.insert(0, "'");
  return text;
}

core::Result<ViewerRun> run_of(std::string_view frames_csv, std::string_view summary_json,
                               const std::string& folder) {
  const auto json = nlohmann::json::parse(summary_json, nullptr, false);
  if (json.is_discarded())
    return refuse_file(folder + "/summary.json", "it is not JSON, or is truncated");
  ViewerRun run{cell_of(json, "/device/name"),
                cell_of(json, "/device/driver"),
                cell_of(json, "/world/name"),
                {}};
  const auto read =
      read_csv(frames_csv, folder + "/frames.csv", kUsedNames,
               [&run](CsvCells cells, const std::string& where) {
                 return row_of(cells, where).map([&run](ViewerRow row) {
                   row.end_s = (run.rows.empty() ? 0 : run.rows.back().end_s) + row.frame_ms * 1e-3;
                   run.rows.push_back(row);
                 });
               });
  if (!read) return tl::unexpected(read.error());
  return run;
}

// Two lines about the system, then the frames: fps, ms, percent, GiB, ns.
std::string mangohud_of(const ViewerRun& run) {
  constexpr double kGiB = 1 << 30;
  std::string text = fmt::format(
      "os,cpu,gpu,ram,kernel,driver,cpuscheduler\n,,{},,,{},\n"
      "fps,frametime,cpu_load,cpu_power,gpu_load,cpu_temp,gpu_temp,gpu_core_clock,gpu_mem_clock,"
      "gpu_vram_used,gpu_power,ram_used,swap_used,process_rss,cpu_mhz,elapsed\n",
      run.device, run.driver);
  for (const ViewerRow& row : run.rows)
    text += fmt::format("{:.4f},{:.4f},0,0,{:.0f},0,0,0,0,{:.4f},0,0,0,0,0,{:.0f}\n",
                        1000 / row.frame_ms, row.frame_ms,
                        std::min(100.0, 100 * row.gpu_ms / row.frame_ms), row.cache_bytes / kGiB,
                        row.end_s * 1e9);
  return text;
}

std::string capframex_of(const ViewerRun& run) {
  std::string text =
      "Application,ProcessID,SwapChainAddress,Runtime,SyncInterval,PresentFlags,Dropped,"
      "TimeInSeconds,MsInPresentAPI,MsBetweenPresents,AllowsTearing,PresentMode,"
      "MsUntilRenderComplete,MsUntilDisplayed,MsBetweenDisplayChange,GPU,Comment\n";
  for (const ViewerRow& row : run.rows)
    text +=
        fmt::format("psygen,0,0x0,Vulkan,0,0,{},{:.6f},{:.4f},{:.4f},0,Other,0,0,{:.4f},{},{}\n",
                    row.drawn ? 0 : 1, row.end_s, row.present_ms, row.frame_ms,
                    row.drawn ? row.frame_ms : 0, run.device, run.world);
  return text;
}

}  // namespace

core::Result<std::string> viewer_csv(std::string_view viewer, std::string_view frames_csv,
                                     std::string_view summary_json, const std::string& folder) {
  const auto run = run_of(frames_csv, summary_json, folder);
  if (!run) return tl::unexpected(run.error());
  if (viewer == kViewers[0]) return mangohud_of(*run);
  if (viewer == kViewers[1]) return capframex_of(*run);
  return core::invalid_argument(fmt::format("there is no viewer '{}'", viewer));
}

core::Result<std::string> viewer_csv(std::string_view viewer, const std::filesystem::path& folder) {
  return read_run_files(folder).and_then([&](const RunFiles& files) {
    return viewer_csv(viewer, files.frames_csv, files.summary_json, folder.string());
  });
}

}  // namespace psygen::compare
