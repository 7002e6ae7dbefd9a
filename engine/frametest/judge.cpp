#include "engine/frametest/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

namespace psygen::frametest {
namespace {

using telemetry::Figure;

constexpr std::string_view kPairWall = "reference.pair.wall_s", kCpu = "load.cpu_seconds";

// The value of a field in one run.
struct Value {
  std::optional<double> number;
  std::string text;  // for people; also the value of a text
  bool known = false;
};

Value value_in(const RunFields& fields, std::string_view name) {
  const auto field = std::ranges::find(fields, name, &telemetry::SummaryField::name);
  if (field == fields.end()) return {std::nullopt, "the run has no such field", false};
  if (const double* number = std::get_if<double>(&field->value))
    return {*number, fmt::format("{:.10g}", *number), true};
  if (const std::string* text = std::get_if<std::string>(&field->value))
    return {std::nullopt, *text, true};
  return {std::nullopt, "not measured: " + field->reason, false};
}

bool holds_for(Relation relation, double value, double limit) {
  return relation == Relation::kAtMost    ? value <= limit
         : relation == Relation::kAtLeast ? value >= limit
                                          : value == limit;
}

enum class Outcome : std::uint8_t { kHeld, kMissed, kNotJudged };

// Result of one attempt.
struct Attempt {
  Outcome outcome = Outcome::kMissed;
  std::string value;
  std::string note = {};  // a sentence; empty: none
  std::vector<double> numbers = {};
};

// Judges the attempts of one budget.
class Judge {
 public:
  Judge(const Budget& budget, const Flights& flights)
      : budget_(budget),
        flights_(flights),
        by_load_(depends_on_load(budget.field, flights.virtual_clock)) {}

  BudgetResult result() {
    std::vector<Attempt> attempts;
    for (std::size_t from = 0; from < flights_.runs.size(); from += flights_.attempt_runs) {
      const std::size_t count = std::min(flights_.attempt_runs, flights_.runs.size() - from);
      attempts.push_back(judge_attempt(flights_.runs.subspan(from, count)));
      if (!by_load_ || attempts.back().outcome == Outcome::kHeld) break;
    }
    BudgetResult result{budget_, {}, false};
    const auto chosen = chosen_of(attempts);
    result.value = chosen->value;
    result.holds = chosen->outcome == Outcome::kHeld;
    result.judged = chosen->outcome != Outcome::kNotJudged;
    if (!chosen->note.empty()) result.notes.push_back(chosen->note);
    if (flights_.runs.size() > 1)
      for (const RunFields& run : flights_.runs)
        result.runs.push_back(value_in(run, budget_.field).text);
    if (result.misses() && by_load_) explain(attempts, result);
    return result;
  }

 private:
  // The last held attempt, else the last missed one.
  std::vector<Attempt>::const_iterator chosen_of(const std::vector<Attempt>& attempts) const {
    for (const Outcome outcome : {Outcome::kHeld, Outcome::kMissed}) {
      const auto found =
          std::ranges::find(attempts.rbegin(), attempts.rend(), outcome, &Attempt::outcome);
      if (found != attempts.rend()) return std::prev(found.base());
    }
    return std::prev(attempts.end());
  }

  Attempt judge_attempt(std::span<const RunFields> runs) const {
    std::vector<Value> values;
    for (const RunFields& run : runs)
      values.push_back(value_in(run, budget_.field));
    const auto unknown = std::ranges::find(values, false, &Value::known);
    if (unknown != values.end()) return judge_missing(runs, unknown->text);
    const double* limit = std::get_if<double>(&budget_.limit);
    if (budget_.relation == Relation::kEqual || limit == nullptr) return judge_equality(values);
    std::vector<double> numbers;
    for (const Value& value : values)
      if (value.number) numbers.push_back(*value.number);
    if (numbers.size() != values.size()) return {Outcome::kMissed, values.front().text};
    return judge_number(runs, std::move(numbers), *limit);
  }

  // A busy machine can leave a run too few frames for a percentile.
  Attempt judge_missing(std::span<const RunFields> runs, const std::string& reason) const {
    Attempt attempt{Outcome::kMissed, reason};
    const double ratio = reference_ratio(runs).value_or(1);
    if (by_load_ && !flights_.virtual_clock && ratio > kMaxBusyRatio) call_busy(ratio, attempt);
    return attempt;
  }

  void call_busy(double ratio, Attempt& attempt) const {
    attempt.outcome = Outcome::kNotJudged;
    attempt.note = fmt::format(
        "The machine was busy: the reference load took {:.2f} times its usual time ({}).", ratio,
        flights_.usual.source);
  }

  // The reference load's time over its usual time; missing if one is unknown.
  std::optional<double> reference_ratio(std::span<const RunFields> runs) const {
    const Figure pair_s = median_of(runs, kPairWall), &usual_s = flights_.usual.pair_s;
    if (!pair_s.has_value() || !usual_s.has_value()) return std::nullopt;
    return *pair_s / *usual_s;
  }

