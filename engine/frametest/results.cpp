// Results of frame tests as text, JUnit XML, Markdown and remarks.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/core/utf8.hpp"
#include "engine/frametest/run.hpp"
#include "engine/telemetry/page.hpp"

namespace psygen::frametest {
namespace {

bool is_skipped(const TestResult& result) {
  return result.error && result.error->code == core::ErrorCode::kNoDevice;
}

template <class Predicate>
std::size_t count(const TestResult& result, const Predicate& predicate) {
  return static_cast<std::size_t>(std::ranges::count_if(result.budgets, predicate));
}

std::size_t missed(const TestResult& result) {
  return count(result, [](const BudgetResult& r) { return r.misses(); });
}

std::size_t not_judged(const TestResult& result) {
  return count(result, [](const BudgetResult& r) { return !r.judged; });
}

std::size_t skipped_cases(const TestResult& result) {
  return is_skipped(result) ? 1 : not_judged(result);
}

// "24.1", "24.1 (runs 24, 24.1, 26)"
std::string value_of(const BudgetResult& r) {
  return r.runs.empty() ? r.value : fmt::format("{} (runs {})", r.value, fmt::join(r.runs, ", "));
}

// Sentences about a value, to follow it: ". One. Two."
std::string notes_of(const BudgetResult& r) {
  return r.notes.empty() ? "" : fmt::format(". {}", fmt::join(r.notes, " "));
}

std::string outcome_of(const BudgetResult& r) {
  return r.holds ? "held" : r.judged ? "MISSED" : "not judged";
}

std::size_t cases(const TestResult& result) {
  return result.error ? 1 : result.budgets.size();
}

// The name of a test; of a file without a test that has another test's name, the file.
std::string class_of(const TestResult& result, std::span<const TestResult> results) {
  return std::ranges::count(results, result.name, &TestResult::name) > 1 ? result.file.string()
                                                                         : result.name;
}

std::string counts(std::size_t tests, std::size_t failures, std::size_t errors, std::size_t skipped,
                   double seconds) {
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"{:.3f}\"",
                     tests, failures, errors, skipped, seconds);
}

std::string suite_of(const TestResult& result, const std::string& class_name) {
  const bool skipped = is_skipped(result);
  const std::string name = escaped(class_name);
  const double case_s =
      result.seconds / static_cast<double>(std::max<std::size_t>(cases(result), 1));
  const auto start = [&](const std::string& case_name) {
    return fmt::format("<testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\">", name,
                       escaped(case_name), case_s);
  };
  std::string text =
      fmt::format("<testsuite name=\"{}\" file=\"{}\" {}>\n", name, escaped(result.file.string()),
                  counts(cases(result), missed(result), result.error && !skipped,
                         skipped_cases(result), result.seconds));
  if (result.error)
    text += fmt::format("{}<{} message=\"{}\"/></testcase>\n", start("run"),
                        skipped ? "skipped" : "error", escaped(result.error->message));
  for (const BudgetResult& r : result.budgets) {
    text += start(
        fmt::format("{} {} {}", r.budget.field, name_of(r.budget.relation), limit_of(r.budget)));
    const std::string story = escaped(value_of(r) + notes_of(r));
    text += r.holds ? fmt::format("<system-out>{}</system-out></testcase>\n", story)
                    : fmt::format("<{} message=\"{}\"/></testcase>\n",
                                  r.judged ? "failure" : "skipped", story);
  }
  for (const std::string& cause : result.causes)
    text += fmt::format("<system-out>{}</system-out>\n", escaped(cause));
  // Several CI servers show this line as an attachment of the suite.
  if (!result.page.empty())
    text += fmt::format("<system-out>[[ATTACHMENT|{}]]</system-out>\n",
                        escaped(std::filesystem::absolute(result.page).string()));
  return text + "</testsuite>\n";
}

std::string outcome_of(const TestResult& result) {
  if (is_skipped(result)) return "skipped: " + result.error->message;
  if (result.error) return "failed: " + result.error->message;
  const std::size_t count = missed(result), unclear = not_judged(result);
  const std::string budgets =
      fmt::format("{} budget{}", result.budgets.size(), result.budgets.size() == 1 ? "" : "s");
  if (count > 0) return fmt::format("missed {} of {}", count, budgets);
  return unclear > 0 ? fmt::format("not judged, {} of {}", unclear, budgets) : "held, " + budgets;
}

std::string limit_text(const BudgetResult& r) {
  return fmt::format("{} {}", sign_of(r.budget.relation), limit_of(r.budget));
}

}  // namespace

