// A species of trees as data: a stochastic L-system whose letters are kinds of branches, and its
// appearance. Read from world files (engine/world/files/species_file.hpp) or filled in by programs.
// It is validated here and made into its own model type. Plain values, pure functions, any thread.
// Nothing is grown here (skeleton.hpp). docs/species.md.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/models/model_type.hpp"
#include "engine/models/tree/plan.hpp"

namespace psygen::models {

// One letter of the grammar: a kind of branch. Angles are measured from the parent; lengths and
// radii are relative to the parent's. The ranges are in visit_kind_numbers().
struct SpeciesKind {
  std::string symbol;   // one letter
  bool leader = false;  // continues its parent from the end, in its direction
  // At `along_high` and at `along_low`.
  double angle_deg = 45, angle_low_deg = 45;
  double angle_variation = 0.3;            // relative to the angle
  double whorl_deg = 137.508;              // around the parent, from one sibling to the next
  double along_low = 0.4, along_high = 1;  // range of positions on the parent, 0 base … 1 end
  double length = 0.75;                    // at the parent's end
  double length_low = 0.75;                // extrapolated to the parent's base
  double radius = 0.6;
  double tropism = 0, curvature = 0.4;  // bend upwards (negative: downwards); crookedness
  std::string leaves = "tips";          // "none", "tips", "all"
  friend bool operator==(const SpeciesKind&, const SpeciesKind&) = default;
};

// A rule of the grammar. `to` lists the branches that a node of kind `from` gets: letters, each
// with an optional number ("LB3": one L and three B) or a star ("LB*"). A star stands for the rest
// of a number drawn from branches ± spread.
struct SpeciesRule {
  std::string from, to;
  double probability = 1;  // above 0; the rules of one `from` add up to 1
  friend bool operator==(const SpeciesRule&, const SpeciesRule&) = default;
};

// The leaves. FoliagePlan (plan.hpp) has the meaning of the numbers, visit_foliage_numbers() their
// ranges.
struct SpeciesFoliage {
  std::string form = "leaflets";  // "leaflets", "needles", "fronds", "clump", "none"
  double random = 0.7, out = 0.7, branch = 0, up = -0.25;   // directions of sprays
  double side_random = 0.9, side_out = 0.7, side_up = 0.3;  // directions of their width
  double normal_up = 0.25, from = 0, cluster = 1, size = 1, density = 1.6;
  // Fraction of the leaves on the tree in the middle of each season.
  double density_spring = 1, density_summer = 1, density_autumn = 1, density_winter = 1;
  friend bool operator==(const SpeciesFoliage&, const SpeciesFoliage&) = default;
};

// Stored colours, 0 … 1: square roots of the linear albedo. Seasons from spring to winter.
struct SpeciesColours {
  std::array<std::array<double, 3>, 4> season = {
      {{0.36, 0.46, 0.18}, {0.23, 0.36, 0.16}, {0.64, 0.42, 0.14}, {0.40, 0.34, 0.26}}};
  std::array<double, 3> bark = {0.41, 0.36, 0.31};
  double bark_contrast = 0.14;
  friend bool operator==(const SpeciesColours&, const SpeciesColours&) = default;
};

// A whole species. The ranges are in visit_numbers().
struct Species {
  std::string name, doc;  // name: snake_case, at most 64 characters
  // 1 … 12 iterations, 1 … 8 branches (mean number drawn for a star), 0 … 8 spread.
  std::int64_t iterations = 4, branches = 3, spread = 2;
  // Length and radius of the trunk, its widening at the base, radius of a branch at its end over
  // that at its base.
  double size_m = 2.4, radius_m = 0.17, flare = 0.7, taper = 0.72, trunk_curvature = 0.3;
  double crown_limit =
      1;  // branches end within an ellipsoid of this size, 0.05 or more; 0: anywhere
  double colour_variation = 0.5;
  std::string axiom;  // symbol of the trunk
  std::vector<SpeciesKind> kinds;
  std::vector<SpeciesRule> rules;
  SpeciesFoliage foliage;
  SpeciesColours colours;
  friend bool operator==(const Species&, const Species&) = default;
};

// Allowed values of `leaves` of a kind and `form` of the foliage, and the keys of the seasons.
inline constexpr std::array<std::string_view, 3> kLeavesChoices{"none", "tips", "all"};
inline constexpr std::array<std::string_view, 5> kFoliageForms{"leaflets", "needles", "fronds",
                                                               "clump", "none"};
inline constexpr std::array<std::string_view, 4> kSeasonKeys{"spring", "summer", "autumn",
                                                             "winter"};

// Visit the integers and the numbers of a species, of a kind, of a rule and of the foliage in a
// fixed order: visit(name, value, NumberSpec).
template <class S, class Visit>
void visit_counts(S& s, const Visit& visit) {
  using Spec = NumberSpec;
  visit("iterations", s.iterations,
        Spec{{1, kMaxTreeIterations}, {1, 6}, "", "number of times that the rules apply"});
  visit("branches", s.branches, Spec{{1, 8}, {1, 6}, "", "mean number that a star fills up to"});
  visit("spread", s.spread, Spec{{0, 8}, {0, 4}, "", "variation of that number, up and down"});
}
template <class S, class Visit>
void visit_numbers(S& s, const Visit& visit) {
  using Spec = NumberSpec;
  visit("size_m", s.size_m, Spec{{0.05, 30}, {0.5, 8}, "m", "length of the trunk"});
  visit("radius_m", s.radius_m, Spec{{0.002, 3}, {0.02, 0.8}, "m", "radius of the trunk"});
  visit("flare", s.flare, Spec{{0, 3}, {0, 2}, "", "widening of the trunk at its base"});
  visit("taper", s.taper,
        Spec{{0.1, 1}, {0.5, 1}, "", "radius of every branch at its end over that at its base"});
  visit("trunk_curvature", s.trunk_curvature, Spec{{0, 2}, {0, 1}, "", "crookedness of the trunk"});
  visit("crown_limit", s.crown_limit,
        Spec{{0, 4}, {0, 2}, "", "size of the ellipsoid that limits branches; 0: none"});
  visit("colour_variation", s.colour_variation,
        Spec{{0, 1}, {0, 1}, "", "difference of the colours of two trees"});
}
template <class K, class Visit>
void visit_kind_numbers(K& k, const Visit& visit) {
  using Spec = NumberSpec;
  visit("angle_deg", k.angle_deg,
        Spec{{0, 170}, {0, 120}, "degrees", "from the parent, at the highest position on it"});
  visit("angle_low_deg", k.angle_low_deg,
        Spec{{0, 170}, {0, 120}, "degrees", "from the parent, at the lowest position on it"});
  visit("angle_variation", k.angle_variation,
        Spec{{0, 1}, {0, 1}, "", "spread of the angles, relative to the angle"});
  visit("whorl_deg", k.whorl_deg,
        Spec{{0, 360}, {0, 360}, "degrees", "around the parent from one branch to the next"});
  visit("along_low", k.along_low,
        Spec{{0, 1}, {0, 1}, "", "lowest position on the parent; 0 is its base, 1 its end"});
  visit("along_high", k.along_high,
        Spec{{0, 1}, {0, 1}, "", "highest position on the parent; 0 is its base, 1 its end"});
  visit("length", k.length,
        Spec{{0.02, 3}, {0.2, 1.5}, "", "relative to the parent's length, at the parent's end"});
  visit(
      "length_low", k.length_low,
      Spec{{0.02, 3}, {0.2, 1.5}, "", "relative to the parent's length, extrapolated to its base"});
  visit("radius", k.radius,
        Spec{{0.02, 1}, {0.2, 1}, "", "relative to the parent's radius at that position"});
  visit("tropism", k.tropism, Spec{{-2, 2}, {-1, 1}, "", "bends upwards; negative: downwards"});
  visit("curvature", k.curvature, Spec{{0, 2}, {0, 1}, "", "crookedness of the branches"});
}
template <class R, class Visit>
void visit_rule_numbers(R& r, const Visit& visit) {
  visit("probability", r.probability,
        NumberSpec{{0, 1}, {0, 1}, "", "of this rule, above 0; the rules of a kind add up to 1"});
}
template <class F, class Visit>
void visit_foliage_numbers(F& f, const Visit& visit) {
  using Spec = NumberSpec;
  constexpr Spec kShare{{0, 1}, {0, 1}, "", "fraction of the sprays on the tree in that season"};
  visit("random", f.random, Spec{{0, 2}, {0, 1}, "", "randomness of the direction of sprays"});
  visit("out", f.out, Spec{{-2, 2}, {-1, 1}, "", "tendency of sprays to point out of the crown"});
  visit("branch", f.branch,
        Spec{{-2, 2}, {-1, 1}, "", "tendency of sprays to point along the branch"});
  visit("up", f.up,
        Spec{{-2, 2}, {-1, 1}, "", "tendency of sprays to point upwards; negative: they hang"});
  visit("side_random", f.side_random,
        Spec{{0, 2}, {0, 1}, "", "randomness of the direction of their width"});
  visit("side_out", f.side_out,
        Spec{{-2, 2}, {-1, 1}, "", "tendency of their width to point out of the crown"});
  visit("side_up", f.side_up,
        Spec{{-2, 2}, {-1, 1}, "", "tendency of their width to point upwards"});
  visit("normal_up", f.normal_up, Spec{{-1, 2}, {0, 1}, "", "light from above"});
  visit("from", f.from, Spec{{0, 0.95}, {0, 0.95}, "", "position on a branch where sprays begin"});
  visit("cluster", f.cluster, Spec{{0, 2}, {0, 2}, "", "distance of sprays from the branch"});
  visit("size", f.size,
        Spec{{0.1, 3}, {0.3, 2}, "", "relative to the size that just fills the crown"});
  visit("density", f.density,
        Spec{{0.1, 64}, {0.3, 32}, "", "sprays of eight triangles per branch"});
  visit("density_spring", f.density_spring, kShare);
  visit("density_summer", f.density_summer, kShare);
  visit("density_autumn", f.density_autumn, kShare);
  visit("density_winter", f.density_winter, kShare);
}
// Visit the colours, stored as square roots of linear albedo, and their numbers.
template <class C, class Visit>
void visit_colours(C& c, const Visit& visit) {
  using Spec = NumberSpec;
  for (std::size_t i = 0; i < kSeasonKeys.size(); ++i)
    visit(kSeasonKeys[i], c.season[i], Spec{{0, 1}, {0, 1}, "", "of the leaves in that season"});
  visit("bark", c.bark, Spec{{0, 1}, {0, 1}, "", "of trunk and branches"});
  visit("bark_contrast", c.bark_contrast, Spec{{0, 0.9}, {0, 0.5}, "", "of the bark's pattern"});
}

// A fault of a species. `part` is "" (the species itself), "kind", "rule", "foliage" or "colours".
struct SpeciesFault {
  std::string part;
  std::size_t number = 0;  // of the kind or rule
  std::string field, sentence;
  core::ErrorCode code = core::ErrorCode::kInvalidArgument;
};
// Returns the first fault, or nothing. Safe for hostile values: no allocation depends on a number,
// and costs are computed as logarithms.
std::optional<SpeciesFault> find_fault(const Species& species);
// Like find_fault(), as an error: kInvalidArgument, or kOverBudget if the grammar grows too fast.
core::Result<void> validate(const Species& species);

// log2 of the expected number of branches of one unlimited tree. Requires a grammar whose letters
// are known; works for any numbers.
double log2_expected_branches(const Species& species, double iterations, double branches);

// Indices into the schema of every species.
enum SpeciesParameter : std::size_t {
  kSpeciesSeed = 0,
  kSpeciesIterations,
  kSpeciesBranches,
  kSpeciesSizeM,
  kSpeciesRadiusM,
  kSpeciesSeason,
  kSpeciesLeafScale,
  kSpeciesColourVariation,
  kSpeciesParameterCount
};

// A model type with the species' name. Its identity() changes with every number of the species.
// Fails like validate().
core::Result<std::unique_ptr<ModelType>> make_species_type(const Species& species);
// True if make_species_type() made the type.
bool is_species_type(const ModelType& type);
// Returns the plan of one tree of such a type, which must outlive the plan. Requires legal
// parameters. Other types fail an assertion, also in release.
TreePlan plan_of_species(const ModelType& type, const Parameters& p);

}  // namespace psygen::models
