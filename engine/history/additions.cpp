#include "engine/history/additions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "engine/captures/capture.hpp"
#include "engine/compare/instructions.hpp"
#include "engine/compare/recorded_run.hpp"
#include "engine/compare/times.hpp"
#include "engine/core/nearest_word.hpp"
#include "engine/core/utf8.hpp"
#include "engine/history/figure_rules.hpp"
#include "engine/history/gate.hpp"
#include "engine/history/ranks.hpp"
#include "engine/telemetry/machine.hpp"
#include "engine/telemetry/statistics.hpp"

namespace psygen::history {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::array kFigures = {
    "load.cpu_seconds",  "load.instructions", "frame_ms.mean",
    "frame_ms.p50",      "frame_ms.p95",      "frame_ms.p99",
    "low1_fps",          "hitches",           "stutter_percent",
    "gpu_ms.p50",        "missing.frames",    "missing.pixels_max_percent",
    "detail.p50_pixels", "cache.peak_bytes",  "memory.peak_rss_bytes",
    "synthesis.models",  "synthesis.seconds", "draw.triangles_p50"};

// The member at a field's name ("frame_ms.p50"); null if there is none.
const Json* member(const Json& json, std::string_view field) {
  const Json* at = &json;
  while (!field.empty()) {
    const std::size_t point = std::min(field.find('.'), field.size());
    const std::string name(field.substr(0, point));
    if (!at->is_object() || !at->contains(name)) return nullptr;
    at = &(*at)[name];
    field.remove_prefix(std::min(point + 1, field.size()));
  }
  return at;
}

std::optional<double> number_at(const Json& json, std::string_view field) {
  const Json* value = member(json, field);
  if (value == nullptr || !value->is_number()) return std::nullopt;
  return value->get<double>();
}

std::string text_at(const Json& json, std::string_view field) {
  const Json* value = member(json, field);
  return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
}

// The conditions that comparable entries share; empty if the text is no summary.
std::string fingerprint_of(std::string_view summary_json, bool virtual_clock) {
  const auto run = compare::parse_conditions(summary_json, "", virtual_clock);
  if (!run) return "";
  std::vector<std::string> texts;
  for (const compare::NamedText& part : run->required)
    texts.push_back(fmt::format("{}: {}", part.name, part.text));
  if (!run->path_hash.empty()) texts.push_back("path: " + run->path_hash);
  if (run->fixed_step) texts.push_back(fmt::format("step: {} Hz", *run->fixed_step));
  return fmt::format("{}", fmt::join(texts, "; "));
}

// True if the times of the run are costs of the virtual clock.
bool is_virtual(const Json& json) {
  const Json* reasons = member(json, "reasons");
  if (reasons == nullptr || !reasons->is_object()) return false;
  return std::ranges::any_of(*reasons, [](const Json& reason) {
    return reason.is_string() && reason.get<std::string>() == "the clock is virtual";
  });
}

// Figures of the machine also under the virtual clock.
bool is_real(std::string_view field) {
  return field.starts_with("load.") || field.starts_with("memory.") ||
         field.starts_with("figures.") || field == "synthesis.seconds";
}

// Seconds of the reference load that fit a kind of figure: processor time of its three parts, or
// wall time of the part on all cores.
std::optional<double> reference_of(const Json& json, FigureKind kind) {
  if (kind == FigureKind::kWallTime) return number_at(json, "reference.pair.wall_s");
  if (kind != FigureKind::kProcessorTime) return std::nullopt;
  double sum = 0;
  for (const char* part :
       {"reference.arith.cpu_s", "reference.stream.cpu_s", "reference.pair.cpu_s"}) {
    const auto seconds = number_at(json, part);
    if (!seconds) return std::nullopt;
    sum += *seconds;
  }
  return sum;
}

core::Result<std::string> revision_of(const Json& json, const std::string& file) {
  std::string revision = text_at(json, "build.revision");
  if (revision.empty())
    return core::invalid_argument(file +
                                  ": the run does not tell the revision of its program: name it "
                                  "with --revision");
  const Json* clean = member(json, "build.clean");
  if (clean != nullptr && clean->is_boolean() && !clean->get<bool>()) revision += "-dirty";
  return revision;
}

// Builds the entries of one run.
class RunReader {
 public:
  RunReader(const Json& json, std::string_view text)
      : json_(json),
        virtual_(is_virtual(json)),
        machine_(fingerprint_of(text, false)),
        world_(fingerprint_of(text, true)) {}

