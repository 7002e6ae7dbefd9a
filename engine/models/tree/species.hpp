// A species of trees as data: a stochastic L-system whose letters are kinds of branches, and its
// looks. Read from world files (engine/world/files/species_file.hpp) or filled in by programs. It
// is validated here and made into a model type of its own. Plain values, pure functions, any
// thread. Nothing is grown here (skeleton.hpp). docs/species.md.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
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
  double along_low = 0.4, along_high = 1;  // range of places on the parent, 0 foot … 1 end
  double length = 0.75;                    // at the parent's end
  double length_low = 0.75;                // extrapolated to the parent's foot
  double radius = 0.6;
  double tropism = 0, curvature = 0.4;  // bend upwards (negative: downwards); crookedness
  std::string leaves = "tips";          // "none", "tips", "all"
  friend bool operator==(const SpeciesKind&, const SpeciesKind&) = default;
};

// A rule of the grammar. `to` lists the branches that a node of kind `from` gets: letters, each
// with an optional number ("LB3": one L and three B) or a star ("LB*"). A star stands for as many
// as are missing from the number drawn from branches ± spread.
struct SpeciesRule {
  std::string from, to;
  double probability = 1;  // above 0; those of one `from` sum up to 1
  friend bool operator==(const SpeciesRule&, const SpeciesRule&) = default;
};

// The leaves. FoliagePlan (plan.hpp) has the meaning of the numbers, visit_foliage_numbers() their
// ranges.
struct SpeciesFoliage {
  std::string form = "leaflets";  // "leaflets", "needles", "fronds", "clump", "none"
  double random = 0.7, out = 0.7, branch = 0, up = -0.25;   // directions of sprays
  double side_random = 0.9, side_out = 0.7, side_up = 0.3;  // directions of their width
  double normal_up = 0.25, from = 0, cluster = 1, size = 1, density = 1.6;
  // Share of the leaves on the tree in the middle of each season.
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
  // Length and radius of the trunk, its widening at the foot, radius of a branch at its end over
  // that at its foot.
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

// Visit the numbers of a species, of a kind and of the foliage in a fixed order, with their allowed
// ranges: visit(name, value, lowest, highest).
template <class S, class Visit>
void visit_numbers(S& s, const Visit& visit) {
  visit("size_m", s.size_m, 0.05, 30.0);
  visit("radius_m", s.radius_m, 0.002, 3.0);
  visit("flare", s.flare, 0.0, 3.0);
  visit("taper", s.taper, 0.1, 1.0);
  visit("trunk_curvature", s.trunk_curvature, 0.0, 2.0);
  visit("crown_limit", s.crown_limit, 0.0, 4.0);
  visit("colour_variation", s.colour_variation, 0.0, 1.0);
}
template <class K, class Visit>
void visit_kind_numbers(K& k, const Visit& visit) {
  visit("angle_deg", k.angle_deg, 0.0, 170.0);
  visit("angle_low_deg", k.angle_low_deg, 0.0, 170.0);
  visit("angle_variation", k.angle_variation, 0.0, 1.0);
  visit("whorl_deg", k.whorl_deg, 0.0, 360.0);
  visit("along_low", k.along_low, 0.0, 1.0);
  visit("along_high", k.along_high, 0.0, 1.0);
  visit("length", k.length, 0.02, 3.0);
  visit("length_low", k.length_low, 0.02, 3.0);
  visit("radius", k.radius, 0.02, 1.0);
  visit("tropism", k.tropism, -2.0, 2.0);
  visit("curvature", k.curvature, 0.0, 2.0);
}
template <class F, class Visit>
void visit_foliage_numbers(F& f, const Visit& visit) {
  visit("random", f.random, 0.0, 2.0);
  visit("out", f.out, -2.0, 2.0);
  visit("branch", f.branch, -2.0, 2.0);
  visit("up", f.up, -2.0, 2.0);
  visit("side_random", f.side_random, 0.0, 2.0);
  visit("side_out", f.side_out, -2.0, 2.0);
  visit("side_up", f.side_up, -2.0, 2.0);
  visit("normal_up", f.normal_up, -1.0, 2.0);
  visit("from", f.from, 0.0, 0.95);
  visit("cluster", f.cluster, 0.0, 2.0);
  visit("size", f.size, 0.1, 3.0);
  visit("density", f.density, 0.1, 64.0);
  visit("density_spring", f.density_spring, 0.0, 1.0);
  visit("density_summer", f.density_summer, 0.0, 1.0);
  visit("density_autumn", f.density_autumn, 0.0, 1.0);
  visit("density_winter", f.density_winter, 0.0, 1.0);
}

// A fault of a species. `part` is "" (the species itself), "kind", "rule", "foliage" or "colours".
struct SpeciesFault {
  std::string part;
  std::size_t number = 0;  // of the kind or rule
  std::string field, sentence;
  core::ErrorCode code = core::ErrorCode::kInvalidArgument;
};
// The first fault, or nothing. Safe for hostile values: no allocation depends on a number, and
// costs are computed as logarithms.
std::optional<SpeciesFault> find_fault(const Species& species);
// The same as an error: kInvalidArgument, or kOverBudget if the grammar grows too fast.
core::Result<void> validate(const Species& species);

// log2 of the expected number of branches of one tree without any limit. Requires a grammar whose
// letters are known; works for any numbers.
double log2_expected_branches(const Species& species, double iterations, double branches);

// Positions in the schema of every species.
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
// Whether a type was made by make_species_type().
bool is_species_type(const ModelType& type);
// The plan of one tree of such a type, which must outlive the plan. Requires legal parameters.
// Other types fail an assertion, also in release.
TreePlan plan_of_species(const ModelType& type, const Parameters& p);

}  // namespace psygen::models
