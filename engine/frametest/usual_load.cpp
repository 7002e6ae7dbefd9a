#include "engine/frametest/usual_load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "engine/core/replace_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/world/files/text_file.hpp"

namespace psygen::frametest {
namespace {

using Json = nlohmann::ordered_json;
using telemetry::Figure;
using Run = UsualLoadFile::Run;

constexpr const char* kSchema = "psygen.usual/1";

Json json_of(const Figure& figure) {
  return figure.has_value() ? Json(*figure) : Json(nullptr);
}

// A positive number or null; nothing for other values.
std::optional<Figure> figure_in(const Json& line, const char* key) {
  if (!line.contains(key)) return std::nullopt;
  if (line[key].is_null()) return Figure::missing("it was not measured");
  if (!line[key].is_number()) return std::nullopt;
  const double value = line[key].get<double>();
  return std::isfinite(value) && value > 0 ? std::optional<Figure>(value) : std::nullopt;
}

std::optional<Run> run_in(std::string_view text) {
  const Json line = Json::parse(text, nullptr, false);
  if (!line.is_object() || line.value("schema", Json()) != kSchema) return std::nullopt;
  for (const char* key : {"machine", "test"})
    if (!line.contains(key) || !line[key].is_string()) return std::nullopt;
  const auto pair_s = figure_in(line, "pair_s"), cpu_s = figure_in(line, "cpu_s");
  if (!pair_s || !cpu_s) return std::nullopt;
  return Run{line["machine"].get<std::string>(), line["test"].get<std::string>(), *pair_s, *cpu_s};
}

// The value at a fraction of the last values, if there are enough.
Figure usual_of(std::vector<double> values, double fraction) {
  if (values.size() < UsualLoadFile::kFewestRuns)
    return Figure::missing(
        fmt::format("only {} of {} runs are recorded", values.size(), UsualLoadFile::kFewestRuns));
  if (values.size() > UsualLoadFile::kMaxRuns)
    values.erase(values.begin(), values.end() - UsualLoadFile::kMaxRuns);
  return telemetry::percentile(values, fraction);
}

}  // namespace

std::string machine_name(const telemetry::MachineFacts& machine) {
  std::string name = fmt::format("{}, {} core{}", machine.cpu.value.value_or("unknown processor"),
                                 machine.cores, machine.cores == 1 ? "" : "s");
  if (machine.quota_cores.has_value()) name += fmt::format(", quota {:g}", *machine.quota_cores);
  return core::shown(name);
}

core::Result<UsualLoadFile> UsualLoadFile::parse(std::string_view text, const std::string& name) {
  UsualLoadFile file;
  for (int number = 1; !text.empty(); ++number) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.empty()) continue;
    auto run = run_in(line);
    if (!run)
      return core::fail(core::ErrorCode::kParse,
                        fmt::format("{}:{}: this is no run of {}; remove the line, or the file to "
                                    "begin again",
                                    name, number, kSchema));
    file.runs_.push_back(std::move(*run));
  }
  return file;
}

core::Result<UsualLoadFile> UsualLoadFile::load(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error) && !error) return UsualLoadFile();
  return world::read_text_file(file, kMaxBytes).and_then([&](const std::string& text) {
    return parse(text, file.string());
  });
}

UsualLoad UsualLoadFile::usual(const std::string& machine, const std::string& test) const {
  std::vector<double> pair_s, cpu_s;
  for (const Run& run : runs_) {
    if (run.machine != machine) continue;
    if (run.pair_s.has_value()) pair_s.push_back(*run.pair_s);
    if (run.test == test && run.cpu_s.has_value()) cpu_s.push_back(*run.cpu_s);
  }
  return {usual_of(std::move(pair_s), 0.25), usual_of(std::move(cpu_s), 0.5), "the recorded runs"};
}

void UsualLoadFile::add(Run run) {
  const auto same = [&run](const Run& other) {
    return other.machine == run.machine && other.test == run.test;
  };
  if (static_cast<std::size_t>(std::ranges::count_if(runs_, same)) >= kMaxRuns)
    runs_.erase(std::ranges::find_if(runs_, same));
  runs_.push_back(std::move(run));
}

std::string UsualLoadFile::text() const {
  std::string text;
  for (const Run& run : runs_) {
    const Json line = {{"schema", kSchema},
                       {"machine", run.machine},
                       {"test", run.test},
                       {"pair_s", json_of(run.pair_s)},
                       {"cpu_s", json_of(run.cpu_s)}};
    text += line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  }
  return text;
}

core::Result<void> UsualLoadFile::save(const std::filesystem::path& file) const {
  std::string all = text();
  if (all.size() > kMaxBytes)  // load() refuses larger files: the oldest runs are forgotten
    all.erase(0, all.find('\n', all.size() - kMaxBytes - 1) + 1);
  return core::replace_file(file, all);
}

}  // namespace psygen::frametest
