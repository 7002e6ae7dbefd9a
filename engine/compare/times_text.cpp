// Formats a comparison of frame times as text, as JSON and as a page.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/compare/times.hpp"
#include "engine/telemetry/page.hpp"
#include "engine/telemetry/units.hpp"

namespace psygen::compare {
namespace {

using Json = nlohmann::ordered_json;
using telemetry::escaped;

constexpr std::string_view kOnlyTimes = "Only frame times are compared, no images.";

std::string shown(const std::optional<double>& value, std::string_view form) {
  return value ? fmt::format(fmt::runtime(form), *value) : "–";
}

Json json_of(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json side_json(const TimesSide& side) {
  Json captures = Json::array();
  for (const captures::Capture& c : side.captures)
    captures.push_back({{"name", c.name},
                        {"tool", c.tool},
                        {"column", c.column},
                        {"meaning", captures::phrase_of(c.meaning)},
                        {"frames", c.frame_ms.size()},
                        {"notes", c.notes}});
  return {{"captures", std::move(captures)}, {"skipped", side.skipped}};
}

// Calls `each` with the lines about a side's captures.
template <class Each>
void for_each_line(const TimesSide& side, const char* name, const Each& each) {
  for (const captures::Capture& c : side.captures) {
    each(fmt::format("{}: {}, {}, {} ({}), {} frames", name, c.name, c.tool, c.column,
                     captures::phrase_of(c.meaning), c.frame_ms.size()));
    for (const std::string& note : c.notes)
      each("  " + note);
  }
  for (const std::string& sentence : side.skipped)
    each(fmt::format("{}: skipped {}", name, sentence));
}

}  // namespace

std::string to_text(const TimesComparison& comparison) {
  std::string text = fmt::format("verdict: {}\n", name_of(comparison.verdict));
  for (const std::string& reason : comparison.reasons)
    text += fmt::format("  {}\n", reason);
  for (const std::string& warning : comparison.warnings)
    text += fmt::format("warning: {}\n", warning);
  text += fmt::format("{}\n{:<12}{:>12}{:>12}{:>10}{:>10}\n", kOnlyTimes, "", "A", "B", "B/A", "p");
  for (const TimesFigure& f : comparison.figures)
    text += fmt::format("{:<12}{:>12}{:>12}{:>10}{:>10}\n", fmt::format("{} {}", f.name, f.unit),
                        shown(f.a, "{:.4f}"), shown(f.b, "{:.4f}"), shown(f.ratio, "{:.3f}"),
                        shown(f.p, "{:.4f}"));
  const auto add = [&text](const std::string& line) { text += line + "\n"; };
  for_each_line(comparison.a, "A", add);
  for_each_line(comparison.b, "B", add);
  return text;
}

std::string to_json(const TimesComparison& comparison) {
  Json json;
  json["schema"] = "psygen.times/1";
  json["verdict"] = name_of(comparison.verdict);
  json["times_only"] = true;
  json["reasons"] = comparison.reasons;
  json["warnings"] = comparison.warnings;
  json["figures"] = Json::array();
  for (const TimesFigure& f : comparison.figures)
    json["figures"].push_back({{"name", f.name},
                               {"unit", f.unit},
                               {"gates", f.gates},
                               {"a", json_of(f.a)},
                               {"b", json_of(f.b)},
                               {"ratio", json_of(f.ratio)},
                               {"p", json_of(f.p)},
                               {"unseen_percent", json_of(f.unseen_percent)},
                               {"verdict", name_of(f.verdict)}});
  json["a"] = side_json(comparison.a);
  json["b"] = side_json(comparison.b);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_html(const TimesComparison& comparison) {
  std::string html = fmt::format(
      "<h1>Comparison of captures</h1>\n<p class=\"lead\">{}</p>\n<section><b>Verdict: {}</b>\n",
      kOnlyTimes, name_of(comparison.verdict));
  for (const std::string& reason : comparison.reasons)
    html += fmt::format("<p>{}</p>\n", escaped(reason));
  for (const std::string& warning : comparison.warnings)
    html += fmt::format("<p><b>Warning:</b> {}</p>\n", escaped(warning));
  html +=
      "</section>\n<section><table><tr><th></th><td>A</td><td>B</td><td>B / A</td><td>p</td>"
      "</tr>\n";
  for (const TimesFigure& f : comparison.figures)
    html += fmt::format("<tr><th>{} {}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        f.name, f.unit, shown(f.a, "{:.4f}"), shown(f.b, "{:.4f}"),
                        shown(f.ratio, "{:.3f}"), shown(f.p, "{:.4f}"));
  html += "</table></section>\n<section>\n";
  const auto add = [&html](const std::string& line) {
    html += fmt::format("<p>{}</p>\n", escaped(line));
  };
  for_each_line(comparison.a, "A", add);
  for_each_line(comparison.b, "B", add);
  return telemetry::page_html("psygen: captures compared", "", html + "</section>\n");
}

}  // namespace psygen::compare
