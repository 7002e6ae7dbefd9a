// Turns the letters of a species into the grammar that kernels use, and predicts the number of
// branches. Pure, any thread. Internal to species; it validates only single rules (species.cpp does
// the rest).
#pragma once

#include "engine/models/tree/species.hpp"

namespace psygen::models {

// The right side of a rule as counts.
struct ParsedRule {
  GrammarRule rule;
  std::string fault;  // an error message; empty: none
};
// Parses SpeciesRule::to.
ParsedRule parse_rule(const Species& species, std::string_view to);
// Returns the index of a letter among the kinds, or kNoKind.
std::uint8_t kind_of(const Species& species, std::string_view symbol);
// Returns the whole grammar. Requires a species without faults in letters and rules.
Grammar grammar_of(const Species& species);

// log2 of the number of branches after some iterations: the largest over all seeds (`most`) or the
// mean. Works for any numbers, because it computes with logarithms; at most 64 steps.
double log2_branches(const Grammar& grammar, std::size_t axiom, double iterations, double branches,
                     bool most);

// Expected tips by kind and remaining iterations, as integers for paths.hpp.
using PathWeights = std::array<std::array<std::uint32_t, kMaxTreeIterations + 1>, kMaxKinds>;
// Returns the weights for a mean number of branches.
PathWeights path_weights(const Grammar& grammar, int branches);

}  // namespace psygen::models
