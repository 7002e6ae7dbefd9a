#include "engine/history/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "engine/core/nearest_word.hpp"
#include "engine/core/utf8.hpp"
#include "engine/history/additions.hpp"

namespace psygen::history {
namespace {

constexpr std::ptrdiff_t kSilentRevisions = 10;

double median_value(std::span<const Entry* const> entries) {
  std::vector<double> values;
  for (const Entry* entry : entries)
    values.push_back(*entry->value);
  return values.empty() ? 0 : median(values);
}

core::Result<void> check_options(std::span<const Entry> entries, const CheckOptions& options) {
  if (entries.empty()) return core::invalid_argument("the history has no entries");
  auto ok = check_words(entries, options.tests, &Entry::test, "test");
  if (ok) ok = check_words(entries, options.figures, &Entry::figure, "figure");
  if (ok && !options.revision.empty())
    ok = check_words(entries, {options.revision}, &Entry::revision, "revision");
  return ok;
}

// The entries of a series before the judged ones, and the judged ones.
struct Split {
  std::vector<const Entry*> before, after;
};

Split split(const Series& series, const std::string& revision, std::size_t last) {
  Split result;
  if (last > 0) {
    const std::size_t count = series.entries.size() - std::min(last, series.entries.size());
    const auto middle = series.entries.begin() + static_cast<std::ptrdiff_t>(count);
    return {{series.entries.begin(), middle}, {middle, series.entries.end()}};
  }
  for (const Entry* entry : series.entries) {
    if (entry->revision == revision)
      result.after.push_back(entry);
    else if (result.after.empty())
      result.before.push_back(entry);
  }
  return result;
}

// The sentence about a machine that the history does not know, if it knows others.
std::string new_fingerprint(const Series& series, std::span<const Series> all) {
  for (const Series& other : all) {
    const Entry &a = *series.first, &b = *other.first;
    if (a.test == b.test && a.figure == b.figure && a.unit == b.unit &&
        a.fingerprint != b.fingerprint)
      return "; other entries are not comparable: " +
             fingerprint_difference(b.fingerprint, a.fingerprint);
  }
  return "";
}

bool gates(const Series& series, const CheckOptions& options) {
  if (options.figures.empty()) return series.rule.gates;
  return std::ranges::find(options.figures, series.first->figure) != options.figures.end();
}

// The revision of the last entry of each test.
std::map<std::string, const Entry*> last_entries(std::span<const Entry> entries) {
  std::map<std::string, const Entry*> last;
  for (const Entry& entry : entries) {
    const Entry*& known = last[entry.test];
    if (known == nullptr || entry.order >= known->order) known = &entry;
  }
  return last;
}

// A first look that finds a change waits for the second.
void await_second_look(GateVerdict& verdict) {
  if (verdict.outcome != Outcome::kWorse || verdict.looks > 1) return;
  verdict.outcome = Outcome::kUndecided;
  verdict.reason +=
      fmt::format("; not confirmed: add entries of this revision up to {}", kSecondLook);
}

void conclude(CheckResult& result) {
  std::set<Outcome> outcomes;
  for (const JudgedFigure& figure : result.figures)
    if (figure.gates) outcomes.insert(figure.verdict.outcome);
  for (const Outcome outcome : {Outcome::kWorse, Outcome::kDifferentWork, Outcome::kUndecided,
                                Outcome::kTooFew, Outcome::kBetter, Outcome::kSame}) {
    if (!outcomes.contains(outcome)) continue;
    result.outcome = outcome;
    return;
  }
  result.notes.emplace_back("no figure took part in the verdict; name some with --figure");
}

}  // namespace

std::vector<Observation> observations_of(std::span<const Entry* const> entries) {
  std::vector<Observation> result;
  for (const Entry* entry : entries) {
    const bool usable = entry->reference && *entry->reference > 0;
    result.push_back({.value = *entry->value,
                      .reference = usable ? entry->reference : std::nullopt,
                      .work = entry->work});
  }
  return result;
}

bool is_usable(const Entry& entry, const FigureRule& rule) {
  return entry.value && (!rule.logarithms || *entry.value > 0);
}

core::Result<void> check_words(std::span<const Entry> entries,
                               const std::vector<std::string>& words, std::string Entry::*field,
                               const char* what) {
  std::set<std::string> known;
  for (const Entry& entry : entries)
    known.insert(entry.*field);
  const std::vector<std::string> list(known.begin(), known.end());
  for (const std::string& word : words)
    if (!known.contains(word))
      return core::invalid_argument(fmt::format("the history has no {} '{}'{}", what,
                                                core::shown(word, 200),
                                                core::suggestion(word, list)));
  return {};
}

bool is_chosen(const std::vector<std::string>& tests, const std::string& test) {
  return tests.empty() || std::ranges::find(tests, test) != tests.end();
}

std::vector<Series> series_of(std::span<const Entry> entries) {
  std::map<std::tuple<std::string_view, std::string_view, std::string_view, std::string_view>,
           Series>
      by_key;
  for (const Entry& entry : entries) {
    Series& series = by_key[{entry.test, entry.figure, entry.fingerprint, entry.unit}];
    if (series.first == nullptr) {
      series.first = &entry;
      series.rule = rule_of(entry.figure, entry.unit);
    }
    if (is_usable(entry, series.rule))
      series.entries.push_back(&entry);
    else
      ++series.left_out;
  }
  std::vector<Series> all;
  for (auto& [key, series] : by_key) {
    std::ranges::stable_sort(series.entries, {}, &Entry::order);
    all.push_back(std::move(series));
  }
  return all;
}

std::vector<ChangePoint> changes_of(const Series& series, RankTails& tails) {
  const FigureRule& rule = series.rule;
  const bool ratio =
      rule.has_reference && std::ranges::all_of(series.entries, [](const Entry* entry) {
        return entry->reference && *entry->reference > 0;
      });
  return change_points(scaled(rule, observations_of(series.entries), ratio), rule.floor, tails);
}

std::vector<std::string> remarks_on(std::span<const Entry> entries,
                                    std::span<const Series> series) {
  std::vector<std::string> remarks;
  std::map<std::pair<std::string_view, std::string_view>, std::set<std::string_view>> units;
  for (const Series& each : series) {
    units[{each.first->test, each.first->figure}].insert(each.first->unit);
    if (each.left_out > 0)
      remarks.push_back(fmt::format("{} {}: {} entr{} without a usable value and left out",
                                    each.first->test, each.first->figure, each.left_out,
                                    each.left_out == 1 ? "y is" : "ies are"));
  }
  for (const auto& [name, all] : units)
    if (all.size() > 1)
      remarks.push_back(
          fmt::format("{} {}: its unit changes ({}); entries of different units are "
                      "never compared",
                      name.first, name.second, fmt::join(all, ", ")));
  std::map<std::string_view, std::pair<std::int64_t, std::int64_t>> clocks;  // order, time
  std::set<std::string_view> wrong;
  std::map<std::string_view, std::int64_t> last_of;  // order of a revision's last entry
  for (const Entry& entry : entries) {
    std::int64_t& last = last_of[entry.revision];
    last = std::max(last, entry.order);
    auto& [order, time] = clocks[entry.test];
    if (entry.order > order && entry.time < time && wrong.insert(entry.test).second)
      remarks.push_back(
          fmt::format("{}: the clock goes back by {} s at entry {}; the order of "
                      "adding counts",
                      entry.test, time - entry.time, entry.order));
    order = entry.order;
    time = entry.time;
  }
  for (const auto& [test, clock] : clocks) {
    const auto later = std::ranges::count_if(
        last_of, [order = clock.first](const auto& each) { return each.second > order; });
    if (later >= kSilentRevisions)
      remarks.push_back(
          fmt::format("{}: no run in the last {} revisions; if it was renamed: psygen "
                      "history rename {} NEW",
                      test, later, test));
  }
  return remarks;
}

core::Result<CheckResult> check(std::span<const Entry> entries, const CheckOptions& options) {
  if (auto ok = check_options(entries, options); !ok) return tl::unexpected(ok.error());
  const std::vector<Series> all = series_of(entries);
  const auto last = last_entries(entries);
  CheckResult result;
  std::vector<std::pair<const Series*, Split>> judged;
  std::size_t gating = 0;
  for (const Series& series : all) {
    const std::string& test = series.first->test;
    if (!is_chosen(options.tests, test)) continue;
    const std::string& revision =
        options.revision.empty() ? last.at(test)->revision : options.revision;
    Split parts = split(series, revision, options.last);
    if (parts.after.empty()) continue;
    gating += gates(series, options) && parts.before.size() >= kFewestRuns ? 1 : 0;
    judged.emplace_back(&series, std::move(parts));
  }
  RankTails tails;
  for (const auto& [series, parts] : judged) {
    JudgedFigure figure{.test = series->first->test,
                        .figure = series->first->figure,
                        .unit = series->first->unit,
                        .revision = parts.after.back()->revision,
                        .fingerprint = series->first->fingerprint,
                        .gates = gates(*series, options),
                        .rule = series->rule,
                        .verdict = judge(series->rule, observations_of(parts.before),
                                         observations_of(parts.after), gating, tails)};
    // Those that were compared.
    figure.before = median_value(std::span(parts.before).last(figure.verdict.before));
    figure.after = median_value(std::span(parts.after).first(figure.verdict.after));
    if (options.confirm) await_second_look(figure.verdict);
    if (parts.before.empty()) figure.verdict.reason += new_fingerprint(*series, all);
    result.figures.push_back(std::move(figure));
  }
  if (result.figures.empty())
    return core::invalid_argument("no test has an entry of this revision");
  result.notes = remarks_on(entries, all);
  conclude(result);
  return result;
}

}  // namespace psygen::history
