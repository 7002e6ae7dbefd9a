#include "engine/history/show.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace psygen::history {
namespace {

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
  auto ok = check_words(entries, tests, &Entry::test, "test");
  if (ok) ok = check_words(entries, figures, &Entry::figure, "figure");
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
