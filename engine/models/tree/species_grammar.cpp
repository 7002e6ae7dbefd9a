#include "engine/models/tree/species_grammar.hpp"

#include <fmt/format.h>

#include <cmath>

#include "engine/core/utf8.hpp"

namespace psygen::models {
namespace {

using Shares = std::array<double, kMaxKinds>;

// The starred children of a rule: the largest number (`most`) or the mean over all draws.
double star_children(const GrammarRule& rule, int spread, double branches, bool most) {
  const double fixed = rule.fixed;
  if (most) return std::max(std::max(branches + spread, 1.0) - fixed, 0.0);
  double sum = 0;
  for (int k = -spread; k <= spread; ++k)
    sum += std::max(std::max(branches + k, 1.0) - fixed, 0.0);
  return sum / (2 * spread + 1);
}

// The children of one node of a kind, by kind: the largest numbers or the means.
Shares children(const Grammar& g, std::size_t kind, double branches, bool most) {
  Shares result{};
  std::uint32_t before = 0;
  for (std::size_t r = g.first_rule[kind]; r < g.first_rule[kind + 1]; ++r) {
    const GrammarRule& rule = g.rules[r];
    const double probability = (rule.until - before) / 65536.0;
    before = rule.until;
    for (std::size_t c = 0; c < g.kinds; ++c) {
      double count = rule.count[c];
      if (rule.star == c) count += star_children(rule, g.spread, branches, most);
      if (most)
        result[c] = std::max(result[c], count);
      else
        result[c] += probability * count;
    }
  }
  return result;
}

}  // namespace

std::uint8_t kind_of(const Species& species, std::string_view symbol) {
  for (std::size_t i = 0; i < species.kinds.size(); ++i) {
    if (species.kinds[i].symbol == symbol) return static_cast<std::uint8_t>(i);
  }
  return kNoKind;
}

ParsedRule parse_rule(const Species& species, std::string_view to) {
  ParsedRule result;
  GrammarRule& rule = result.rule;
  std::uint32_t total = 0;
  for (std::size_t i = 0; i < to.size();) {
    const std::string_view letter =
        to.substr(i, core::first_code_point(to.substr(i)).bytes);  // a whole one, for messages
    i += letter.size();
    if (letter == " ") continue;
    const std::uint8_t kind = kind_of(species, letter);
    if (kind == kNoKind) {
      result.fault = fmt::format("the symbol {} is unknown: no kind has it", letter);
      return result;
    }
    if (i < to.size() && to[i] == '*') {
      ++i;
      if (rule.star != kNoKind) {
        result.fault = "only one symbol of a rule may have a star";
        return result;
      }
      rule.star = kind;
      continue;
    }
    std::uint64_t count = 0;
    const std::size_t digits = i;
    for (; i < to.size() && to[i] >= '0' && to[i] <= '9'; ++i)
      count =
          std::min<std::uint64_t>(10 * count + static_cast<std::uint64_t>(to[i] - '0'), 1 << 30);
    if (i == digits) count = 1;
    if (count == 0 || total + count > kMaxChildren) {
      result.fault = fmt::format(
          "{} branches of one node are not allowed: a rule gives 1 to {} (predicted cost: 2^{:.1f} "
          "branches after {} iterations)",
          total + count, kMaxChildren,
          static_cast<double>(species.iterations) *
              std::log2(std::max(1.0, static_cast<double>(total + count))),
          species.iterations);
      return result;
    }
    rule.count[kind] = static_cast<std::uint8_t>(rule.count[kind] + count);
    total += static_cast<std::uint32_t>(count);
  }
  rule.fixed = total;
  if (total == 0 && rule.star == kNoKind)
    result.fault = "a rule must give at least one branch; a kind that never branches has no rule";
  return result;
}

Grammar grammar_of(const Species& species) {
  Grammar g;
  g.kinds = static_cast<std::uint8_t>(species.kinds.size());
  g.spread = static_cast<int>(species.spread);
  std::size_t next = 0;
  for (std::size_t kind = 0; kind < kMaxKinds; ++kind) {
    g.first_rule[kind] = static_cast<std::uint8_t>(next);
    double sum = 0;
    for (const SpeciesRule& rule : species.rules) {
      if (kind >= g.kinds || rule.from != species.kinds[kind].symbol) continue;
      sum += rule.probability;
      g.rules[next] = parse_rule(species, rule.to).rule;
      g.rules[next++].until = static_cast<std::uint32_t>(std::floor(65536 * sum + 0.5));
    }
    if (next > g.first_rule[kind]) g.rules[next - 1].until = 65536;
  }
  g.first_rule[kMaxKinds] = static_cast<std::uint8_t>(next);
  return g;
}

double log2_branches(const Grammar& grammar, std::size_t axiom, double iterations, double branches,
                     bool most) {
  Shares now{};
  now[axiom] = 1;
  double total = 1, scale = 0;  // `now` and `total` are scaled by 2^-scale
  std::array<Shares, kMaxKinds> matrix;
  for (std::size_t kind = 0; kind < grammar.kinds; ++kind)
    matrix[kind] = children(grammar, kind, branches, most);
  double growth = 0;
  const int steps = static_cast<int>(std::clamp(iterations, 0.0, 64.0));
  for (int i = 0; i < steps; ++i) {
    Shares next{};
    for (std::size_t kind = 0; kind < grammar.kinds; ++kind)
      for (std::size_t c = 0; c < grammar.kinds; ++c)
        next[c] += now[kind] * matrix[kind][c];
    double sum = 0;
    for (const double n : next)
      sum += n;
    const double before = std::log2(total);
    total += sum;
    growth = std::log2(total) - before;
    now = next;
    const double shrink = std::exp2(-std::floor(std::log2(total)));
    scale -= std::log2(shrink);
    total *= shrink;
    for (double& n : now)
      n *= shrink;
  }
  return scale + std::log2(total) + growth * std::max(iterations - steps, 0.0);
}

PathWeights path_weights(const Grammar& grammar, int branches) {
  PathWeights result;
  std::array<Shares, kMaxKinds> matrix;
  for (std::size_t kind = 0; kind < grammar.kinds; ++kind)
    matrix[kind] = children(grammar, kind, branches, false);
  Shares tips;
  tips.fill(1);
  for (std::size_t remaining = 0; remaining <= kMaxTreeIterations; ++remaining) {
    for (std::size_t kind = 0; kind < kMaxKinds; ++kind)
      result[kind][remaining] =
          static_cast<std::uint32_t>(std::min(std::floor(16 * tips[kind] + 0.5), 16777215.0));
    Shares next = tips;
    for (std::size_t kind = 0; kind < grammar.kinds; ++kind) {
      if (!grammar.grows(kind)) continue;
      next[kind] = 0;
      for (std::size_t c = 0; c < grammar.kinds; ++c)
        next[kind] += matrix[kind][c] * tips[c];
    }
    tips = next;
  }
  return result;
}

}  // namespace psygen::models
