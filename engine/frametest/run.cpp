#include "engine/frametest/run.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "engine/app/flight.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/frametest/failure.hpp"
#include "engine/program/command_line.hpp"
#include "engine/program/program.hpp"
#include "engine/telemetry/page.hpp"
#include "engine/telemetry/summary_fields.hpp"

namespace psygen::frametest {
namespace {

bool holds_for(const Budget& budget, double value) {
  const double* limit = std::get_if<double>(&budget.limit);
  if (limit == nullptr) return false;
  return budget.relation == Relation::kAtMost    ? value <= *limit
         : budget.relation == Relation::kAtLeast ? value >= *limit
                                                 : value == *limit;
}

BudgetResult judge_one(const Budget& budget, std::span<const telemetry::SummaryField> fields) {
  const auto field = std::ranges::find(fields, budget.field, &telemetry::SummaryField::name);
  if (field == fields.end()) return {budget, "the run has no such field", false};
  if (const double* number = std::get_if<double>(&field->value))
    return {budget, fmt::format("{:.10g}", *number), holds_for(budget, *number)};
  if (const std::string* text = std::get_if<std::string>(&field->value)) {
    const std::string* limit = std::get_if<std::string>(&budget.limit);
    return {budget, *text, limit != nullptr && *limit == *text};
  }
  return {budget, "not measured: " + field->reason, false};
}

struct Flown {
  std::vector<BudgetResult> budgets;
  std::vector<WorstFrame> worst;  // of a failed test
};

core::Result<Flown> fly(FrameTest test, const RunOptions& options, const Hooks& hooks) {
  if (!options.out.empty()) {
    test.flight.out_folder = options.out / test.name;
    remove_failure(test.flight.out_folder);
  }
  auto flight = start_flight(test.flight, options, hooks);
  if (!flight) return tl::unexpected(flight.error());
  auto report = (*flight)->run();
  if (!report) return tl::unexpected(report.error());
  if ((*flight)->session().stopped())
    return core::fail(core::ErrorCode::kInterrupted, "the flight was stopped");
  if (!report->failures.empty()) return tl::unexpected(report->failures.front());
  Flown flown;
  flown.budgets = judge(test.budgets, report->summary);
  flown.worst = worst_frames(flown.budgets, (*flight)->log(), test.flight.warmup_seconds,
                             static_cast<std::size_t>(options.worst_frames));
  return flown;
}

// Reports the worst frames if outputs are kept. The verdict does not depend on it.
void show_failure(const FrameTest& test, std::span<const WorstFrame> worst,
                  const RunOptions& options, const Hooks& hooks, TestResult& result) {
  if (options.out.empty() || options.worst_frames <= 0) return;
  const auto page = write_failure(test, result, worst, options, hooks);
  if (page) {
    result.page = *page;
  } else {
    core::log_error(fmt::format("{}: {}", result.name, page.error().message));
  }
}

std::string suite_of(const TestResult& result) {
  const bool skipped = result.error && result.error->code == core::ErrorCode::kNoDevice;
  const auto missed = std::ranges::count(result.budgets, false, &BudgetResult::holds);
  const std::string name = escaped(result.name);
  std::string text = fmt::format(
      "<testsuite name=\"{}\" file=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" "
      "skipped=\"{}\" time=\"{:.3f}\">\n",
      name, escaped(result.file.string()), result.error ? 1 : result.budgets.size(), missed,
      result.error && !skipped ? 1 : 0, skipped ? 1 : 0, result.seconds);
  if (result.error) {
    const std::string message = escaped(result.error->message);
    text += fmt::format("<testcase classname=\"{}\" name=\"run\"><{} message=\"{}\"/></testcase>\n",
                        name, skipped ? "skipped" : "error", message);
  }
  for (const BudgetResult& r : result.budgets) {
    const std::string_view relation = name_of(r.budget.relation);
    text += fmt::format("<testcase classname=\"{}\" name=\"{} {} {}\"", name,
                        escaped(r.budget.field), relation, escaped(limit_of(r.budget)));
    text += r.holds ? fmt::format("><system-out>{}</system-out></testcase>\n", escaped(r.value))
                    : fmt::format("><failure message=\"{}\"/></testcase>\n", escaped(r.value));
  }
  // Several CI servers show this line as an attachment of the suite.
  if (!result.page.empty())
    text += fmt::format("<system-out>[[ATTACHMENT|{}]]</system-out>\n",
                        escaped(std::filesystem::absolute(result.page).string()));
  return text + "</testsuite>\n";
}

}  // namespace

std::string_view sign_of(Relation relation) {
  return relation == Relation::kAtMost ? "<=" : relation == Relation::kAtLeast ? ">=" : "=";
}

std::string limit_of(const Budget& budget) {
  const double* number = std::get_if<double>(&budget.limit);
  return number != nullptr ? fmt::format("{:g}", *number) : std::get<std::string>(budget.limit);
}

std::string escaped(std::string_view text) {
  return telemetry::escaped(core::shown(text));
}

core::Result<std::unique_ptr<app::Flight>> start_flight(app::FlightOptions flight,
                                                        const RunOptions& options,
                                                        const Hooks& hooks, app::Plugin last) {
  flight.session.device_name = options.device;
  flight.session.stop = options.stop;
  if (hooks.prepare) {
    if (auto ok = hooks.prepare(flight.session); !ok) return tl::unexpected(ok.error());
  }
  flight.camera = hooks.camera;
  if (!last.name.empty()) flight.session.plugins.push_back(std::move(last));
  auto made = app::Flight::create(std::move(flight));
  if (made && hooks.start) {
    if (auto ok = hooks.start((*made)->session()); !ok) return tl::unexpected(ok.error());
  }
  return made;
}

bool TestResult::holds() const {
  return !error && std::ranges::all_of(budgets, &BudgetResult::holds);
}

int exit_code_of(std::span<const TestResult> results) {
  const auto any = [&](auto predicate) { return std::ranges::any_of(results, predicate); };
  const auto skipped = [](const TestResult& r) {
    return r.error && r.error->code == core::ErrorCode::kNoDevice;
  };
  if (any([&](const TestResult& r) { return r.error && !skipped(r); })) return kFailed;
  if (any([](const TestResult& r) { return !r.error && !r.holds(); })) return kMissed;
  return any(skipped) ? kSkipped : kHeld;
}

std::vector<BudgetResult> judge(std::span<const Budget> budgets,
                                const telemetry::Summary& summary) {
  const std::vector<telemetry::SummaryField> fields = telemetry::summary_fields(summary);
  std::vector<BudgetResult> results;
  for (const Budget& budget : budgets)
    results.push_back(judge_one(budget, fields));
  return results;
}

TestResult run_frame_test(const std::filesystem::path& file, const RunOptions& options,
                          const Hooks& hooks) {
  const double start_s = core::monotonic_seconds();
  TestResult result;
  result.file = file;
  result.name = core::shown(file.stem().string());
  const auto test = load_frame_test(file);
  if (test) result.name = test->name;
  auto flown = test.and_then([&](const FrameTest& t) { return fly(t, options, hooks); });
  if (flown) {
    result.budgets = std::move(flown->budgets);
    if (!result.holds()) show_failure(*test, flown->worst, options, hooks, result);
  } else {
    result.error = flown.error();
  }
  result.seconds = core::monotonic_seconds() - start_s;
  return result;
}

std::string to_text(const TestResult& result) {
  std::string text;
  for (const BudgetResult& r : result.budgets) {
    text += fmt::format("{}: {} {}  {} {}{}\n", result.name, r.budget.field, r.value,
                        sign_of(r.budget.relation), limit_of(r.budget), r.holds ? "" : "  MISSED");
  }
  if (!result.page.empty())
    text += fmt::format("{}: images in {}\n", result.name, result.page.string());
  return text;
}

std::string to_junit(std::span<const TestResult> results) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  for (const TestResult& result : results)
    text += suite_of(result);
  return text + "</testsuites>\n";
}

