// From the letters of a species to the grammar that kernels use, and what it predicts. Internal to
// species.
#pragma once

#include "engine/models/tree/species.hpp"

namespace psygen::models {

// `to` of a rule, as counts. Faults are sentences; empty: none.
struct ParsedRule {
  GrammarRule rule;
  std::string fault;
};
ParsedRule parse_rule(const Species& species, std::string_view to);
// The position of a letter among the kinds, or kNoKind.
std::uint8_t kind_of(const Species& species, std::string_view symbol);
// Requires a species without faults in letters and rules.
Grammar grammar_of(const Species& species);

// Numbers of branches by iteration. `most`: the largest that any seed could have; else the mean.
// Works for any numbers, as logarithms.
double log2_branches(const Grammar& grammar, std::size_t axiom, double iterations, double branches,
                     bool most);

// Expected tips per kind and remaining iterations, scaled for paths.hpp.
using PathWeights = std::array<std::array<std::uint32_t, kMaxTreeIterations + 1>, kMaxKinds>;
PathWeights path_weights(const Grammar& grammar, int branches);

}  // namespace psygen::models
