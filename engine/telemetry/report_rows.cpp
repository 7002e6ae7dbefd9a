// Rows of report.html: the frames that they represent, and the details of one frame.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/telemetry/report_parts.hpp"

namespace psygen::telemetry {
namespace {

constexpr std::size_t kMaxRows = 20'000;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Excluded frames come last.
double slowness(const FrameRecord& record) {
  return record.apart == Apart::kNo ? record.frame_ms : -1;
}

// The field of each row's frame.
template <class Field>
std::vector<double> column(const FrameLog& log, const ShownFrames& shown, const Field& field) {
  std::vector<double> values;
  for (const std::size_t frame : shown.frames)
    values.push_back(static_cast<double>(field(log.frames()[frame])));
  return values;
}

std::vector<RowFigure> figures(const FrameLog& log, const ShownFrames& shown) {
  std::vector<RowFigure> list;
  const auto add = [&](const char* name, const char* unit, const auto& field) {
    list.push_back({name, unit, column(log, shown, field)});
  };
  add("processor time of the main thread", "ms", [](const auto& r) { return r.main_cpu_ms; });
  add("shadows on the GPU", "ms",
      [](const auto& r) { return r.gpu_shadows_ms.value_or(kUnknown); });
  add("triangles", "", [](const auto& r) { return r.triangles; });
  add("draws", "", [](const auto& r) { return r.draws; });
  add("nodes in view", "", [](const auto& r) { return r.nodes_in_view; });
  add("models synthesised", "", [](const auto& r) { return r.models_synthesised; });
  add("requests queued", "", [](const auto& r) { return r.requests_queued; });
  add("requests rejected for lack of memory", "", [](const auto& r) { return r.requests_refused; });
  add("evicted from the cache", "", [](const auto& r) { return r.cache_evictions; });
  return list;
}

std::vector<RowFigure> parts(const FrameLog& log, const ShownFrames& shown) {
  std::vector<RowFigure> list;
  for (std::size_t i = 0; i < log.systems().size(); ++i) {
    std::vector<double> ms;
    for (const std::size_t frame : shown.frames)
      ms.push_back(double{log.system_ms(frame)[i]});
    list.push_back({log.systems()[i], "ms", std::move(ms)});
  }
  list.push_back({"waiting for the GPU", "ms",
                  column(log, shown, [](const auto& r) { return r.device_wait_ms; })});
  list.push_back({"presenting, waiting for the window", "ms",
                  column(log, shown, [](const auto& r) { return r.acquire_ms + r.present_ms; })});
  return list;
}

}  // namespace

ShownFrames shown_frames(const FrameLog& log) {
  const auto frames = log.frames();
  ShownFrames shown;
  shown.every = (frames.size() + kMaxRows - 1) / kMaxRows;
  for (std::size_t first = 0; first < frames.size(); first += shown.every) {
    const auto group = frames.subspan(first, std::min(shown.every, frames.size() - first));
    shown.frames.push_back(
        first +
        static_cast<std::size_t>(std::ranges::max_element(group, {}, slowness) - group.begin()));
  }
  return shown;
}

void thin(Plot& plot, const ShownFrames& shown) {
  if (shown.every <= 1) return;
  for (PlotSeries& series : plot.series) {
    std::vector<double> values;
    for (std::size_t row = 0; row < shown.frames.size(); ++row) {
      double value = series.values[shown.frames[row]];
      const std::size_t end = std::min((row + 1) * shown.every, series.values.size());
      for (std::size_t k = row * shown.every; k < end && plot.kind == PlotKind::kPeaks; ++k)
        value = std::fmax(value, series.values[k]);
      values.push_back(value);
    }
    series.values = std::move(values);
  }
}

PageRows page_rows(const FrameLog& log, const Summary& summary, const ShownFrames& shown) {
  PageRows rows;
  rows.every = std::max<std::size_t>(shown.every, 1);
  rows.times_s = column(log, shown, [](const auto& r) { return r.time_s; });
  rows.numbers = column(log, shown, [](const auto& r) { return r.index; });
  rows.warmup_s = summary.run.warmup_seconds;
  rows.figures = figures(log, shown);
  rows.parts = parts(log, shown);
  for (std::size_t row = 0; row < shown.frames.size(); ++row) {
    const FrameRecord& record = log.frames()[shown.frames[row]];
    if (record.apart != Apart::kNo) rows.apart[row] = name_of(record.apart);
    if (record.has_picture) rows.pictures[row] = picture_name(record.index);
  }
  return rows;
}

}  // namespace psygen::telemetry
