// Formats the result of a check as text, as JSON, and for a pull request.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/history/check.hpp"

namespace psygen::history {
namespace {

using Json = nlohmann::ordered_json;

std::string value_text(double value, const std::string& unit) {
  return unit.empty() ? fmt::format("{:.5g}", value) : fmt::format("{:.5g} {}", value, unit);
}

Json witness_json(const Witness& witness) {
  return {{"p", witness.p},
          {"effect", witness.effect},
          {"spread", witness.spread},
          {"found", witness.found}};
}

}  // namespace

std::string to_text(const CheckResult& result) {
  std::string text = fmt::format("verdict: {}\n", name_of(result.outcome));
  for (const bool gates : {true, false}) {
    for (const JudgedFigure& f : result.figures) {
      if (f.gates != gates) continue;
      text += fmt::format("  {}{} {} at {}: {}: {}\n", gates ? "" : "(shown) ", f.test, f.figure,
                          f.revision, name_of(f.verdict.outcome), f.verdict.reason);
      if (gates && f.verdict.outcome != Outcome::kTooFew)
        text += fmt::format("    {} -> {}, {} entries before and {} after\n",
                            value_text(f.before, f.unit), value_text(f.after, f.unit),
                            f.verdict.before, f.verdict.after);
    }
  }
  for (const std::string& note : result.notes)
    text += fmt::format("note: {}\n", note);
  return text;
}

std::string to_json(const CheckResult& result) {
  Json json;
  json["schema"] = "psygen.history-check/1";
  json["verdict"] = name_of(result.outcome);
  json["figures"] = Json::array();
  for (const JudgedFigure& f : result.figures)
    json["figures"].push_back(
        {{"test", f.test},
         {"figure", f.figure},
         {"unit", f.unit},
         {"revision", f.revision},
         {"fingerprint", f.fingerprint},
         {"gates", f.gates},
         {"verdict", name_of(f.verdict.outcome)},
         {"reason", f.verdict.reason},
         {"scale", f.rule.logarithms ? "logarithm" : "difference"},
         {"entries_before", f.verdict.before},
         {"entries_after", f.verdict.after},
         {"looks", f.verdict.looks},
         {"before", f.before},
         {"after", f.after},
         {"unseen", f.verdict.unseen},
         {"figure_test", witness_json(f.verdict.figure)},
         {"ratio_test", f.verdict.ratio ? witness_json(*f.verdict.ratio) : Json(nullptr)}});
  json["notes"] = result.notes;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_markdown(const CheckResult& result) {
  using telemetry::markdown_text;
  std::string text = fmt::format("## History: {}\n", name_of(result.outcome));
  std::vector<telemetry::MarkdownRow> rows;
  for (const JudgedFigure& f : result.figures)
    if (f.gates)
      rows.push_back({f.test, f.figure, f.revision, value_text(f.before, f.unit),
                      value_text(f.after, f.unit), std::string(name_of(f.verdict.outcome)),
                      f.verdict.reason});
  text += telemetry::markdown_table(
      {"test", "figure", "revision", "before", "after", "verdict", "reason"}, rows);
  for (const std::string& note : result.notes)
    text += "- " + markdown_text(note) + "\n";
  return text;
}

std::vector<telemetry::Remark> remarks_of(const CheckResult& result) {
  using enum telemetry::RemarkLevel;
  std::vector<telemetry::Remark> remarks;
  for (const JudgedFigure& f : result.figures) {
    if (!f.gates) continue;
    const Outcome outcome = f.verdict.outcome;
    const bool is_quiet = outcome == Outcome::kSame || outcome == Outcome::kBetter;
    remarks.push_back(
        {.level = outcome == Outcome::kWorse ? kError
                  : is_quiet                 ? kNotice
                                             : kWarning,
         .title = fmt::format("psygen history: {} {} {}", f.test, f.figure, name_of(outcome)),
         .message = fmt::format("{}: {}", f.revision, f.verdict.reason),
         .file = {}});
  }
  for (const std::string& note : result.notes)
    remarks.push_back({.level = kNotice, .title = "psygen history", .message = note, .file = {}});
  return remarks;
}

}  // namespace psygen::history
