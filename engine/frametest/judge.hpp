// The verdict on the budgets of a test that flew several times: medians, limits scaled by the
// reference load, "not judged" on a busy machine, and the chance of a false alarm. The rules are
// those of docs/frame-tests.md. Pure.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/frametest/run.hpp"
#include "engine/frametest/usual_load.hpp"
#include "engine/telemetry/summary_fields.hpp"

namespace psygen::frametest {

// A limit of a time is scaled up to this ratio of the reference load to its usual time. Above it,
// a missed budget is not judged.
inline constexpr double kMaxBusyRatio = 1.5;
// Up to this ratio, and while other programs use at most this share of the usable processors, the
// machine is calm, and the wall clock needs no witness.
inline constexpr double kCalmRatio = 1.1, kCalmOthers = 0.1;
// Processor time rose if it is over the usual one by this ratio.
inline constexpr double kRisenRatio = 1.05;

// The fields of one flight's summary.
using RunFields = std::vector<telemetry::SummaryField>;

// A test's flights, and the knowledge about the machine.
struct Flights {
  std::span<const RunFields> runs;  // in the order of the flights, at least one
  std::size_t attempt_runs = 1;     // an attempt has so many runs, the last one may have fewer
  bool virtual_clock = false;
  UsualLoad usual = {};
};

// True if other programs may change a field: on the wall clock all but the conditions and the
// world, on the virtual clock only processor time.
bool depends_on_load(std::string_view field, bool virtual_clock);
// True if a field is a time of the wall clock: its limits are scaled.
bool is_wall_time(std::string_view field);

// One result per budget. An attempt's value is the median of its runs. A budget that depends on
// load holds if one attempt holds; it is not judged if no attempt is missed or held.
std::vector<BudgetResult> judge(std::span<const Budget> budgets, const Flights& flights);
// True if another attempt can change a result.
bool may_change(std::span<const BudgetResult> results, bool virtual_clock);

// The value at a fraction of the sorted values, linear between neighbours. Needs one value; unlike
// telemetry::percentile(), which protects its reader from few values, it is for few runs.
double quantile_of(std::vector<double> values, double fraction);

// The median of a field over runs; missing if one run has no number.
telemetry::Figure median_of(std::span<const RunFields> runs, std::string_view field);

// Share of the usable processors that other programs used during the flight, median over runs;
// missing if one run does not tell it.
telemetry::Figure others_share(std::span<const RunFields> runs);
// True if the reference load took its usual time, as far as both are known, and other programs left
// the processors alone.
bool is_calm(std::span<const RunFields> runs, const UsualLoad& usual);

// Chance that runs whose true mean is the limit scatter to a mean this far beyond it: one-sided t
// test, of logarithms if all numbers are positive. Missing below three values.
telemetry::Figure false_alarm_chance(std::span<const double> values, Relation relation,
                                     double limit);

}  // namespace psygen::frametest
