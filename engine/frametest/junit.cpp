// Writes JUnit XML for CI servers.
#include <fmt/format.h>

#include <algorithm>

#include "engine/frametest/escaped.hpp"
#include "engine/frametest/run.hpp"

namespace psygen::frametest {
namespace {

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

std::string to_junit(std::span<const TestResult> results) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  for (const TestResult& result : results)
    text += suite_of(result);
  return text + "</testsuites>\n";
}

}  // namespace psygen::frametest
