#include "engine/history/figure_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace psygen::history {
namespace {

bool has(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

FigureKind kind_of(std::string_view figure, std::string_view unit) {
  if (unit.starts_with(kVirtual)) return FigureKind::kFixedCost;
  if (has(figure, "instructions")) return FigureKind::kInstructions;
  const std::array<std::string_view, 6> times = {"s", "ms", "us", "ns", "fps", "frames/s"};
  if (std::ranges::find(times, unit) != times.end())
    return has(figure, "cpu") ? FigureKind::kProcessorTime : FigureKind::kWallTime;
  if (unit == "bytes" || unit == "B" || unit == "MiB") return FigureKind::kBytes;
  return FigureKind::kCount;
}

}  // namespace

FigureRule rule_of(std::string_view figure, std::string_view unit) {
  FigureRule rule;
  rule.kind = kind_of(figure, unit);
  rule.more_is_worse = !unit.ends_with("fps") && !unit.ends_with("frames/s");
  rule.logarithms = rule.kind != FigureKind::kCount;
  const std::array<std::string_view, 3> gating = {"load.cpu_seconds", "cpu_s", "frame_ms.p50"};
  rule.gates =
      rule.kind == FigureKind::kInstructions || std::ranges::find(gating, figure) != gating.end();
  if (!rule.logarithms) return rule;
  constexpr double kFewPercent = 1.05, kWall = 1.15;
  rule.wanted = std::log(rule.kind == FigureKind::kWallTime ? kWall : kFewPercent);
  switch (rule.kind) {
    case FigureKind::kWallTime:
      rule.floor = std::log(1.10);
      rule.has_reference = true;
      break;
    case FigureKind::kProcessorTime:
      rule.floor = std::log(1.03);
      rule.has_reference = true;
      break;
    case FigureKind::kBytes:
      rule.floor = std::log(1.03);
      break;
    default:
      rule.floor = std::log(1.01);
  }
  return rule;
}

std::string unit_of(std::string_view field) {
  if (has(field, "_ms")) return "ms";
  if (has(field, "_percent")) return "%";
  if (has(field, "bytes")) return "bytes";
  if (has(field, "_fps")) return "frames/s";
  if (has(field, "seconds") || field.ends_with("_s")) return "s";
  if (has(field, "_pixels")) return "pixels";
  return "";
}

std::string change_text(const FigureRule& rule, double change) {
  return rule.logarithms ? fmt::format("{:+.1f} %", 100 * std::expm1(change))
                         : fmt::format("{:+.3g}", change);
}

}  // namespace psygen::history