  // All runs must have the value.
  Attempt judge_equality(std::span<const Value> values) const {
    const double* number = std::get_if<double>(&budget_.limit);
    const std::string* text = std::get_if<std::string>(&budget_.limit);
    const auto other = std::ranges::find_if(values, [&](const Value& value) {
      if (number != nullptr) return !value.number || *value.number != *number;
      return value.number || text == nullptr || value.text != *text;
    });
    if (other == values.end()) return {Outcome::kHeld, values.front().text};
    return {Outcome::kMissed, other->text};
  }

  Attempt judge_number(std::span<const RunFields> runs, std::vector<double> numbers,
                       double limit) const {
    const double value = quantile_of(numbers, 0.5);
    Attempt attempt{Outcome::kMissed, fmt::format("{:.10g}", value), {}, std::move(numbers)};
    if (holds_for(budget_.relation, value, limit)) attempt.outcome = Outcome::kHeld;
    if (attempt.outcome == Outcome::kHeld || !by_load_ || flights_.virtual_clock) return attempt;
    const std::optional<double> ratio = reference_ratio(runs);
    if (!ratio) {
      judge_by_processor_time(runs, attempt);
      return attempt;
    }
    if (*ratio > kMaxBusyRatio) {
      call_busy(*ratio, attempt);
      return attempt;
    }
    const double scale = std::max(*ratio, 1.0);
    const double scaled = budget_.relation == Relation::kAtMost ? limit * scale : limit / scale;
    if (!is_wall_time(budget_.field) || !holds_for(budget_.relation, value, scaled)) {
      if (!is_calm(runs, flights_.usual)) judge_by_processor_time(runs, attempt);
      return attempt;
    }
    attempt.outcome = Outcome::kHeld;
    attempt.note = fmt::format(
        "Held by the scaled limit {:.6g}: the reference load took {:.2f} times its usual time "
        "({}).",
        scaled, *ratio, flights_.usual.source);
    return attempt;
  }

  // Where the reference load is unknown, or the machine was not calm, processor time must confirm
  // that the program is to blame.
  void judge_by_processor_time(std::span<const RunFields> runs, Attempt& attempt) const {
    const Figure cpu_s = median_of(runs, kCpu), &usual_s = flights_.usual.cpu_s;
    if (!budget_.needs_witness || !cpu_s.has_value() || !usual_s.has_value()) return;
    if (*cpu_s >= kRisenRatio * *usual_s) return;
    attempt.outcome = Outcome::kNotJudged;
    attempt.note = fmt::format(
        "Only the wall clock rose, and the machine may be to blame: {}, reference load {}{}.",
        processor_text(*cpu_s), reference_text(runs), others_text(runs));
  }

  std::string reference_text(std::span<const RunFields> runs) const {
    const std::optional<double> ratio = reference_ratio(runs);
    return ratio ? fmt::format("{:.2f} times its usual time", *ratio) : "unknown";
  }

  static std::string others_text(std::span<const RunFields> runs) {
    const Figure others = others_share(runs);
    if (!others.has_value() || *others <= kCalmOthers) return "";
    return fmt::format(", other programs used {:.0f} % of the processors", 100 * *others);
  }

  std::string processor_text(double cpu_s) const {
    const double usual_s = *flights_.usual.cpu_s;
    return fmt::format("processor time {:.3g} s, usually {:.3g} s ({:+.1f} %; {})", cpu_s, usual_s,
                       100 * (cpu_s / usual_s - 1), flights_.usual.source);
  }

  // Adds what a missed budget's reader wants to know: processor time, and the chance of an alarm.
  void explain(std::span<const Attempt> attempts, BudgetResult& result) const {
    const Figure cpu_s = median_of(flights_.runs, kCpu), &usual_s = flights_.usual.cpu_s;
    if (!flights_.virtual_clock && cpu_s.has_value() && usual_s.has_value()) {
      const bool risen = *cpu_s >= kRisenRatio * *usual_s;
      result.notes.push_back(
          fmt::format("{}: {}.", risen ? "Processor time rose too" : "Only the wall clock rose",
                      processor_text(*cpu_s)));
    } else if (!flights_.virtual_clock) {
      result.notes.push_back(
          "Whether processor time rose too is unknown: neither a base nor recorded runs have it.");
    }
    std::vector<double> numbers;
    for (const Attempt& attempt : attempts)
      numbers.insert(numbers.end(), attempt.numbers.begin(), attempt.numbers.end());
    const double* limit = std::get_if<double>(&budget_.limit);
    if (limit == nullptr || numbers.empty()) return;
    const Figure chance = false_alarm_chance(numbers, budget_.relation, *limit);
    result.notes.push_back(
        chance.has_value()
            ? fmt::format("Chance of a false alarm: {:.2g} %, by a t test of {} runs against the "
                          "limit, as if no load lasted from run to run.",
                          100 * *chance, numbers.size())
            : "Chance of a false alarm: unknown; " + chance.reason + ".");
  }