std::string_view sign_of(Relation relation) {
  return relation == Relation::kAtMost ? "<=" : relation == Relation::kAtLeast ? ">=" : "=";
}

std::string limit_of(const Budget& budget) {
  const double* number = std::get_if<double>(&budget.limit);
  if (number == nullptr) return std::get<std::string>(budget.limit);
  return budget.of_base ? fmt::format("{:g} ({:g} × base)", *number, *budget.of_base)
                        : fmt::format("{:g}", *number);
}

std::string escaped(std::string_view text) {
  return telemetry::escaped(core::shown(text));
}

std::string to_text(const TestResult& result) {
  std::string text;
  for (const BudgetResult& r : result.budgets) {
    text +=
        fmt::format("{}: {} {}  {}{}\n", result.name, r.budget.field, value_of(r), limit_text(r),
                    r.holds    ? ""
                    : r.judged ? "  MISSED"
                               : "  NOT JUDGED");
    for (const std::string& note : r.notes)
      text += fmt::format("{}:   {}\n", result.name, note);
  }
  for (const std::string& cause : result.causes)
    text += fmt::format("{}: {}\n", result.name, cause);
  if (!result.page.empty())
    text += fmt::format("{}: images in {}\n", result.name, result.page.string());
  return text;
}

std::string to_junit(std::span<const TestResult> results) {
  std::size_t tests = 0, failures = 0, errors = 0, skipped = 0;
  double seconds = 0;
  std::string suites;
  for (const TestResult& result : results) {
    suites += suite_of(result, class_of(result, results));
    tests += cases(result);
    failures += missed(result);
    skipped += skipped_cases(result);
    errors += result.error && !is_skipped(result) ? 1 : 0;
    seconds += result.seconds;
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {}>\n{}</testsuites>\n",
      counts(tests, failures, errors, skipped, seconds), suites);
}

std::string to_markdown(std::span<const TestResult> results) {
  std::vector<telemetry::MarkdownRow> tests;
  std::string budgets;
  for (const TestResult& result : results) {
    tests.push_back({result.name, outcome_of(result), fmt::format("{:.1f} s", result.seconds)});
    if (result.error || result.holds()) continue;
    budgets += fmt::format("### {}\n", telemetry::markdown_text(result.name));
    std::vector<telemetry::MarkdownRow> rows;
    for (const BudgetResult& r : result.budgets)
      rows.push_back({r.budget.field, limit_text(r), value_of(r), outcome_of(r)});
    budgets += telemetry::markdown_table({"budget", "limit", "this run", ""}, rows);
    for (const BudgetResult& r : result.budgets)
      for (const std::string& note : r.notes)
        budgets += "- " + telemetry::markdown_text(r.budget.field + ": " + note) + "\n";
    for (const std::string& cause : result.causes)
      budgets += fmt::format("- {}\n", telemetry::markdown_text(cause));
  }
  return "## Frame tests\n" + telemetry::markdown_table({"test", "result", "time"}, tests) +
         budgets;
}

std::vector<telemetry::Remark> remarks_of(std::span<const TestResult> results) {
  std::vector<telemetry::Remark> remarks;
  for (const TestResult& result : results) {
    if (result.error)
      remarks.push_back({.level = is_skipped(result) ? telemetry::RemarkLevel::kWarning
                                                     : telemetry::RemarkLevel::kError,
                         .title = result.name + (is_skipped(result) ? " is skipped" : " failed"),
                         .message = result.error->message,
                         .file = result.file,
                         .line = 1});
    for (const BudgetResult& r : result.budgets) {
      if (r.holds) continue;
      const std::string cause = result.causes.empty() ? "" : ". " + result.causes.front();
      remarks.push_back(
          {.level = r.judged ? telemetry::RemarkLevel::kError : telemetry::RemarkLevel::kWarning,
           .title = fmt::format("{} {} {}", result.name, r.judged ? "misses" : "does not judge",
                                r.budget.field),
           .message = fmt::format("{} is {}; the budget is {}{}{}", r.budget.field, value_of(r),
                                  limit_text(r), notes_of(r), cause),
           .file = result.file,
           .line = r.budget.line});
    }
  }
  return remarks;
}

}  // namespace psygen::frametest
