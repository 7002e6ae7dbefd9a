#include "engine/frametest/base.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "engine/compare/compare.hpp"

namespace psygen::frametest {
namespace {

core::Error refusal(const Base& base, const std::vector<std::string>& differences,
                    std::string_view of) {
  return {core::ErrorCode::kInvalidArgument,
          fmt::format("{}: {} other conditions than the base: {}", base.folder.string(), of,
                      fmt::join(differences, ", "))};
}

}  // namespace

UsualLoad Base::usual() const {
  std::vector<double> pair_s;
  for (const RunFields& run : runs)
    if (const auto one = median_of({&run, 1}, "reference.pair.wall_s"); one.has_value())
      pair_s.push_back(*one);
  return {pair_s.empty() ? telemetry::Figure::missing("the base measured no reference load")
                         : telemetry::Figure(quantile_of(pair_s, 0.25)),
          median_of(runs, "load.cpu_seconds"), "the base"};
}

core::Result<Base> load_base(const std::filesystem::path& dir, const FrameTest& test) {
  std::error_code error;
  const bool itself = std::filesystem::exists(dir / "summary.json", error);
  Base base{itself ? dir : dir / test.name, {}, {}};
  const auto runs = compare::read_runs(base.folder);
  if (!runs && !std::filesystem::exists(base.folder, error))
    return core::fail(core::ErrorCode::kIo,
                      fmt::format("{}: there is no base of the test {}; make one with: psygen test "
                                  "FILE --out {}",
                                  base.folder.string(), test.name, dir.string()));
  if (!runs) return tl::unexpected(runs.error());
  base.conditions = runs->front();
  for (const compare::RecordedRun& run : *runs) {
    if (const auto differences = compare::differences_of(base.conditions, run);
        !differences.empty())
      return tl::unexpected(refusal(base, differences, run.folder + " has"));
    const std::string file = run.folder + "/summary.json";
    const auto summary = compare::read_text(file);
    if (!summary) return tl::unexpected(summary.error());
    auto fields = telemetry::summary_fields_in(*summary, file);
    if (!fields) return tl::unexpected(fields.error());
    base.runs.push_back(std::move(*fields));
  }
  return base;
}

core::Result<void> set_limits(FrameTest& test, const Base& base) {
  for (Budget& budget : test.budgets) {
    if (!budget.of_base) continue;
    const telemetry::Figure value = median_of(base.runs, budget.field);
    if (!value.has_value())
      return core::invalid_argument(
          fmt::format("{}: the base has no {}, to which the budget in line {} is relative: {}",
                      base.folder.string(), budget.field, budget.line, value.reason));
    budget.limit = *budget.of_base * *value;
  }
  return {};
}

core::Result<void> check_conditions(const Base& base, std::string_view summary_json,
                                    bool virtual_clock) {
  const auto run = compare::parse_conditions(summary_json, "this run", virtual_clock);
  if (!run) return tl::unexpected(run.error());
  const auto differences = compare::differences_of(base.conditions, *run);
  if (differences.empty()) return {};
  return tl::unexpected(refusal(base, differences, "this run has"));
}

}  // namespace psygen::frametest
