// Random numbers of trees: 32-bit hashes keyed on a branch's path from the root. lanes-inl.hpp has
// the same functions for SIMD lanes. Pure, any thread, constant time. Internal to trees.
#pragma once

#include <cstdint>

#include "engine/models/kit/mix32.hpp"
#include "engine/models/tree/plan.hpp"

namespace psygen::models {

inline constexpr std::uint32_t kChildStep = 0x9E3779B9U;   // between the keys of siblings
inline constexpr std::uint32_t kNumberStep = 0x85EBCA6BU;  // between the numbers of a branch
// The purpose of each number of a branch. Numbers 0 … 3 shape it.
enum : std::uint32_t { kDrawNumber = 4, kBarkNumber = 5, kTintNumber = 6, kHullNumber = 16 };
inline constexpr std::uint32_t kSprayNumber = 0x40000000U;

// Returns the unmixed key of a branch; its key is mix32() of the result. `parent` is the parent's
// mixed key.
constexpr std::uint32_t unmixed_child_key(std::uint32_t parent, std::size_t kind,
                                          std::uint32_t rank) {
  return parent + kChildStep * (static_cast<std::uint32_t>(kind) * kMaxChildren + rank + 1);
}
// Random number `number` of the branch with this key.
constexpr std::uint32_t number_of(std::uint32_t key, std::uint32_t salt, std::uint32_t number) {
  return mix32(key ^ (salt + number * kNumberStep));
}
// The lower and the upper 16 bits of a hash as fractions in [0, 1).
constexpr float low_fraction(std::uint32_t h) {
  return static_cast<float>(static_cast<std::int32_t>(h & 0xFFFFU)) * (1.0F / 65536.0F);
}
constexpr float high_fraction(std::uint32_t h) {
  return static_cast<float>(static_cast<std::int32_t>(h >> 16)) * (1.0F / 65536.0F);
}

// Numbers of children by kind.
using ChildTotals = std::array<std::uint32_t, kMaxKinds>;

// The children of a node: a rule, and the number of its starred kind. The grammar owns the rule.
struct Children {
  const GrammarRule* rule;
  std::uint32_t star;
  // Number of children of one kind, and of all children.
  std::uint32_t of_kind(std::size_t kind) const {
    return rule->count[kind] + (rule->star == kind ? star : 0U);
  }
  std::uint32_t total() const { return rule->fixed + star; }
};
// Returns the number of children of the starred kind that a rule gives a node with this draw.
inline std::uint32_t star_count(const TreePlan& plan, const GrammarRule& rule, std::uint32_t draw) {
  const int spread = plan.grammar->spread;
  const auto range = static_cast<std::uint32_t>(2 * spread + 1);
  const int drawn = plan.branches - spread + static_cast<int>(((draw >> 16) * range) >> 16);
  return static_cast<std::uint32_t>(std::max(std::max(drawn, 1) - static_cast<int>(rule.fixed), 0));
}
// Adds the children of `count` nodes of a kind that grows, with these draws, to the totals of each
// kind. If the kind has one rule, writes their star_count() to `stars`. Reads and writes up to a
// vector beyond the end.
void count_children(const TreePlan& plan, std::size_t kind, const std::uint32_t* draws,
                    std::uint32_t count, std::uint32_t* stars, ChildTotals& totals);
// Mixes `count` keys in place and writes the draws of these branches. Reads and writes up to a
// vector beyond the end.
void draw_numbers(std::uint32_t salt, std::uint32_t count, std::uint32_t* keys,
                  std::uint32_t* draws);
// Returns the rule of a kind that has exactly one; else null.
inline const GrammarRule* only_rule(const Grammar& g, std::size_t kind) {
  return g.first_rule[kind] + 1 == g.first_rule[kind + 1] ? &g.rules[g.first_rule[kind]] : nullptr;
}
// Returns the children of a node from its draw. Its kind must have rules (Grammar::grows).
inline Children children_of(const TreePlan& plan, std::size_t kind, std::uint32_t draw) {
  const Grammar& g = *plan.grammar;
  const GrammarRule* rule = &g.rules[g.first_rule[kind]];
  while ((draw & 0xFFFFU) >= rule->until)
    ++rule;
  return {rule, rule->star == kNoKind ? 0 : star_count(plan, *rule, draw)};
}

}  // namespace psygen::models