  const Budget& budget_;
  const Flights& flights_;
  bool by_load_;
};

// P(T > t) of Student's distribution (Abramowitz and Stegun, 26.7.3 and 26.7.4). O(degrees).
double student_tail(double t, std::size_t degrees) {
  const double angle = std::atan(t / std::sqrt(static_cast<double>(degrees)));
  const double cosine = std::cos(angle), square = cosine * cosine;
  const bool odd = degrees % 2 == 1;
  double sum = 0, term = odd ? cosine : 1;
  for (std::size_t k = odd ? 3 : 2; k <= degrees; k += 2) {
    sum += term;
    term *= square * static_cast<double>(k - 1) / static_cast<double>(k);
  }
  const double both =
      odd ? 2 / std::numbers::pi * (angle + std::sin(angle) * sum) : std::sin(angle) * sum;
  return (1 - both) / 2;
}

}  // namespace

bool depends_on_load(std::string_view field, bool virtual_clock) {
  if (field.starts_with("load.") || field.starts_with("reference.")) return true;
  if (virtual_clock) return false;
  constexpr std::array<std::string_view, 7> kFixed{"schema", "world.", "device.", "machine.",
                                                   "build.", "run.",   "hash."};
  constexpr std::array<std::string_view, 3> kMeasured{"run.real_seconds", "run.timed_frames",
                                                      "run.apart_frames"};
  const auto begins = [field](std::string_view prefix) { return field.starts_with(prefix); };
  return std::ranges::any_of(kMeasured, begins) || std::ranges::none_of(kFixed, begins);
}

bool is_wall_time(std::string_view field) {
  const bool is_rate = field.ends_with("low1_fps") || field.ends_with("low01_fps");
  if (is_rate || field == "run.real_seconds") return true;
  const bool is_count = field.ends_with(".frames") || field.ends_with(".invalid");
  std::string_view inner = field;  // of a section
  if (field.starts_with("sections.")) inner.remove_prefix(field.find('.', 9) + 1);
  const bool of_device = inner.starts_with("gpu_ms.") || inner.starts_with("pass_ms.");
  if (is_count || of_device) return false;
  const std::size_t at = field.find("_ms");
  return at != std::string_view::npos && (at + 3 == field.size() || field[at + 3] == '.');
}

std::vector<BudgetResult> judge(std::span<const Budget> budgets, const Flights& flights) {
  std::vector<BudgetResult> results;
  for (const Budget& budget : budgets)
    results.push_back(Judge(budget, flights).result());
  return results;
}

bool may_change(std::span<const BudgetResult> results, bool virtual_clock) {
  return std::ranges::any_of(results, [virtual_clock](const BudgetResult& r) {
    return !r.holds && depends_on_load(r.budget.field, virtual_clock);
  });
}

double quantile_of(std::vector<double> values, double fraction) {
  std::ranges::sort(values);
  const double at = fraction * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return std::lerp(values[low], values[high], at - static_cast<double>(low));
}

Figure median_of(std::span<const RunFields> runs, std::string_view field) {
  std::vector<double> numbers;
  for (const RunFields& run : runs) {
    const Value value = value_in(run, field);
    if (!value.number) return Figure::missing(value.text);
    numbers.push_back(*value.number);
  }
  return numbers.empty() ? Figure() : Figure(quantile_of(std::move(numbers), 0.5));
}

Figure others_share(std::span<const RunFields> runs) {
  Figure others = median_of(runs, "load.others_cores");
  const Figure cores = median_of(runs, "machine.cores");
  if (!others.has_value()) return others;
  if (!cores.has_value() || !(*cores > 0)) return Figure::missing("the processors are unknown");
  return *others / *cores;
}

bool is_calm(std::span<const RunFields> runs, const UsualLoad& usual) {
  const Figure pair_s = median_of(runs, kPairWall);
  const bool slower =
      pair_s.has_value() && usual.pair_s.has_value() && *pair_s > kCalmRatio * *usual.pair_s;
  const Figure others = others_share(runs);
  return !slower && !(others.has_value() && *others > kCalmOthers);
}

Figure false_alarm_chance(std::span<const double> values, Relation relation, double limit) {
  constexpr std::size_t kFewest = 3;
  if (values.size() < kFewest) return Figure::missing("fewer than 3 runs show no scatter");
  const bool positive =
      limit > 0 && std::ranges::all_of(values, [](double value) { return value > 0; });
  const auto of = [positive](double value) { return positive ? std::log(value) : value; };
  const double count = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (const double value : values)
    mean += of(value) / count;
  for (const double value : values)
    squares += (of(value) - mean) * (of(value) - mean);
  const double distance = relation == Relation::kAtLeast ? of(limit) - mean : mean - of(limit);
  const double error = std::sqrt(squares / (count - 1) / count);
  if (!(error > 1e-12 * std::abs(distance))) return Figure(distance > 0 ? 0.0 : 0.5);
  return student_tail(distance / error, values.size() - 1);
}

}  // namespace psygen::frametest
