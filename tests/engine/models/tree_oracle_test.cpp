#include <gtest/gtest.h>

#include "engine/models/packing.hpp"
#include "engine/models/tree_skeleton.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/models/oracle_tree.hpp"

namespace psygen::models {
namespace {

using core::ModelVertex;
using test::TreeOracle;

Parameters tree(const ModelType& type, int i) {
  core::RandomStream random(20, i, 0, 0, core::Purpose::kParameters);
  Parameters p = i % 2 == 0 ? default_parameters(type) : test::random_parameters(type, random);
  p.set_integer(kTreeSeed, 1000 + 17 * i);
  p.set_integer(kTreeIterations, 2 + i % 4);
  p.set_integer(kTreeBranches, 2 + i / 4 % 3);
  return p;
}

TEST(TreeOracle, CountsTheSameBranchesAtEveryDepth) {
  const auto type = make_tree_type();
  for (int i = 0; i < 300; ++i) {
    Parameters p = tree(*type, i);
    if (i % 5 == 0) p.set_integer(kTreeIterations, 8);
    const TreeOracle oracle(p);
    const TreeCount count = count_tree(TreeShape(p));
    ASSERT_EQ(count.depth, oracle.depth());
    for (int d = 0; d <= count.depth; ++d)
      ASSERT_EQ(count.nodes[static_cast<std::size_t>(d)], oracle.nodes(d));
  }
}

TEST(TreeOracle, GrowsTheSameSkeleton) {
  const auto type = make_tree_type();
  const auto tree_skeleton = std::make_unique<TreeSkeleton>();
  for (int i = 0; i < 16; ++i) {
    const Parameters p = tree(*type, i);
    for (const std::uint32_t paths : {kWholeTree, 64U, 18U}) {
      grow_tree(TreeShape(p), tip_depth(TreeShape(p)), paths, *tree_skeleton);
      const auto branches = TreeOracle(p).grow(paths == kWholeTree ? 0 : paths);
      ASSERT_EQ(branches.size(), tree_skeleton->count);
      for (std::uint32_t k = 0; k < tree_skeleton->count; ++k) {
        const auto& b = branches[k];
        const double size = p.real(kTreeSizeM);
        ASSERT_EQ(b.key, tree_skeleton->key[k]);
        EXPECT_LT(glm::distance(b.base, glm::dvec3(tree_skeleton->base[k])), 1e-5 * size);
        EXPECT_LT(glm::distance(b.direction, glm::dvec3(tree_skeleton->direction[k])), 1e-5);
        EXPECT_LT(glm::distance(b.at(1), glm::dvec3(tree_skeleton->point(k, 1))), 1e-5 * size);
        EXPECT_NEAR(b.start, static_cast<double>(tree_skeleton->radius_start[k]), 1e-5 * size);
        EXPECT_NEAR(b.end, static_cast<double>(tree_skeleton->radius_end[k]), 1e-5 * size);
      }
    }
  }
}

TEST(TreeOracle, PlacesEveryVertexOfEveryLevelTheSame) {
  const auto type = make_tree_type();
  for (int i = 0; i < 12; ++i) {
    const Parameters p = tree(*type, i);
    const core::Bounds bounds = type->bounds(p);
    TreeOracle oracle(p);
    for (int level = 0; level < type->level_count(); ++level) {
      const auto expected = oracle.mesh(level);
      const test::Mesh mesh = test::synthesize(*type, p, level);
      const auto vertices = mesh.vertices<ModelVertex>();
      ASSERT_EQ(vertices.size(), expected.size()) << "level " << level;
      // Half a step of snorm16, plus single precision over the size of the tree.
      const double size = glm::length(glm::dvec3(bounds.half_extent()));
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        const glm::dvec3 place =
            glm::clamp(expected[k].place, glm::dvec3(bounds.min), glm::dvec3(bounds.max));
        const glm::dvec3 found(unpack_position(vertices[k], bounds));
        EXPECT_LT(glm::distance(place, found), size * (1.0 / 65534 + 1e-5)) << "vertex " << k;
        const glm::dvec3 normal(
            decode_octahedral({static_cast<float>(vertices[k].normal[0]) / 32767.0F,
                               static_cast<float>(vertices[k].normal[1]) / 32767.0F}));
        EXPECT_LT(glm::distance(expected[k].normal, normal), 2e-3) << "vertex " << k;
      }
    }
  }
}

}  // namespace
}  // namespace psygen::models
