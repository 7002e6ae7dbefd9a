#include "engine/history/show.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/core/nearest_word.hpp"
#include "engine/core/utf8.hpp"

namespace psygen::history {
namespace {

core::Result<void> check_names(const std::set<std::string>& known,
                               const std::vector<std::string>& names, const char* what) {
  const std::vector<std::string> list(known.begin(), known.end());
  for (const std::string& name : names)
    if (!known.contains(name))
      return core::invalid_argument(fmt::format("the history has no {} '{}'{}", what,
                                                core::shown(name, 200),
                                                core::suggestion(name, list)));
  return {};
}

bool is_chosen(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::ranges::find(names, name) != names.end();
}

double median_of(const Series& series) {
  std::vector<double> values;
  for (const Entry* entry : series.entries)
    values.push_back(*entry->value);
  return median(values);
}

}  // namespace

core::Result<Shown> analyse(std::span<const Entry> entries, const std::vector<std::string>& tests,
                            const std::vector<std::string>& figures) {
  if (entries.empty()) return core::invalid_argument("the history has no entries");
  std::set<std::string> known_tests, known_figures;
  for (const Entry& entry : entries) {
    known_tests.insert(entry.test);
    known_figures.insert(entry.figure);
  }
  auto ok = check_names(known_tests, tests, "test");
  if (ok) ok = check_names(known_figures, figures, "figure");
  if (!ok) return tl::unexpected(ok.error());
  std::vector<Series> all = series_of(entries);
  Shown shown;
  shown.notes = remarks_on(entries, all);
  RankTails tails;
  for (Series& series : all) {
    if (!is_chosen(tests, series.first->test) || !is_chosen(figures, series.first->figure))
      continue;
    auto changes = changes_of(series, tails);
    shown.series.push_back({std::move(series), std::move(changes)});
  }
  return shown;
}

std::string to_text(const Shown& shown) {
  std::string text, test;
  for (const auto& [series, changes] : shown.series) {
    const Entry& first = *series.first;
    if (first.test != test) text += fmt::format("{}\n", test = first.test);
    const std::string name =
        first.unit.empty() ? first.figure : fmt::format("{} ({})", first.figure, first.unit);
    if (series.entries.empty()) {
      text += fmt::format("  {:<34} no usable value\n", name);
      continue;
    }
    const Entry& last = *series.entries.back();
    text += fmt::format("  {:<34} {:>6} entries  median {:<11.5g} last {:<11.5g} at {}\n", name,
                        series.entries.size(), median_of(series), *last.value, last.revision);
    text += fmt::format("    on {}\n", first.fingerprint.empty() ? "?" : first.fingerprint);
    for (const ChangePoint& change : changes) {
      const Entry& at = *series.entries[change.at];
      text += fmt::format("    {} from entry {} on, revision {}\n",
                          change_text(series.rule, change.effect), at.order, at.revision);
    }
  }
  for (const std::string& note : shown.notes)
    text += fmt::format("note: {}\n", note);
  return text;
}

}  // namespace psygen::history