int run_frame_tests(const RunOptions& options, const Hooks& hooks) {
  std::vector<TestResult> results;
  bool printed = true;
  for (const std::filesystem::path& file : options.files) {
    results.push_back(run_frame_test(file, options, hooks));
    const TestResult& result = results.back();
    printed = program::print(to_text(result)) == program::kOk && printed;
    if (result.error) core::log_error(fmt::format("{}: {}", result.name, result.error->message));
  }
  int code = printed ? exit_code_of(results) : kFailed;
  if (options.junit.empty()) return code;
  if (const auto written = core::replace_file(options.junit, to_junit(results)); !written) {
    core::log_error(written.error().message);
    code = kFailed;
  }
  return code;
}

void add_options(CLI::App& cli, RunOptions& options) {
  cli.add_option("FILE", options.files, "Frame tests: TOML files")->required();
  cli.add_option("--junit", options.junit, "Write the results to this file as JUnit XML");
  cli.add_option("--out", options.out, "Folder for the outputs, with one subfolder per test");
  cli.add_option("--worst", options.worst_frames,
                 "Number of worst frames of a failed test written as images to --out")
      ->capture_default_str()
      ->check(CLI::Range(0, kMaxWorstFrames));
  cli.add_option("--device", options.device, "Part of the Vulkan device's name");
}

int frame_test_main(int argc, char** argv, const Hooks& hooks) {
  const std::string name = argc > 0 ? std::filesystem::path(argv[0]).filename().string() : "";
  return program::run(name, [&] {
    RunOptions options;
    CLI::App cli("Runs frame tests", name);
    add_options(cli, options);
    if (const auto code = program::read_command_line(cli, argc, argv)) return *code;
    options.stop = &program::stop_at_interrupt();
    return run_frame_tests(options, hooks);
  });
}

}  // namespace psygen::frametest
