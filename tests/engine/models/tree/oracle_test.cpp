#include <gtest/gtest.h>

#include "engine/models/kit/simd_targets.hpp"
#include "engine/models/tree/skeleton.hpp"
#include "engine/models/tree/tree.hpp"
#include "tests/engine/models/oracle/expect_tree.hpp"

namespace psygen::models {
namespace {

using test::TreeOracle;

Parameters tree(const ModelType& type, int i) {
  core::RandomStream random(20, i, 0, 0, core::Purpose::kParameters);
  Parameters p = i % 2 == 0 ? default_parameters(type) : test::random_parameters(type, random);
  p.set_integer(kTreeSeed, 1000 + 17 * i);
  p.set_integer(kTreeIterations, 2 + i % 4);
  p.set_integer(kTreeBranches, 2 + i / 4 % 3);
  return p;
}

// Pins every instruction set in turn.
template <class Visit>
void for_targets(const Visit& visit) {
  for (const std::string_view target : simd_targets()) {
    SCOPED_TRACE(target);
    pin_simd_target(target);
    visit();
  }
  unpin_simd_target();
}

TEST(TreeOracle, CountsTheSameBranchesOfEveryKindAtEveryDepth) {
  const auto type = make_tree_type();
  for (int i = 0; i < 300; ++i) {
    Parameters p = tree(*type, i);
    if (i % 5 == 0) p.set_integer(kTreeIterations, 8);
    const TreePlan plan = plan_of_tree(p);
    const TreeOracle oracle(plan);
    for (const std::uint32_t paths : {kWholeTree, 64U, 16U}) {
      const TreeCount count = count_tree(plan, oracle.depth(), paths);
      ASSERT_EQ(count.depth, oracle.depth());
      const auto branches = oracle.grow(paths == kWholeTree ? 0 : paths);
      ASSERT_EQ(count.nodes, branches.size());
      std::size_t k = 0;
      for (std::size_t g = 0; g < count.group_count; ++g)
        for (std::uint32_t n = 0; n < count.groups[g].count; ++n, ++k) {
          ASSERT_EQ(branches[k].kind, count.groups[g].kind);
          ASSERT_EQ(branches[k].depth, count.groups[g].depth);
        }
    }
  }
}

TEST(TreeOracle, GrowsTheSameSkeletonOnEveryInstructionSet) {
  const auto type = make_tree_type();
  const auto s = std::make_unique<TreeSkeleton>();
  for_targets([&] {
    for (int i = 0; i < 16; ++i) {
      const TreePlan plan = plan_of_tree(tree(*type, i));
      const TreeOracle oracle(plan);
      for (const std::uint32_t paths : {kWholeTree, 64U, 16U}) {
        grow_tree(plan, tree_depth(plan), paths, *s);
        const auto branches = oracle.grow(paths == kWholeTree ? 0 : paths);
        const double size = static_cast<double>(plan.size_m);
        std::size_t k = 0;
        for (std::size_t g = 0; g < s->group_count; ++g) {
          for (std::uint32_t n = 0; n < s->groups[g].count; ++n, ++k) {
            const std::uint32_t at = s->groups[g].first + n;
            ASSERT_LT(k, branches.size());
            const auto& b = branches[k];
            ASSERT_EQ(b.key, s->key[at]);
            EXPECT_LT(glm::distance(b.base, glm::dvec3(s->point(at, 0))), 1e-5 * size);
            EXPECT_LT(glm::distance(b.at(1), glm::dvec3(s->point(at, 1))), 1e-5 * size);
            for (std::size_t c = 0; c < 3; ++c)
              EXPECT_NEAR(b.direction[static_cast<int>(c)],
                          static_cast<double>(s->rows[kDirection + c][at]), 1e-5);
            EXPECT_NEAR(b.start, static_cast<double>(s->rows[kRadius][at]), 1e-5 * size);
            EXPECT_EQ(s->groups[g].tip, oracle.is_tip(b));
          }
        }
        EXPECT_EQ(k, branches.size());
      }
    }
  });
}

TEST(TreeOracle, MakesEveryVertexOfEveryLevelTheSameOnEveryInstructionSet) {
  const auto type = make_tree_type();
  for_targets([&] {
    for (int i = 0; i < 24; ++i) {
      SCOPED_TRACE(i);
      const Parameters p = tree(*type, i);
      const TreePlan plan = plan_of_tree(p);
      TreeOracle oracle(plan, true);
      for (int level = 0; level < type->level_count(); ++level) {
        const test::Mesh mesh = test::synthesise(*type, p, level);
        ASSERT_NO_FATAL_FAILURE(
            expect_as_oracle(oracle, oracle.mesh(level), type->bounds(p), mesh, level));
      }
    }
  });
}

TEST(TreeTargets, GiveTheSameBytes) {
  const auto type = make_tree_type();
  std::vector<std::uint64_t> expected;
  for_targets([&] {
    std::vector<std::uint64_t> found;
    for (int i = 0; i < 60; ++i) {
      for (int level = 0; level < type->level_count(); ++level) {
        const test::Mesh mesh = test::synthesise(*type, tree(*type, i), level);
        found.push_back(core::combine(core::hash_bytes(mesh.vertex_bytes),
                                      core::hash_bytes(std::as_bytes(std::span(mesh.indices)))));
      }
    }
    if (expected.empty()) expected = found;
    EXPECT_EQ(found, expected);
  });
}

}  // namespace
}  // namespace psygen::models
