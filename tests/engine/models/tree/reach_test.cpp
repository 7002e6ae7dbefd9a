#include "engine/models/tree/reach.hpp"

#include <gtest/gtest.h>

#include "engine/models/tree/species.hpp"
#include "engine/models/tree/tree.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/models/oracle/tree.hpp"

namespace psygen::models {
namespace {

using Random = core::RandomStream;

// Bounds of all rings, as the oracle grows them, without clamping.
core::Bounds box_of_bark(const TreePlan& plan) {
  const test::TreeOracle oracle(plan);
  core::Bounds box{glm::vec3(1e9F), glm::vec3(-1e9F)};
  for (const auto& b : oracle.grow(0)) {
    const double end = oracle.is_tip(b) ? 0 : static_cast<double>(plan.taper);
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const double radius = b.start * (1 - t * (1 - end));
      const glm::dvec3 spread = radius * glm::sqrt(glm::dvec3(1) - b.direction * b.direction);
      box.min = glm::min(box.min, glm::vec3(b.at(t) - spread));
      box.max = glm::max(box.max, glm::vec3(b.at(t) + spread));
    }
  }
  return box;
}

::testing::AssertionResult holds_bark(const TreePlan& plan) {
  const core::Bounds bark = box_of_bark(plan);
  const glm::vec3 step = plan.bounds.half_extent() * (1.0F / 32767.0F);
  const bool holds = glm::all(glm::greaterThanEqual(bark.min, plan.bounds.min - step)) &&
                     glm::all(glm::lessThanEqual(bark.max, plan.bounds.max + step));
  if (holds) return ::testing::AssertionSuccess();
  auto failure = ::testing::AssertionFailure();
  for (int i = 0; i < 3; ++i)
    failure << "axis " << i << ": " << bark.min[i] << " … " << bark.max[i] << " in "
            << plan.bounds.min[i] << " … " << plan.bounds.max[i] << "; ";
  return failure;
}

// Returns a limit of the range in a third of the calls, else a random value.
double extreme(Random& random, double low, double high) {
  const auto which = random.next_integer(0, 5);
  return which == 0 ? low : which == 1 ? high : random.next_real(low, high);
}

TEST(TreeReach, HoldsTheBarkOfTreesWithAnyParameters) {
  const auto type = make_tree_type();
  Random random(44, 0, 0, 0, core::Purpose::kParameters);
  for (int i = 0; i < 1500; ++i) {
    Parameters p = default_parameters(*type);
    const auto specs = type->parameters();
    for (std::size_t k = 0; k < specs.size(); ++k)
      if (specs[k].type == ParameterType::kReal)
        p.set_real(k, i % 2 == 0 ? extreme(random, specs[k].hard_min, specs[k].hard_max)
                                 : extreme(random, specs[k].soft_min, specs[k].soft_max));
    p.set_integer(kTreeSeed, i);
    p.set_integer(kTreeIterations, 1 + i % 6);
    p.set_integer(kTreeBranches, 1 + i % 3);
    if (!validate(*type, p)) continue;
    ASSERT_TRUE(holds_bark(plan_of_tree(p))) << "tree " << i;
  }
}

Species extreme_species(Random& random, int i) {
  Species s;
  s.name = std::string("any");
  s.doc = std::string("any");
  const auto draw = [&](std::string_view, double& value, const NumberSpec& spec) {
    value = extreme(random, spec.hard.min, spec.hard.max);
  };
  visit_numbers(s, draw);
  s.crown_limit = i % 2 == 0 ? 0 : extreme(random, 0.05, 4);
  s.iterations = 1 + i % 6;
  s.branches = 1 + i % 3;
  s.foliage.form = std::string(i % 4 < 2 ? "none" : "leaflets");
  s.axiom = std::string("A");
  s.kinds.resize(static_cast<std::size_t>(1 + i % 4));
  for (std::size_t k = 0; k < s.kinds.size(); ++k) {
    SpeciesKind& kind = s.kinds[k];
    visit_kind_numbers(kind, draw);
    kind.along_low = std::min(kind.along_low, kind.along_high);
    kind.symbol = std::string(1, static_cast<char>('A' + k));
    kind.leader = random.next_integer(0, 1) == 0;
  }
  for (const SpeciesKind& kind : s.kinds) {
    std::string to;
    for (int n = 0; n < 2; ++n)
      to += s.kinds[static_cast<std::size_t>(
                        random.next_integer(0, static_cast<int>(s.kinds.size()) - 1))]
                .symbol;
    s.rules.push_back({kind.symbol, to, 1});
  }
  return s;
}

TEST(TreeReach, HoldsTheBarkOfSpeciesWithAnyNumbers) {
  Random random(45, 0, 0, 0, core::Purpose::kParameters);
  int tried = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto type = make_species_type(extreme_species(random, i));
    if (!type) continue;
    ++tried;
    Parameters p = default_parameters(**type);
    p.set_integer(kSpeciesSeed, i);
    ASSERT_TRUE(holds_bark(plan_of_species(**type, p))) << "species " << i;
  }
  EXPECT_GT(tried, 3000);
}

