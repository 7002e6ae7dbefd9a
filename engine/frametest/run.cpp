#include "engine/frametest/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "engine/app/flight.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/replace_file.hpp"
#include "engine/telemetry/summary_fields.hpp"

namespace psygen::frametest {
namespace {

std::string_view sign_of(Relation relation) {
  return relation == Relation::kAtMost ? "<=" : relation == Relation::kAtLeast ? ">=" : "=";
}

std::string limit_text(const Budget& budget) {
  const double* number = std::get_if<double>(&budget.limit);
  return number != nullptr ? fmt::format("{:g}", *number) : std::get<std::string>(budget.limit);
}

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

core::Result<telemetry::Summary> fly(FrameTest test, const RunOptions& options,
                                     const Hooks& hooks) {
  if (!options.out.empty()) test.flight.out_folder = options.out / test.name;
  test.flight.session.device_name = options.device;
  test.flight.session.stop = options.stop;
  if (hooks.prepare) {
    if (auto ok = hooks.prepare(test.flight.session); !ok) return tl::unexpected(ok.error());
  }
  auto flight = app::Flight::create(std::move(test.flight));
  if (!flight) return tl::unexpected(flight.error());
  if (hooks.start) {
    if (auto ok = hooks.start((*flight)->session()); !ok) return tl::unexpected(ok.error());
  }
  auto report = (*flight)->run();
  if (!report) return tl::unexpected(report.error());
  if ((*flight)->session().stopped())
    return core::fail(core::ErrorCode::kInterrupted, "the flight was stopped");
  if (!report->failures.empty()) return tl::unexpected(report->failures.front());
  return std::move(report->summary);
}

}  // namespace

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
  TestResult result{file, file.stem().string(), {}, {}, 0};
  const auto test = load_frame_test(file);
  if (test) result.name = test->name;
  const auto summary = test.and_then([&](const FrameTest& t) { return fly(t, options, hooks); });
  if (summary) {
    result.budgets = judge(test->budgets, *summary);
  } else {
    result.error = summary.error();
  }
  result.seconds = core::monotonic_seconds() - start_s;
  return result;
}

std::string to_text(const TestResult& result) {
  std::string text;
  for (const BudgetResult& r : result.budgets) {
    text +=
        fmt::format("{}: {} {}  {} {}{}\n", result.name, r.budget.field, r.value,
                    sign_of(r.budget.relation), limit_text(r.budget), r.holds ? "" : "  MISSED");
  }
  return text;
}

int run_frame_tests(const RunOptions& options, const Hooks& hooks) {
  std::vector<TestResult> results;
  for (const std::filesystem::path& file : options.files) {
    results.push_back(run_frame_test(file, options, hooks));
    const TestResult& result = results.back();
    std::fputs(to_text(result).c_str(), stdout);
    if (result.error)
      std::fprintf(stderr, "%s: %s\n", result.name.c_str(), result.error->message.c_str());
    std::fflush(stdout);
  }
  int code = exit_code_of(results);
  if (options.junit.empty()) return code;
  if (const auto written = core::replace_file(options.junit, to_junit(results)); !written) {
    std::fprintf(stderr, "%s\n", written.error().message.c_str());
    code = kFailed;
  }
  return code;
}

int frame_test_main(int argc, char** argv, const Hooks& hooks) {
  RunOptions options;
  bool usable = true;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (!argument.starts_with("--")) {
      options.files.emplace_back(argument);
      continue;
    }
    const char* value = i + 1 < argc ? argv[++i] : nullptr;
    const bool known = argument == "--junit" || argument == "--out" || argument == "--device";
    usable = usable && known && value != nullptr;
    if (!usable) break;
    if (argument == "--junit") options.junit = value;
    if (argument == "--out") options.out = value;
    if (argument == "--device") options.device = value;
  }
  if (!usable || options.files.empty()) {
    std::fprintf(stderr, "usage: %s FILE... [--junit FILE] [--out DIR] [--device NAME]\n", argv[0]);
    return kUsage;
  }
  return run_frame_tests(options, hooks);
}

}  // namespace psygen::frametest
