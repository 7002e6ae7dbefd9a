// The rules that a species must keep.
#include "engine/models/tree/species.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/models/tree/species_grammar.hpp"

namespace psygen::models {
namespace {

using Fault = std::optional<SpeciesFault>;

// Above kMaxTreeNodes, so only trees with unlucky seeds are cut short.
constexpr double kMaxLog2Branches = 13;
constexpr double kMinCrownLimit = 0.05;  // smaller crowns hold nothing

Fault fault(std::string part, std::size_t number, std::string_view field, std::string sentence,
            core::ErrorCode code = core::ErrorCode::kInvalidArgument) {
  return SpeciesFault{std::move(part), number, std::string(field), std::move(sentence), code};
}

// Records the first number outside its range.
struct NumberCheck {
  std::string part;
  std::size_t number;
  Fault& first;
  void operator()(std::string_view field, double value, const NumberSpec& spec) const {
    if (first || (value >= spec.hard.min && value <= spec.hard.max)) return;  // false for NaN
    first = fault(part, number, field,
                  fmt::format("{:g} is not allowed: it must be a number from {:g} to {:g}", value,
                              spec.hard.min, spec.hard.max));
  }
  void operator()(std::string_view field, const std::array<double, 3>& colour,
                  const NumberSpec& spec) const {
    for (const double c : colour)
      (*this)(field, c, spec);
  }
};

Fault check_numbers(const Species& s) {
  Fault first;
  visit_numbers(s, NumberCheck{"", 0, first});
  if (!first && s.crown_limit > 0 && s.crown_limit < kMinCrownLimit)
    first = fault("", 0, "crown_limit",
                  fmt::format("{:g} is not allowed: it must be 0, or a number from {:g} to 4",
                              s.crown_limit, kMinCrownLimit));
  for (std::size_t i = 0; i < s.kinds.size(); ++i)
    visit_kind_numbers(s.kinds[i], NumberCheck{"kind", i, first});
  visit_foliage_numbers(s.foliage, NumberCheck{"foliage", 0, first});
  visit_colours(s.colours, NumberCheck{"colours", 0, first});
  return first;
}

Fault check_letters(const Species& s) {
  if (s.kinds.empty() || s.kinds.size() > kMaxKinds)
    return fault("", 0, "kind", fmt::format("there must be 1 to {} kinds of branches", kMaxKinds));
  for (std::size_t i = 0; i < s.kinds.size(); ++i) {
    const SpeciesKind& k = s.kinds[i];
    const bool letter = k.symbol.size() == 1 && ((k.symbol[0] >= 'A' && k.symbol[0] <= 'Z') ||
                                                 (k.symbol[0] >= 'a' && k.symbol[0] <= 'z'));
    if (!letter) return fault("kind", i, "symbol", "it must be one letter");
    if (kind_of(s, k.symbol) != i)
      return fault("kind", i, "symbol", fmt::format("another kind has the symbol {}", k.symbol));
    if (std::ranges::find(kLeavesChoices, k.leaves) == kLeavesChoices.end())
      return fault("kind", i, "leaves", "it must be none, tips or all");
    if (k.along_low > k.along_high)
      return fault("kind", i, "along_low", "it must not be above along_high");
  }
  if (kind_of(s, s.axiom) == kNoKind)
    return fault("", 0, "axiom", fmt::format("the symbol {} is unknown: no kind has it", s.axiom));
  return {};
}

Fault check_rules(const Species& s) {
  if (s.rules.size() > kMaxRules)
    return fault("rule", kMaxRules, "from",
                 fmt::format("this is one rule more than the {} allowed ones", kMaxRules));
  std::array<double, kMaxKinds> sums{};
  for (std::size_t i = 0; i < s.rules.size(); ++i) {
    const SpeciesRule& rule = s.rules[i];
    const std::uint8_t from = kind_of(s, rule.from);
    if (from == kNoKind)
      return fault("rule", i, "from",
                   fmt::format("the symbol {} is unknown: no kind has it", rule.from));
    if (!(rule.probability > 0 && rule.probability <= 1))
      return fault(
          "rule", i, "probability",
          fmt::format("{:g} is not allowed: it must be above 0 and at most 1", rule.probability));
    sums[from] += rule.probability;
    if (ParsedRule parsed = parse_rule(s, rule.to); !parsed.fault.empty())
      return fault("rule", i, "to", std::move(parsed.fault));
  }
  for (std::size_t i = s.rules.size(); i-- > 0;) {
    const double sum = sums[kind_of(s, s.rules[i].from)];
    if (std::abs(sum - 1) > 1e-4)
      return fault("rule", i, "probability",
                   fmt::format("the probabilities of the rules of {} sum up to {:g}; it must be 1",
                               s.rules[i].from, sum));
  }
  return {};
}

// Returns the allowed range of an integer of a species.
NumberSpec range_of(const Species& s, std::string_view count) {
  NumberSpec found;
  visit_counts(s, [&](std::string_view name, std::int64_t, const NumberSpec& spec) {
    if (name == count) found = spec;
  });
  return found;
}

bool is_within(const NumberSpec& range, std::int64_t value) {
  return static_cast<double>(value) >= range.hard.min &&
         static_cast<double>(value) <= range.hard.max;
}

Fault check_growth(const Species& s) {
  if (!grammar_of(s).grows(kind_of(s, s.axiom)))
    return fault("", 0, "axiom", fmt::format("no rule replaces {}", s.axiom));
  const double log2 =
      log2_expected_branches(s, static_cast<double>(s.iterations), static_cast<double>(s.branches));
  const std::string cost =
      log2 < 40 ? fmt::format("{:.0f}", std::exp2(log2)) : fmt::format("2^{:.1f}", log2);
  const auto check = [&](std::string_view field, std::int64_t value) -> Fault {
    const NumberSpec range = range_of(s, field);
    if (is_within(range, value)) return {};
    return fault("", 0, field,
                 fmt::format("{} is not allowed: it must be an integer from {} to {} (predicted "
                             "cost: {} branches)",
                             value, range.hard.min, range.hard.max, cost));
  };
  if (Fault found = check("iterations", s.iterations)) return found;
  if (Fault found = check("branches", s.branches)) return found;
  if (log2 > kMaxLog2Branches)
    return fault("", 0, "iterations",
                 fmt::format("the grammar grows too fast (predicted cost: {} branches after {} "
                             "iterations; allowed: {:.0f})",
                             cost, s.iterations, std::exp2(kMaxLog2Branches)),
                 core::ErrorCode::kOverBudget);
  return {};
}

}  // namespace

std::optional<SpeciesFault> find_fault(const Species& s) {
  if (s.name.empty() || s.name.front() < 'a' || s.name.front() > 'z' || s.name.size() > 64 ||
      s.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos)
    return fault("", 0, "name", "it must be snake_case, of 1 to 64 letters, digits and _");
  if (const NumberSpec range = range_of(s, "spread"); !is_within(range, s.spread))
    return fault("", 0, "spread",
                 fmt::format("{} is not allowed: it must be an integer from {} to {}", s.spread,
                             range.hard.min, range.hard.max));
  if (std::ranges::find(kFoliageForms, s.foliage.form) == kFoliageForms.end())
    return fault("foliage", 0, "form", "it must be leaflets, needles, fronds, clump or none");
  if (Fault found = check_numbers(s)) return found;
  if (Fault found = check_letters(s)) return found;
  if (Fault found = check_rules(s)) return found;
  return check_growth(s);
}

core::Result<void> validate(const Species& species) {
  const auto found = find_fault(species);
  if (!found) return {};
  std::string where = found->part;
  if (where == "kind" || where == "rule") where += fmt::format("[{}]", found->number);
  if (!where.empty()) where += ".";
  return core::fail(found->code, fmt::format("species {}: {}{}: {}", species.name, where,
                                             found->field, found->sentence));
}

double log2_expected_branches(const Species& species, double iterations, double branches) {
  return log2_branches(grammar_of(species), kind_of(species, species.axiom), iterations, branches,
                       false);
}

}  // namespace psygen::models
