#include "engine/compare/own_figures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/compare/recorded_run.hpp"
#include "engine/compare/statistics.hpp"
#include "engine/telemetry/statistics.hpp"

namespace psygen::compare {
namespace {

using Runs = std::span<const RecordedRun>;

const RecordedFigure* find(const RecordedRun& run, const std::string& name) {
  const auto found = std::ranges::find(run.figures, name, &RecordedFigure::name);
  return found == run.figures.end() ? nullptr : &*found;
}

// The means of a figure in the runs that have it, and what speaks against a comparison.
struct Side {
  std::vector<double> means;
  std::size_t lacking = 0, without_value = 0;
  std::string other_unit;
  bool has_other_unit = false;
};

Side side_of(Runs runs, const RecordedFigure& figure) {
  Side side;
  for (const RecordedRun& run : runs) {
    const RecordedFigure* found = find(run, figure.name);
    if (found == nullptr) {
      ++side.lacking;
      continue;
    }
    if (found->unit != figure.unit) {
      side.has_other_unit = true;
      side.other_unit = found->unit;
    }
    found->mean ? side.means.push_back(*found->mean) : void(++side.without_value);
  }
  return side;
}

std::string unit_text(const std::string& unit) {
  return unit.empty() ? "none" : unit;
}

std::string note_of(const Side& a, const Side& b, const RecordedFigure& figure, std::size_t runs) {
  for (const Side* side : {&a, &b})
    if (side->has_other_unit)
      return fmt::format("not compared: its unit is {} and {}", unit_text(figure.unit),
                         unit_text(side->other_unit));
  if (const std::size_t lacking = a.lacking + b.lacking; lacking > 0)
    return fmt::format("not compared: {} of {} runs lack it", lacking, runs);
  if (const std::size_t without = a.without_value + b.without_value; without > 0)
    return fmt::format("not compared: {} of {} runs have no value", without, runs);
  return {};
}

ComparedFigure compared(const RecordedFigure& figure, Runs a, Runs b) {
  ComparedFigure result{figure.name, figure.unit, 0, 0, 1, {}};
  const Side of_a = side_of(a, figure), of_b = side_of(b, figure);
  result.note = note_of(of_a, of_b, figure, a.size() + b.size());
  if (!result.note.empty()) return result;
  result.a = *telemetry::mean(of_a.means);
  result.b = *telemetry::mean(of_b.means);
  if (a.size() > 1) result.p = mann_whitney(of_a.means, of_b.means);
  return result;
}

}  // namespace

std::vector<ComparedFigure> compare_figures(Runs a, Runs b) {
  std::vector<ComparedFigure> all;
  for (const Runs runs : {a, b})
    for (const RecordedRun& run : runs)
      for (const RecordedFigure& figure : run.figures)
        if (std::ranges::find(all, figure.name, &ComparedFigure::name) == all.end())
          all.push_back(compared(figure, a, b));
  return all;
}

std::string to_text(const ComparedFigure& figure) {
  if (!figure.note.empty()) return fmt::format("{}: {}", figure.name, figure.note);
  std::string text = fmt::format("{}: {:.4g} and {:.4g}{}{}", figure.name, figure.a, figure.b,
                                 figure.unit.empty() ? "" : " ", figure.unit);
  if (figure.a > 0) text += fmt::format(", B/A {:.4f}", figure.b / figure.a);
  return text + (figure.p < 1 ? fmt::format(" (p {:.3f})", figure.p) : "");
}

}  // namespace psygen::compare