  // Adds a field, whether or not it has a value. `unit` may be empty.
  void add(const std::string& field, std::string unit) {
    const bool real = !virtual_ || is_real(field);
    if (!real && (unit == "ms" || unit == "frames/s")) unit = std::string(kVirtual) + unit;
    Entry entry = common;
    entry.figure = field;
    entry.unit = std::move(unit);
    entry.value = number_at(json_, field);
    entry.reference = reference_of(json_, rule_of(entry.figure, entry.unit).kind);
    if (entry.reference && !(*entry.reference > 0)) entry.reference.reset();
    entry.fingerprint = real ? machine_ : world_;
    entries.push_back(std::move(entry));
  }

  // Figures of the game.
  void add_own() {
    const Json* figures = member(json_, "figures");
    if (figures == nullptr || !figures->is_object()) return;
    for (const auto& [name, figure] : figures->items()) {
      for (const char* part : {"mean", "p50", "p99"})
        if (figure.is_object() && figure.contains(part))
          add(fmt::format("figures.{}.{}", name, part), text_at(figure, "unit"));
    }
  }

  bool has(std::string_view field) const { return member(json_, field) != nullptr; }

  Entry common;  // what all entries share
  std::vector<Entry> entries;

 private:
  const Json& json_;
  bool virtual_;
  std::string machine_, world_;
};

// A folder that holds one of several runs of a test: run_2, run-03, 4.
bool is_run_folder(std::string name) {
  for (const std::string_view prefix : {"runs", "run", "retry"})
    if (name.starts_with(prefix)) {
      name.erase(0, prefix.size());
      break;
    }
  return std::ranges::all_of(name,
                             [](char c) { return (c >= '0' && c <= '9') || c == '_' || c == '-'; });
}

// The name of a test by the folder of its run, below the path that was given.
std::string test_of(const fs::path& given, const fs::path& folder) {
  std::error_code error;
  const fs::path root = fs::absolute(given, error).lexically_normal();
  const fs::path at = fs::absolute(folder, error).lexically_normal();
  fs::path relative = at.lexically_relative(root);
  if (relative == "." || relative.empty()) relative = fs::path();
  std::vector<std::string> names(relative.begin(), relative.end());
  std::erase_if(names, [](const std::string& name) { return name.empty() || is_run_folder(name); });
  if (!names.empty()) return fmt::format("{}", fmt::join(names, "/"));
  for (fs::path up = root; up.has_relative_path(); up = up.parent_path())
    if (const std::string name = up.filename().string(); !name.empty() && !is_run_folder(name))
      return name;
  return "run";
}

core::Result<RunFigures> read_summary(const fs::path& file, AddOptions options,
                                      const std::string& report) {
  const auto text = compare::read_text(file);
  if (!text) return tl::unexpected(text.error());
  auto run = parse_summary(*text, file.string(), options);
  if (!run) return run;
  for (Entry& entry : run->entries)
    entry.report = report;
  return run;
}

// Figures of a capture: times only.
core::Result<RunFigures> run_of(const captures::Capture& capture, const AddOptions& options) {
  if (options.test.empty() || options.revision.empty())
    return core::invalid_argument(capture.name +
                                  ": a capture tells neither its test nor its revision: name them "
                                  "with --test and --revision");
  Entry entry{.test = options.test,
              .unit = "ms",
              .revision = options.revision,
              .fingerprint = fmt::format("tool: {}; interval: {}; machine: {}", capture.tool,
                                         captures::phrase_of(capture.meaning),
                                         options.machine.empty() ? "unknown" : options.machine),
              .time = options.time,
              .report = capture.name};
  RunFigures run;
  const auto add = [&](const char* figure, const char* unit, const telemetry::Figure& value) {
    entry.figure = figure;
    entry.unit = unit;
    entry.value = value.value;
    run.entries.push_back(entry);
  };
  const std::span<const double> ms = capture.frame_ms;
  add("frame_ms.mean", "ms", telemetry::mean(ms));
  add("frame_ms.p50", "ms", telemetry::percentile(ms, 0.50));
  add("frame_ms.p95", "ms", telemetry::percentile(ms, 0.95));
  add("frame_ms.p99", "ms", telemetry::percentile(ms, 0.99));
  add("low1_fps", "frames/s", telemetry::low1_fps(ms));
  const auto hitches = telemetry::hitches(ms);
  add("hitches", "",
      hitches.has_value() ? telemetry::Figure(static_cast<double>(*hitches)) : telemetry::Figure());
  return run;
}

// The instructions of an output of callgrind. Counts depend on the CPU's features only.
core::Result<RunFigures> read_callgrind(const std::string& text, const fs::path& file,
                                        const AddOptions& options) {
  const auto count = compare::instructions_in(text, file.string());
  if (!count) return tl::unexpected(count.error());
  if (options.test.empty() || options.revision.empty())
    return core::invalid_argument(file.string() +
                                  ": an output of callgrind tells neither its test nor its "
                                  "revision: name them with --test and --revision");
  const std::string machine = options.machine.empty()
                                  ? telemetry::machine_facts().cpu.value.value_or("unknown")
                                  : options.machine;
  return RunFigures{{{.test = options.test,
                      .figure = "instructions",
                      .value = static_cast<double>(*count),
                      .revision = options.revision,
                      .fingerprint = fmt::format("counter: callgrind; CPU: {}", machine),
                      .time = options.time,
                      .report = file.string()}}};
}

core::Result<std::vector<RunFigures>> read_captures(const fs::path& path, const AddOptions& options,
                                                    std::vector<std::string>& notes) {
  const auto side = compare::read_times(path);
  if (!side) return tl::unexpected(side.error());
  std::vector<RunFigures> runs;
  for (const captures::Capture& capture : side->captures) {
    auto run = run_of(capture, options);
    if (!run) return tl::unexpected(run.error());
    for (const std::string& note : capture.notes)
      notes.push_back(fmt::format("{}: {}", capture.name, note));
    runs.push_back(std::move(*run));
  }
  notes.push_back(
      fmt::format("{}: a capture has times only, and no reference load", path.string()));
  for (const std::string& sentence : side->skipped)
    notes.push_back("skipped " + sentence);
  return runs;
}

core::Result<std::vector<RunFigures>> read_file(const fs::path& file, AddOptions options,
                                                std::vector<std::string>& notes) {
  const auto text = compare::read_text(file);
  if (!text) return tl::unexpected(text.error());
  if (text->starts_with("# callgrind format"))
    return read_callgrind(*text, file, options).map([](RunFigures run) {
      return std::vector{std::move(run)};
    });
  if (text->find("\"psygen.summary/") == std::string::npos)
    return read_captures(file, options, notes);
  const bool in_folder = file.filename() == "summary.json";
  if (options.test.empty())
    options.test =
        in_folder ? test_of(file.parent_path(), file.parent_path()) : file.stem().string();
  return read_summary(file, options, in_folder ? file.parent_path().string() : file.string())
      .map([](RunFigures run) { return std::vector{std::move(run)}; });
}

// Summaries and outputs of callgrind in a folder, at any depth.
core::Result<std::vector<fs::path>> files_of_runs(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name == "summary.json" || name.ends_with(".callgrind") || name.starts_with("callgrind.out"))
      files.push_back(it->path());
  }
  if (error)
    return core::fail(core::ErrorCode::kIo,
                      fmt::format("{}: {}", folder.string(), error.message()));
  std::ranges::sort(files);
  return files;
}

