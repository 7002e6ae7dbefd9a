// The rules that a species must keep.
#include "engine/models/tree/species.hpp"

#include <fmt/format.h>

#include <cmath>

#include "engine/models/tree/species_grammar.hpp"

namespace psygen::models {
namespace {

using Fault = std::optional<SpeciesFault>;

// Above kMaxTreeNodes, so only trees with unlucky seeds are cut short.
constexpr double kMaxLog2Branches = 13;
constexpr std::int64_t kMaxBranches = 8, kMaxSpread = 8;
constexpr double kLeastCrownLimit = 0.05;  // smaller crowns hold nothing

Fault fault(std::string part, std::size_t number, std::string_view field, std::string sentence,
            core::ErrorCode code = core::ErrorCode::kInvalidArgument) {
  return SpeciesFault{std::move(part), number, std::string(field), std::move(sentence), code};
}

// Remembers the first number outside its range.
struct NumberCheck {
  std::string part;
  std::size_t number;
  Fault& first;
  void operator()(std::string_view field, double value, double low, double high) const {
    if (first || (value >= low && value <= high)) return;  // false for NaN
    first = fault(part, number, field,
                  fmt::format("{:g} is not allowed: it must be a number from {:g} to {:g}", value,
                              low, high));
  }
};

Fault check_numbers(const Species& s) {
  Fault first;
  visit_numbers(s, NumberCheck{"", 0, first});
  if (!first && s.crown_limit > 0 && s.crown_limit < kLeastCrownLimit)
    first = fault("", 0, "crown_limit",
                  fmt::format("{:g} is not allowed: it must be 0, or a number from {:g} to 4",
                              s.crown_limit, kLeastCrownLimit));
  for (std::size_t i = 0; i < s.kinds.size(); ++i)
    visit_kind_numbers(s.kinds[i], NumberCheck{"kind", i, first});
  visit_foliage_numbers(s.foliage, NumberCheck{"foliage", 0, first});
  static constexpr std::string_view kSeasons[] = {"spring", "summer", "autumn", "winter"};
  const NumberCheck colours{"colours", 0, first};
  for (std::size_t i = 0; i < 4; ++i)
    for (const double c : s.colours.season[i])
      colours(kSeasons[i], c, 0, 1);
  for (const double c : s.colours.bark)
    colours("bark", c, 0, 1);
  colours("bark_contrast", s.colours.bark_contrast, 0, 0.9);
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
      return fault("kind", i, "symbol", fmt::format("another kind is called {}", k.symbol));
    if (k.leaves != "none" && k.leaves != "tips" && k.leaves != "all")
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
                 fmt::format("this is one rule more than the {} that are allowed", kMaxRules));
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

Fault check_growth(const Species& s) {
  if (!grammar_of(s).grows(kind_of(s, s.axiom)))
    return fault("", 0, "axiom", fmt::format("no rule says what {} becomes", s.axiom));
  const double log2 =
      log2_expected_branches(s, static_cast<double>(s.iterations), static_cast<double>(s.branches));
  const std::string cost =
      log2 < 40 ? fmt::format("{:.0f}", std::exp2(log2)) : fmt::format("2^{:.1f}", log2);
  const auto refuse = [&](std::string_view field, std::int64_t value, std::int64_t low,
                          std::int64_t high) {
    return fault("", 0, field,
                 fmt::format("{} is not allowed: it must be an integer from {} to {} (predicted "
                             "cost: {} branches)",
                             value, low, high, cost));
  };
  if (s.iterations < 1 || s.iterations > kMaxTreeIterations)
    return refuse("iterations", s.iterations, 1, kMaxTreeIterations);
  if (s.branches < 1 || s.branches > kMaxBranches)
    return refuse("branches", s.branches, 1, kMaxBranches);
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
  if (s.spread < 0 || s.spread > kMaxSpread)
    return fault(
        "", 0, "spread",
        fmt::format("{} is not allowed: it must be an integer from 0 to {}", s.spread, kMaxSpread));
  static constexpr std::string_view kForms[] = {"leaflets", "needles", "fronds", "clump", "none"};
  if (std::find(std::begin(kForms), std::end(kForms), s.foliage.form) == std::end(kForms))
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
