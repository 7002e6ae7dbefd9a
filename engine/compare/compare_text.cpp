// Formats a comparison as text and as JSON.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/compare/compare.hpp"

namespace psygen::compare {
namespace {

using Json = nlohmann::ordered_json;

Json finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json test_json(const MinimaTest& test) {
  return {{"ratio", finite(test.ratio)},
          {"interval", {finite(test.low), finite(test.high)}},
          {"p_slower", test.p_slower},
          {"p_faster", test.p_faster}};
}

template <class T>
Json compared_json(const Compared<T>& both) {
  return {{"a", both.a}, {"b", both.b}, {"p", both.p}};
}

Json batch_json(const Batch& b) {
  return {{"pairs", b.pairs},
          {"frames", b.frames},
          {"frame_ms", test_json(b.minima)},
          {"main_cpu_ms", b.cpu ? test_json(*b.cpu) : Json(nullptr)},
          {"hitchy_runs", compared_json(b.hitchy)},
          {"missing_percent", compared_json(b.missing)},
          {"error_pixels", compared_json(b.error)}};
}

}  // namespace

std::string to_text(const Comparison& comparison, const FalseAlarms* alarms) {
  std::string text = fmt::format("verdict: {}", name_of(comparison.verdict));
  if (comparison.verdict == Verdict::kInconclusive && comparison.noise_percent > 0)
    text += fmt::format(" (noise ±{:.1f} %)", comparison.noise_percent);
  if (!comparison.differences.empty()) text += ", although the runs are not comparable";
  text += "\n";
  for (const std::string& difference : comparison.differences)
    text += fmt::format("  {}\n", difference);
  for (const std::string& reason : comparison.reasons)
    text += fmt::format("  {}\n", reason);
  for (const Batch& b : comparison.batches) {
    text += fmt::format("{} pair{}, {} frames: frame time B/A {:.4f}", b.pairs,
                        b.pairs == 1 ? "" : "s", b.frames, b.minima.ratio);
    if (comparison.exact) {
      text += " (exact)";
    } else {
      text += fmt::format(" ({:.3f} to {:.3f}), runs with a hitch {} and {}", b.minima.low,
                          b.minima.high, b.hitchy.a, b.hitchy.b);
    }
    if (b.cpu)
      text += fmt::format(", processor time of the main thread {:.4f} ({:.3f} to {:.3f})",
                          b.cpu->ratio, b.cpu->low, b.cpu->high);
    text += fmt::format(", missing or coarse {:.3g} and {:.3g} %, error {:.3g} and {:.3g} pixels\n",
                        b.missing.a, b.missing.b, b.error.a, b.error.b);
  }
  if (comparison.batches.size() > 1)
    text += fmt::format(
        "all pairs: the 1 % of frames that changed most {:.3f}, the slowest frames take {:.2f} and "
        "{:.2f} times their typical time\n",
        comparison.tail.ratio, comparison.rare.a, comparison.rare.b);
  for (const ComparedFigure& figure : comparison.figures)
    text += fmt::format("figure {}\n", to_text(figure));
  for (std::size_t side = 0; side < comparison.shown.size(); ++side) {
    std::string line;
    for (const NamedText& each : comparison.shown[side])
      line += fmt::format("{}{} {}", line.empty() ? "" : ", ", each.name, each.text);
    if (!line.empty()) text += fmt::format("{}: {}\n", side == 0 ? "A" : "B", line);
  }
  if (alarms != nullptr)
    text += fmt::format("A against itself, {} comparisons: {} worse, {} better, {} inconclusive\n",
                        alarms->comparisons, alarms->worse, alarms->better, alarms->inconclusive);
  return text;
}

std::string to_json(const Comparison& comparison, const FalseAlarms* alarms) {
  Json json;
  json["schema"] = "psygen.compare/1";
  json["verdict"] = name_of(comparison.verdict);
  json["reasons"] = comparison.reasons;
  json["differences"] = comparison.differences;
  for (std::size_t side = 0; side < comparison.shown.size(); ++side) {
    Json& facts = json["conditions"][side == 0 ? "a" : "b"] = Json::object();
    for (const NamedText& each : comparison.shown[side])
      facts[each.name] = each.text;
  }
  json["noise_percent"] = finite(comparison.noise_percent);
  json["exact"] = comparison.exact;
  json["tail"] = {{"ratio", finite(comparison.tail.ratio)}, {"p", comparison.tail.p}};
  json["rare_frames"] = compared_json(comparison.rare);
  json["shows_as_much"] = comparison.shows_as_much;
  json["batches"] = Json::array();
  for (const Batch& batch : comparison.batches)
    json["batches"].push_back(batch_json(batch));
  json["figures"] = Json::object();
  for (const ComparedFigure& each : comparison.figures) {
    Json& figure = json["figures"][each.name] = {{"unit", each.unit}};
    if (each.note.empty()) {
      figure.update({{"a", finite(each.a)}, {"b", finite(each.b)}, {"p", each.p}});
    } else {
      figure["note"] = each.note;
    }
  }
  json["false_alarms"] = nullptr;
  if (alarms != nullptr)
    json["false_alarms"] = {{"comparisons", alarms->comparisons},
                            {"worse", alarms->worse},
                            {"better", alarms->better},
                            {"inconclusive", alarms->inconclusive}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace psygen::compare
