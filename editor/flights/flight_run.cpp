#include "editor/flights/flight_run.hpp"

#include <fmt/format.h>

#include <QJsonDocument>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "editor/document/qt_text.hpp"
#include "engine/compare/csv_rows.hpp"
#include "engine/render/preset.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::editor {
namespace {

constexpr std::size_t kMaxRunBytes = std::size_t{1} << 30;
constexpr double kBusyWindowS = 0.25;
constexpr double kWallMargin = 1.5;  // factor of the budgets on the wall clock

constexpr std::string_view kRunColumns[] = {"time_s",           "frame_ms",
                                            "requests_queued",  "cache_bytes",
                                            "error_pixels",     "missing_pixels_percent",
                                            "synthesis_seconds"};

// A cell as a number; NaN for an empty one.
core::Result<double> value_in(std::string_view cell, const std::string& where,
                              std::string_view name) {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  return compare::number_in(cell, where, name);
}

// Percentage of the time that modelers are busy around each frame.
std::vector<double> busy_percent(const std::vector<double>& time_s,
                                 const std::vector<double>& made_s, double modelers) {
  std::vector<double> busy(time_s.size(), 0);
  double sum_s = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    sum_s += made_s[i];
    while (time_s[i] - time_s[first] > kBusyWindowS)
      sum_s -= made_s[first++];
    const double window_s = std::min(kBusyWindowS, std::max(time_s[i] - time_s[0], 1e-3));
    busy[i] = i == 0 ? 0 : std::clamp(100 * sum_s / (window_s * modelers), 0.0, 100.0);
  }
  return busy;
}

// A field of summary.json by its dotted name; NaN if it was not measured.
double summary_number(const QJsonObject& summary, const QString& field) {
  QJsonValue value = summary;
  for (const QString& part : field.split('.'))
    value = value.toObject().value(part);
  return value.isDouble() ? value.toDouble() : std::numeric_limits<double>::quiet_NaN();
}

// Rounds up to about three digits.
double rounded_up(double value) {
  if (!(value > 0)) return 0;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2);
  // The format removes rounding errors of the product.
  return std::max(value, std::stod(fmt::format("{:.6g}", std::ceil(value / unit - 1e-9) * unit)));
}

}  // namespace

QString settings_text(const FlightSettings& settings) {
  const std::string_view policy = synthesis::name_of(settings.policy);
  return QString("%1, %2, %3 MiB, %4 px, %5")
      .arg(settings.virtual_clock ? tr("virtual clock") : tr("wall clock"),
           settings.modelers == 0 ? tr("default worker threads")
                                  : tr("%1 worker threads").arg(settings.modelers))
      .arg(settings.budget_mib)
      .arg(settings.error_pixels)
      .arg(to_qstring(policy));
}

QStringList flight_arguments(const FlightSettings& settings, const std::filesystem::path& world,
                             const std::filesystem::path& path, const std::filesystem::path& out) {
  return {"fly",        "--headless",
          "--world",    to_qstring(world.string()),
          "--path",     to_qstring(path.string()),
          "--out",      to_qstring(out.string()),
          "--clock",    settings.virtual_clock ? "virtual" : "wall",
          "--modelers", QString::number(settings.modelers),
          "--budget",   QString("%1M").arg(settings.budget_mib),
          "--error",    QString::number(settings.error_pixels, 'g', 15),
          "--policy",   to_qstring(synthesis::name_of(settings.policy)),
          "--size",     QString("%1x%2").arg(settings.size.width).arg(settings.size.height),
          "--preset",   to_qstring(render::to_string(settings.preset)),
          "--warmup",   QString::number(settings.warmup_s, 'g', 15)};
}

