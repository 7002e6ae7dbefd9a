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
#include "engine/telemetry/output_file.hpp"
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

core::Result<std::vector<TestFile>> prepare(const RunOptions& options) {
  if (!options.junit.empty()) {
    if (auto ok = telemetry::check_output_file(options.junit); !ok)
      return tl::unexpected(ok.error());
  }
  return options.words.check().and_then([&] { return load_frame_tests(options.files); });
}

core::Result<void> write_results(const RunOptions& options, std::span<const TestResult> results) {
  if (!options.junit.empty()) {
    if (auto ok = core::replace_file(options.junit, to_junit(results)); !ok) return ok;
  }
  return options.words.write(to_markdown(results), remarks_of(results));
}

}  // namespace

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

TestResult run_frame_test(const TestFile& file, const RunOptions& options, const Hooks& hooks) {
  const double start_s = core::monotonic_seconds();
  TestResult result;
  result.file = file.file;
  result.name = file.test ? file.test->name : core::shown(file.file.stem().string());
  auto flown = file.test.and_then([&](const FrameTest& t) { return fly(t, options, hooks); });
  if (flown) {
    result.budgets = std::move(flown->budgets);
    if (!result.holds()) show_failure(*file.test, flown->worst, options, hooks, result);
  } else {
    result.error = flown.error();
  }
  result.seconds = core::monotonic_seconds() - start_s;
  return result;
}

int run_frame_tests(const RunOptions& options, const Hooks& hooks) {
  const auto files = prepare(options);
  if (!files) return program::fail_with(files.error());
  std::vector<TestResult> results;
  bool printed = true;
  for (const TestFile& file : *files) {
    results.push_back(run_frame_test(file, options, hooks));
    const TestResult& result = results.back();
    printed = program::print(to_text(result)) == program::kOk && printed;
    if (result.error) core::log_error(fmt::format("{}: {}", result.name, result.error->message));
  }
  const telemetry::Annotations& annotations = options.words.annotations;
  if (annotations.to_stdout())
    printed = program::print(to_text(annotations, remarks_of(results))) == program::kOk && printed;
  if (const auto written = write_results(options, results); !written)
    return program::fail_with(written.error());
  return printed ? exit_code_of(results) : kFailed;
}

void add_words(CLI::App& cli, telemetry::PullRequestWords& words) {
  cli.add_option("--markdown", words.markdown,
                 "Write the results to this file as Markdown, for a page of a pull request");
  cli.add_option_function<std::string>(
         "--annotations",
         [&words](const std::string& text) {
           words.annotations = *telemetry::annotations_from(text);
         },
         "Remarks at the lines of files, for a pull request; without FILE to stdout")
      ->check(CLI::Validator(
          [](std::string& text) {
            const auto where = telemetry::annotations_from(text);
            return where ? std::string() : where.error().message;
          },
          "github|gitlab[:FILE]"));
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
  add_words(cli, options.words);
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
