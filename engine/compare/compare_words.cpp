#include "engine/compare/compare_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <span>

namespace psygen::compare {
namespace {

using telemetry::markdown_table;
using telemetry::markdown_text;
using telemetry::MarkdownRow;
using telemetry::Remark;
using telemetry::RemarkLevel;

RemarkLevel level_of(Verdict verdict) {
  return verdict == Verdict::kWorse          ? RemarkLevel::kError
         : verdict == Verdict::kInconclusive ? RemarkLevel::kWarning
                                             : RemarkLevel::kNotice;
}

std::string title_of(Verdict verdict) {
  return fmt::format("psygen compare: {}", name_of(verdict));
}

std::string list_of(std::span<const std::string> sentences) {
  std::string text;
  for (const std::string& sentence : sentences)
    text += "- " + markdown_text(sentence) + "\n";
  return text;
}

std::string heading_of(Verdict verdict, std::span<const std::string> reasons) {
  return fmt::format("## Comparison: {}\n\n{}", name_of(verdict), list_of(reasons));
}

Remark remark_of(Verdict verdict, std::span<const std::string> reasons,
                 const std::filesystem::path& file) {
  return {.level = level_of(verdict),
          .title = title_of(verdict),
          .message = reasons.empty() ? fmt::format("B is {}", name_of(verdict))
                                     : fmt::format("{}", fmt::join(reasons, "\n")),
          .file = file,
          .line = file.empty() ? 0 : 1};
}

void add_warnings(std::span<const std::string> sentences, std::string_view title,
                  const std::filesystem::path& file, Words& words) {
  for (const std::string& sentence : sentences)
    words.remarks.push_back({.level = RemarkLevel::kWarning,
                             .title = std::string(title),
                             .message = sentence,
                             .file = file,
                             .line = file.empty() ? 0 : 1});
}

std::string ratio_text(const MinimaTest& test, bool exact) {
  return exact ? fmt::format("{:.4f} (exact)", test.ratio)
               : fmt::format("{:.4f} ({:.3f} to {:.3f})", test.ratio, test.low, test.high);
}

std::string batches_table(const Comparison& comparison) {
  std::vector<MarkdownRow> rows;
  for (const Batch& b : comparison.batches)
    rows.push_back({std::to_string(b.pairs), std::to_string(b.frames),
                    ratio_text(b.minima, comparison.exact), b.cpu ? ratio_text(*b.cpu, false) : "–",
                    fmt::format("{:.3g}, {:.3g} %", b.missing.a, b.missing.b),
                    fmt::format("{:.3g}, {:.3g} px", b.error.a, b.error.b)});
  return markdown_table(
      {"pairs", "frames", "frame time B / A", "main thread's processor time B / A",
       "missing or coarse A, B", "error A, B"},
      rows);
}

std::string shown_table(const Comparison& comparison) {
  const auto& [a, b] = comparison.shown;
  std::vector<MarkdownRow> rows;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    rows.push_back({a[i].name, a[i].text, b[i].text});
  return rows.empty() ? "" : markdown_table({"", "A", "B"}, rows);
}

std::string shown(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "–";
}

}  // namespace

Words words_of(const Comparison& comparison, const std::filesystem::path& test) {
  Words words;
  words.markdown = heading_of(comparison.verdict, comparison.reasons);
  if (!comparison.differences.empty())
    words.markdown += "\nThe runs are not comparable:\n\n" + list_of(comparison.differences);
  words.markdown += batches_table(comparison) + shown_table(comparison);
  words.remarks.push_back(remark_of(comparison.verdict, comparison.reasons, test));
  add_warnings(comparison.differences, "psygen compare: the runs are not comparable", test, words);
  return words;
}

Words words_of(const TimesComparison& comparison) {
  Words words;
  words.markdown = heading_of(comparison.verdict, comparison.reasons);
  if (!comparison.warnings.empty())
    words.markdown += "\nWarnings:\n\n" + list_of(comparison.warnings);
  std::vector<MarkdownRow> rows;
  for (const TimesFigure& f : comparison.figures)
    rows.push_back({fmt::format("{} {}", f.name, f.unit), shown(f.a, 3), shown(f.b, 3),
                    shown(f.ratio, 3), shown(f.p, 4)});
  words.markdown += markdown_table({"figure", "A", "B", "B / A", "p"}, rows) +
                    "Only frame times are compared, no images.\n";
  words.remarks.push_back(remark_of(comparison.verdict, comparison.reasons, {}));
  add_warnings(comparison.warnings, "psygen compare", {}, words);
  return words;
}

Words words_of(const Instructions& counted) {
  const std::vector<std::string> reasons{
      fmt::format("{} and {} instructions: {:+.2f} % (limit {:g} %)", counted.a, counted.b,
                  100 * (counted.ratio() - 1), 100 * kInstructionsShare)};
  return {heading_of(counted.verdict(), reasons), {remark_of(counted.verdict(), reasons, {})}};
}

}  // namespace psygen::compare