core::Result<FlightRun> parse_flight_run(const std::string& frames_csv, const std::string& summary,
                                         const FlightSettings& settings) {
  FlightRun run;
  run.settings = settings;
  std::vector<double> made_s;
  std::vector<double>* const curves[] = {&run.time_s,    &run.frame_ms,     &run.queued,
                                         &run.cache_mib, &run.error_pixels, &run.missing_percent,
                                         &made_s};
  const auto row = [&](compare::CsvCells cells, const std::string& where) -> core::Result<void> {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto value = value_in(cells[i], where, kRunColumns[i]);
      if (!value) return tl::unexpected(value.error());
      curves[i]->push_back(*value);
    }
    const std::size_t last = run.time_s.size() - 1;
    if (std::isnan(run.time_s[last]) || (last > 0 && run.time_s[last] < run.time_s[last - 1]))
      return compare::refuse_file(where, "the clock goes backwards");
    return {};
  };
  if (auto ok = compare::read_csv(frames_csv, "frames.csv", kRunColumns, row); !ok)
    return tl::unexpected(ok.error());
  if (run.time_s.empty()) return compare::refuse_file("frames.csv", "it contains no frame");
  run.summary = QJsonDocument::fromJson(QByteArray::fromStdString(summary)).object();
  if (!run.summary["schema"].toString().startsWith("psygen.summary/1"))
    return compare::refuse_file("summary.json", "it is not a summary of a flight");
  const double modelers = summary_number(run.summary, "run.modelers");
  run.busy_percent = busy_percent(run.time_s, made_s, std::max(1.0, modelers));
  for (double& bytes : run.cache_mib)
    bytes /= 1 << 20;
  return run;
}

core::Result<FlightRun> read_flight_run(const std::filesystem::path& folder,
                                        const FlightSettings& settings) {
  const auto frames = world::read_text_file(folder / "frames.csv", kMaxRunBytes);
  if (!frames) return tl::unexpected(frames.error());
  const auto summary = world::read_text_file(folder / "summary.json");
  if (!summary) return tl::unexpected(summary.error());
  auto run = parse_flight_run(*frames, *summary, settings);
  if (!run) return core::fail(run.error().code, (folder / run.error().message).string());
  run->folder = folder;
  return run;
}

std::string frame_test_text(const FlightRun& run, const std::string& name, const std::string& world,
                            const std::string& path) {
  const FlightSettings& s = run.settings;
  std::string text = fmt::format(
      "# Made by psygen-editor. The budgets are the values of a run of this flight{}.\n"
      "format = 1\nname = {}\n\n[flight]\nworld = {}\npath = {}\nsize = [{}, {}]\nclock = {}\n"
      "modelers = {}\nbudget_mib = {}\nerror = {}\npolicy = {}\npreset = {}\nwarmup = {}\n",
      s.virtual_clock ? "" : ", times 1.5", world::toml_string(name), world::toml_string(world),
      world::toml_string(path), s.size.width, s.size.height,
      s.virtual_clock ? "\"virtual\"" : "\"wall\"", s.modelers, s.budget_mib,
      world::toml_number(s.error_pixels), world::toml_string(synthesis::name_of(s.policy)),
      world::toml_string(render::to_string(s.preset)), world::toml_number(s.warmup_s));
  const auto to = std::back_inserter(text);
  fmt::format_to(to, "\n[at_most]\n");
  const double margin = s.virtual_clock ? 1 : kWallMargin;
  constexpr const char* kBudgets[] = {"frame_ms.p50",
                                      "frame_ms.p99",
                                      "missing.pixels_max_percent",
                                      "missing.coarse_max_percent",
                                      "detail.max_pixels",
                                      "cache.peak_bytes"};
  for (const char* field : kBudgets) {
    const double value = summary_number(run.summary, field);
    if (std::isnan(value)) continue;
    // A factor does not raise 0, but on the wall clock another run may miss some pixels.
    const double least = s.virtual_clock || !QString(field).contains("percent") ? 0.0 : 1.0;
    fmt::format_to(to, "{} = {}\n", field,
                   world::toml_number(std::max(least, rounded_up(value * margin))));
  }
  std::string equal;
  const double holes = summary_number(run.summary, "missing.frames");
  if (s.virtual_clock && !std::isnan(holes))
    equal += fmt::format("missing.frames = {}\n", world::toml_number(holes));
  for (const char* field : {"world", "path"}) {
    const QJsonValue hash = run.summary["hash"].toObject()[field];
    if (hash.isString())
      equal +=
          fmt::format("hash.{} = {}\n", field, world::toml_string(hash.toString().toStdString()));
  }
  return equal.empty() ? text : text + "\n[equal]\n" + equal;
}

}  // namespace psygen::editor