core::Result<std::vector<RunFigures>> read_path(const fs::path& path, const AddOptions& options,
                                                std::vector<std::string>& notes) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return read_file(path, options, notes);
  const auto files = files_of_runs(path);
  if (!files) return tl::unexpected(files.error());
  if (files->empty()) return read_captures(path, options, notes);
  std::vector<RunFigures> runs;
  for (const fs::path& file : *files) {
    AddOptions with_name = options;
    const bool is_summary = file.filename() == "summary.json";
    if (with_name.test.empty() && is_summary) with_name.test = test_of(path, file.parent_path());
    auto run = is_summary ? read_summary(file, with_name, file.parent_path().string())
                          : compare::read_text(file).and_then([&](const std::string& text) {
                              return read_callgrind(text, file, with_name);
                            });
    if (!run) return tl::unexpected(run.error());
    runs.push_back(std::move(*run));
  }
  return runs;
}

// The median of the values that are there.
std::optional<double> median_of(std::span<const Entry> runs, std::optional<double> Entry::*field) {
  std::vector<double> values;
  for (const Entry& run : runs)
    if (run.*field) values.push_back(*(run.*field));
  if (values.empty()) return std::nullopt;
  return median(values);
}

// One entry of all runs of a job that have a figure.
Entry joined(std::span<const Entry> runs, std::vector<std::string>& notes) {
  Entry entry = runs.front();
  entry.value = median_of(runs, &Entry::value);
  entry.reference = median_of(runs, &Entry::reference);
  entry.work = median_of(runs, &Entry::work);
  const auto missing = std::ranges::count_if(runs, [](const Entry& e) { return !e.value; });
  if (missing > 0 && missing < std::ssize(runs))
    notes.push_back(fmt::format("{}: {} has no value in {} of {} runs", entry.test, entry.figure,
                                missing, runs.size()));
  return entry;
}

