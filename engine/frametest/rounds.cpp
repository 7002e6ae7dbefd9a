#include "engine/frametest/rounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "engine/app/flight.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::frametest {
namespace {

constexpr std::string_view kRunPrefix = "run-";

bool is_relative(const Budget& budget) {
  return budget.of_base.has_value();
}

// Removes what an earlier flight left in a folder, except images and files of others.
void remove_outputs(const std::filesystem::path& folder) {
  std::error_code ignored;
  remove_failure(folder);
  for (const char* name : app::kFlightFiles)
    std::filesystem::remove(folder / name, ignored);
}

bool is_run_folder(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with(kRunPrefix) && name.size() > kRunPrefix.size() &&
         std::ranges::all_of(name.substr(kRunPrefix.size()),
                             [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

core::Result<std::optional<Base>> base_for(FrameTest& test, const RunOptions& options) {
  const std::filesystem::path& dir = options.base.empty() ? test.base : options.base;
  const auto relative = std::ranges::find_if(test.budgets, is_relative);
  const bool needed = relative != test.budgets.end();
  if (dir.empty()) {
    if (!needed) return std::nullopt;
    return core::invalid_argument(
        fmt::format("the budget of {} in line {} is relative to a base; name one with --base DIR, "
                    "the --out of a former run",
                    relative->field, relative->line));
  }
  std::error_code error;
  const bool exists = std::filesystem::exists(dir / "summary.json", error) ||
                      std::filesystem::exists(dir / test.name, error);
  if (!needed && !exists) return std::nullopt;
  auto base = load_base(dir, test);
  if (!base) return tl::unexpected(base.error());
  if (auto ok = set_limits(test, *base); !ok) return tl::unexpected(ok.error());
  return std::optional(std::move(*base));
}

TestFlights::TestFlights(const PreparedTest& prepared, const RunOptions& options,
                         const Hooks& hooks, const UsualLoadFile& usual)
    : base_(prepared.base), options_(options), hooks_(hooks), usual_file_(usual) {
  result_.file = prepared.file.file;
  result_.name = core::shown(prepared.file.file.stem().string());
  if (prepared.file.test) {
    test_ = *prepared.file.test;
    result_.name = test_.name;
    if (!options_.out.empty()) clear_folder();
  } else {
    result_.error = prepared.file.test.error();
    over_ = true;
  }
}

// Of runs of an earlier call only those stay that this call writes again.
void TestFlights::clear_folder() const {
  const std::filesystem::path folder = options_.out / test_.name;
  std::error_code error;
  std::vector<std::filesystem::path> earlier;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error))
    if (is_run_folder(it->path())) earlier.push_back(it->path());
  for (const std::filesystem::path& each : earlier) {
    remove_outputs(each);
    std::filesystem::remove(each, error);  // if nothing else is in it
  }
  std::filesystem::remove(folder / kProfileFile, error);
  if (flies_often())
    remove_outputs(folder);
  else
    remove_failure(folder);
}

std::string TestFlights::folder_name(std::size_t run) const {
  return flies_often() ? fmt::format("{}/{}{}", test_.name, kRunPrefix, run + 1) : test_.name;
}

void TestFlights::fly() {
  const double start_s = core::monotonic_seconds();
  if (auto flown = fly_once(); !flown) {
    result_.error = flown.error();
    result_.budgets.clear();  // of earlier attempts: there is no verdict
    over_ = true;
  } else if (runs_.size() % static_cast<std::size_t>(test_.runs) == 0) {
    judge_attempt();
  }
  result_.seconds += core::monotonic_seconds() - start_s;
}

core::Result<void> TestFlights::fly_once() {
  app::FlightOptions options = test_.flight;
  if (!options_.out.empty()) options.out_folder = options_.out / folder_name(runs_.size());
  auto flight = start_flight(std::move(options), options_, hooks_);
  if (!flight) return tl::unexpected(flight.error());
  auto report = (*flight)->run();
  if (!report) return tl::unexpected(report.error());
  if ((*flight)->session().stopped())
    return core::fail(core::ErrorCode::kInterrupted, "the flight was stopped");
  if (!report->failures.empty()) return tl::unexpected(report->failures.front());
  if (runs_.empty()) {
    if (auto ok = use_conditions(report->summary); !ok) return ok;
  }
  runs_.push_back(telemetry::summary_fields(report->summary));
  const bool is_virtual = test_.flight.session.scene.virtual_time;
  const auto alone =
      judge(test_.budgets, Flights{.runs = {&runs_.back(), 1}, .virtual_clock = is_virtual});
  worst_.push_back(worst_frames(alone, (*flight)->log(), test_.flight.warmup_seconds,
                                static_cast<std::size_t>(options_.worst_frames),
                                test_.flight.sections));
  return {};
}

// Finds the usual times for the machine of the first flight. Fails if a limit is relative to a base
// of other conditions; a base that nothing is relative to is left out then.
core::Result<void> TestFlights::use_conditions(const telemetry::Summary& summary) {
  machine_ = machine_name(summary.machine);
  usual_ = usual_file_.usual(machine_, test_.name);
  if (!base_) return {};
  const auto same = check_conditions(*base_, telemetry::to_json(summary),
                                     test_.flight.session.scene.virtual_time);
  if (!same) {
    if (std::ranges::any_of(test_.budgets, is_relative)) return same;
    core::log_warning(fmt::format("{}: {}", test_.name, same.error().message));
    return {};
  }
  const UsualLoad of_base = base_->usual();
  if (!usual_.pair_s.has_value() && !usual_.cpu_s.has_value()) {
    usual_ = of_base;
    return {};
  }
  usual_.source = "the recorded runs and the base";
  if (!usual_.pair_s.has_value()) usual_.pair_s = of_base.pair_s;
  if (of_base.cpu_s.has_value()) usual_.cpu_s = of_base.cpu_s;
  return {};
}

void TestFlights::judge_attempt() {
  const bool is_virtual = test_.flight.session.scene.virtual_time;
  const auto runs = static_cast<std::size_t>(test_.runs);
  result_.budgets = judge(
      test_.budgets,
      Flights{.runs = runs_, .attempt_runs = runs, .virtual_clock = is_virtual, .usual = usual_});
  const std::size_t attempts = runs_.size() / runs;
  over_ = attempts > static_cast<std::size_t>(test_.retries) ||
          !may_change(result_.budgets, is_virtual);
}

// Shows the worst frames of the last run that has some. The verdict does not depend on it.
void TestFlights::show_failure() {
  if (options_.out.empty() || options_.worst_frames <= 0) return;
  std::size_t run = runs_.size() - 1;
  while (run > 0 && worst_[run].empty())
    --run;
  FrameTest shown = test_;
  shown.name = folder_name(run);
  const CauseReport causes = causes_of(worst_[run]);
  const auto page = write_failure(shown, result_, worst_[run], causes, options_, hooks_);
  if (page) {
    result_.page = *page;
  } else {
    core::log_error(fmt::format("{}: {}", result_.name, page.error().message));
  }
}

// The profile is that of the test, not of a run.
CauseReport TestFlights::causes_of(std::span<const WorstFrame> frames) {
  const double flight_s = result_.seconds / static_cast<double>(runs_.size());
  const CauseReport causes =
      find_causes(test_, frames, base_ ? base_->folder : "", flight_s, options_, hooks_);
  result_.causes = causes.lines;
  return causes;
}

// Profiles a test that holds, for later runs, and compares it with the base.
void TestFlights::keep_profile() {
  if (options_.out.empty() || !options_.profile) return;
  for (const std::string& reason : causes_of({}).missing)
    core::log_warning(fmt::format("{}: {}", result_.name, reason));
}

TestResult TestFlights::finish() {
  const double start_s = core::monotonic_seconds();
  if (!result_.error && result_.misses() && options_.worst_frames > 0) {
    show_failure();
  } else if (!result_.error) {
    keep_profile();
  }
  result_.seconds += core::monotonic_seconds() - start_s;
  return result_;
}

std::vector<UsualLoadFile::Run> TestFlights::record() const {
  std::vector<UsualLoadFile::Run> record;
  for (const RunFields& run : runs_) {
    UsualLoadFile::Run each{
        machine_, test_.name, median_of({&run, 1}, "reference.pair.wall_s"), {}};
    // A flight on the wall clock does less work on a busy machine.
    const bool usual_work = test_.flight.session.scene.virtual_time || is_calm({&run, 1}, usual_);
    if (result_.holds() && usual_work) each.cpu_s = median_of({&run, 1}, "load.cpu_seconds");
    if (each.pair_s.has_value() || each.cpu_s.has_value()) record.push_back(std::move(each));
  }
  return record;
}

}  // namespace psygen::frametest
