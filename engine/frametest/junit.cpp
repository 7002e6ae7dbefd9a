// JUnit XML, as CI servers read it.
#include <fmt/format.h>

#include <algorithm>

#include "engine/core/utf8.hpp"
#include "engine/frametest/run.hpp"
#include "engine/telemetry/report_plot.hpp"

namespace psygen::frametest {
namespace {

// shown() leaves no control characters, which XML has no way to write.
std::string escaped(std::string_view text) {
  return telemetry::escaped(core::shown(text));
}

std::string limit_of(const Budget& budget) {
  const double* number = std::get_if<double>(&budget.limit);
  return number != nullptr ? fmt::format("{:g}", *number) : std::get<std::string>(budget.limit);
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
  return text + "</testsuite>\n";
}

}  // namespace

std::string to_junit(std::span<const TestResult> results) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  for (const TestResult& result : results)
    text += suite_of(result);
  return text + "</testsuites>\n";
}

}  // namespace psygen::frametest