void warn_of_work(const std::vector<Entry>& entries, std::vector<std::string>& notes) {
  double least = 0, most = 0;
  for (const Entry& entry : entries) {
    if (!entry.work) continue;
    least = least == 0 ? *entry.work : std::min(least, *entry.work);
    most = std::max(most, *entry.work);
  }
  if (most - least > kSameWork * most)
    notes.push_back(
        fmt::format("{}: the runs of one job made {:.0f} to {:.0f} models: use the "
                    "virtual clock or generators alone for a history",
                    entries.front().test, least, most));
}

}  // namespace

core::Result<RunFigures> parse_summary(std::string_view summary_json, const std::string& file,
                                       const AddOptions& options) {
  const Json json = Json::parse(summary_json, nullptr, false);
  if (json.is_discarded() || !json.is_object())
    return core::fail(core::ErrorCode::kParse, file + ": it is not JSON, or is truncated");
  if (text_at(json, "schema") != "psygen.summary/1")
    return core::fail(core::ErrorCode::kParse, file + ": schema: it must be \"psygen.summary/1\"");
  RunReader reader(json, summary_json);
  reader.common.test = options.test;
  reader.common.time = options.time;
  reader.common.work = number_at(json, "synthesis.models");
  reader.common.revision = options.revision;
  if (options.revision.empty()) {
    const auto revision = revision_of(json, file);
    if (!revision) return tl::unexpected(revision.error());
    reader.common.revision = *revision;
  }
  for (const char* field : kFigures)
    if (reader.has(field)) reader.add(field, unit_of(field));
  reader.add_own();
  for (const std::string& field : options.figures) {
    const Json* value = member(json, field);
    if (value == nullptr || !(value->is_number() || value->is_null()))
      return core::invalid_argument(
          fmt::format("{}: the run has no number '{}'", file, core::shown(field, 100)));
    const bool known = std::ranges::any_of(
        reader.entries, [&](const Entry& entry) { return entry.figure == field; });
    if (!known) reader.add(field, unit_of(field));
  }
  return RunFigures{std::move(reader.entries)};
}

core::Result<Additions> read_additions(std::span<const fs::path> paths, const AddOptions& options) {
  Additions additions;
  // By test, revision and all fingerprints of a run, in the order of the first run; then by figure.
  std::map<std::tuple<std::string, std::string, std::set<std::string>>, std::size_t> jobs;
  std::vector<std::vector<Entry>> entries_of_jobs;
  for (const fs::path& path : paths) {
    auto runs = read_path(path, options, additions.notes);
    if (!runs) return tl::unexpected(runs.error());
    additions.runs += runs->size();
    for (RunFigures& run : *runs) {
      if (run.entries.empty()) continue;
      const Entry& first = run.entries.front();
      std::set<std::string> fingerprints;
      for (const Entry& entry : run.entries)
        fingerprints.insert(entry.fingerprint);
      const auto [job, is_new] = jobs.try_emplace(
          {first.test, first.revision, std::move(fingerprints)}, entries_of_jobs.size());
      if (is_new) entries_of_jobs.emplace_back();
      std::ranges::move(run.entries, std::back_inserter(entries_of_jobs[job->second]));
    }
  }
  std::int64_t order = 0;
  for (std::vector<Entry>& entries : entries_of_jobs) {
    ++order;
    warn_of_work(entries, additions.notes);
    std::ranges::stable_sort(
        entries, {}, [](const Entry& e) { return std::tie(e.figure, e.unit, e.fingerprint); });
    for (std::size_t first = 0, end = 0; first < entries.size(); first = end) {
      while (end < entries.size() && entries[end].figure == entries[first].figure)
        ++end;
      Entry entry = joined(std::span(entries).subspan(first, end - first), additions.notes);
      entry.order = order;
      additions.entries.push_back(std::move(entry));
    }
  }
  return additions;
}

std::string fingerprint_difference(const std::string& one, const std::string& two) {
  const auto parts_of = [](std::string_view text) {
    std::vector<std::pair<std::string_view, std::string_view>> parts;
    while (!text.empty()) {
      const std::size_t end = std::min(text.find("; "), text.size());
      const std::string_view part = text.substr(0, end);
      const std::size_t colon = std::min(part.find(": "), part.size());
      parts.emplace_back(part.substr(0, colon), part.substr(std::min(colon + 2, part.size())));
      text.remove_prefix(std::min(end + 2, text.size()));
    }
    return parts;
  };
  std::vector<std::string> sentences;
  const auto others = parts_of(two);
  for (const auto& [name, text] : parts_of(one)) {
    const auto other = std::ranges::find(others, name, [](const auto& part) { return part.first; });
    if (other == others.end()) continue;
    if (other->second != text)
      sentences.push_back(fmt::format("different {}: {} and {}", name, text, other->second));
  }
  if (sentences.empty()) return fmt::format("{} and {}", one, two);
  return fmt::format("{}", fmt::join(sentences, ", "));
}

}  // namespace psygen::history
