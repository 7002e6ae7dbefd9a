#include "engine/frametest/budget_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "engine/core/nearest_word.hpp"
#include "engine/telemetry/own_figures.hpp"
#include "engine/telemetry/summary_fields.hpp"

namespace psygen::frametest {
namespace {

constexpr std::string_view kSections = "sections.";

// Fields whose middle is a name that only the flight knows: "system_ms.NAME.p50".
struct NamedFields {
  std::string_view prefix, label;
  std::vector<std::string_view> ends;
  std::vector<std::string_view> texts = {};  // ends that only [equal] can compare
};

const std::vector<NamedFields>& named_fields() {
  static const std::vector<NamedFields> kFields{
      {"system_ms.", "times of systems have", {"p50", "p99"}},
      {"pass_ms.", "times of passes have", {"p50", "p99", "max"}},
      {"figures.",
       "figures of the game have",
       {"mean", "min", "p50", "p95", "p99", "max", "frames", "invalid", "unit", "kind"},
       {"unit", "kind"}},
      {"marks.", "marks have", {"count", "frame", "time_s"}},
  };
  return kFields;
}

bool has(const auto& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

// Returns nothing for fields without such a name.
std::optional<std::string> problem_of_named(std::string_view field, Relation relation) {
  for (const NamedFields& named : named_fields()) {
    if (!field.starts_with(named.prefix)) continue;
    const std::size_t dot = field.rfind('.');
    const std::string_view end = field.substr(dot + 1);
    if (dot < named.prefix.size() || !has(named.ends, end))
      return fmt::format("{} only {}", named.label,
                         fmt::join(named.ends, named.ends.size() > 2 ? ", " : " and "));
    if (relation != Relation::kEqual && has(named.texts, end))
      return "it is a text, which only [equal] can compare";
    return "";
  }
  return std::nullopt;
}

}  // namespace

SectionField section_field(std::string_view field,
                           std::span<const telemetry::SectionRange> sections) {
  if (!field.starts_with(kSections)) return {};
  const std::string_view rest = field.substr(kSections.size());
  for (const telemetry::SectionRange& section : sections) {
    const std::size_t length = section.name.size();
    if (rest.starts_with(section.name) && rest.size() > length && rest[length] == '.')
      return {rest.substr(0, length), rest.substr(length + 1)};
  }
  return {};
}

KnownFields::KnownFields() {
  telemetry::Summary nothing;
  nothing.sections.emplace_back().range.name = "NAME";
  const std::string prefix = std::string(kSections) + "NAME.";
  for (const telemetry::SummaryField& field : telemetry::summary_fields(nothing)) {
    if (field.name.starts_with(prefix)) {
      section_names_.push_back(field.name.substr(prefix.size()));
      continue;
    }
    names_.push_back(field.name);
    if (std::holds_alternative<std::string>(field.value)) texts_.push_back(field.name);
  }
}

std::string KnownFields::problem(const Budget& budget,
                                 std::span<const telemetry::SectionRange> sections) const {
  if (budget.field.starts_with(kSections)) return problem_in_section(budget, sections);
  if (const auto problem = problem_of_named(budget.field, budget.relation)) return *problem;
  if (!has(names_, budget.field))
    return "summary.json has no such field" + core::suggestion(budget.field, names_);
  if (budget.relation != Relation::kEqual &&
      (has(texts_, budget.field) || budget.field.starts_with("hash.")))
    return "it is a text, which only [equal] can compare";
  return {};
}

std::string KnownFields::problem_in_section(
    const Budget& budget, std::span<const telemetry::SectionRange> sections) const {
  const auto [section, field] = section_field(budget.field, sections);
  if (section.empty())
    return "the file has no such section: it needs a table [sections.NAME] with from";
  if (const auto problem = problem_of_named(field, budget.relation)) return *problem;
  if (!has(section_names_, field))
    return "sections have no such field" + core::suggestion(field, section_names_);
  return {};
}

}  // namespace psygen::frametest