TEST(TreeReach, HoldsTrunksThatAreAsCrookedAsAllowed) {
  Species s;
  s.name = std::string("bent");
  s.doc = std::string("a trunk and its continuation");
  s.iterations = 1;
  s.trunk_curvature = 2;
  s.crown_limit = 0;
  s.axiom = std::string("T");
  SpeciesKind trunk, leader;
  trunk.symbol = std::string("T");
  leader.symbol = std::string("L");
  leader.leader = true;
  s.kinds = {trunk, leader};
  s.rules = {{"T", "L", 1}};
  s.foliage.form = std::string("none");
  const auto type = make_species_type(s).value();
  for (int seed = 0; seed < 500; ++seed) {
    Parameters p = default_parameters(*type);
    p.set_integer(kSpeciesSeed, seed);
    ASSERT_TRUE(holds_bark(plan_of_species(*type, p))) << "seed " << seed;
  }
}

TEST(TreeReach, HoldsTrunksThatAreThickerThanLong) {
  const auto tree = make_tree_type();
  Species s;
  s.name = std::string("stump");
  s.doc = std::string("stump");
  s.axiom = std::string("T");
  SpeciesKind kind;
  kind.symbol = std::string("T");
  kind.angle_deg = kind.angle_low_deg = 90;
  s.kinds = {kind};
  s.rules = {{"T", "T2", 1}};
  s.size_m = 0.1;
  s.radius_m = 3;
  s.flare = 0;
  s.foliage.form = std::string("none");
  const auto species = make_species_type(s).value();
  for (int seed = 0; seed < 200; ++seed) {
    Parameters p = default_parameters(*tree), q = default_parameters(*species);
    p.set_integer(kTreeSeed, seed);
    p.set_real(kTreeSizeM, 0.1);
    p.set_real(kTreeRadiusM, 3);
    p.set_real(kTreeFlare, 0);
    q.set_integer(kSpeciesSeed, seed);
    ASSERT_TRUE(holds_bark(plan_of_tree(p))) << "seed " << seed;
    ASSERT_TRUE(holds_bark(plan_of_species(*species, q))) << "seed " << seed;
  }
}

TEST(TreeReach, IsLittleMoreThanTreesNeed) {
  const auto type = make_tree_type();
  core::Bounds all{glm::vec3(1e9F), glm::vec3(-1e9F)};
  for (int seed = 0; seed < 300; ++seed) {
    Parameters p = default_parameters(*type);
    p.set_integer(kTreeSeed, seed);
    const core::Bounds bark = box_of_bark(plan_of_tree(p));
    all.min = glm::min(all.min, bark.min);
    all.max = glm::max(all.max, bark.max);
  }
  const core::Bounds bounds = type->bounds(default_parameters(*type));
  EXPECT_LT(bounds.max.x, 2.5F * std::max(all.max.x, -all.min.x));
  EXPECT_LT(bounds.max.y, 2.0F * all.max.y);
}

}  // namespace
}  // namespace psygen::models
