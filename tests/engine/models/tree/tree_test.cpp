#include "engine/models/tree/tree.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <memory>
#include <thread>

#include "engine/models/kit/packing.hpp"
#include "engine/models/tree/random.hpp"
#include "engine/models/tree/skeleton.hpp"
#include "tests/engine/models/mesh_helpers.hpp"

namespace psygen::models {
namespace {

using core::ModelVertex;
using test::Mesh;

Parameters with(const ModelType& type, std::int64_t seed, int iterations, int branches) {
  Parameters p = default_parameters(type);
  p.set_integer(kTreeSeed, seed);
  p.set_integer(kTreeIterations, iterations);
  p.set_integer(kTreeBranches, branches);
  return p;
}

// Uniform within the hard ranges, sometimes exactly at their ends.
Parameters anything_legal(const ModelType& type, core::RandomStream& random) {
  Parameters p;
  for (std::size_t i = 0; i < type.parameters().size(); ++i) {
    const ParameterSpec& s = type.parameters()[i];
    const std::int64_t draw = random.next_integer(0, 9);
    const double v = draw == 0   ? s.hard_min
                     : draw == 1 ? s.hard_max
                                 : random.next_real(s.hard_min, s.hard_max);
    if (i == kTreeSeed) {
      p.set_integer(i, static_cast<std::int64_t>(random.next_u64()));
    } else if (s.type == ParameterType::kInteger) {
      p.set_integer(i, std::lround(v));
    } else {
      p.set_real(i, v);
    }
  }
  return p;
}

glm::vec3 normal_of(const ModelVertex& v) {
  return decode_octahedral(
      {static_cast<float>(v.normal[0]) / 32767.0F, static_cast<float>(v.normal[1]) / 32767.0F});
}

std::vector<glm::vec3> places_of(const ModelType& type, const Parameters& p, const Mesh& mesh) {
  std::vector<glm::vec3> places;
  for (const ModelVertex& v : mesh.vertices<ModelVertex>())
    places.push_back(unpack_position(v, type.bounds(p)));
  return places;
}

TEST(Tree, WritesExactlyTheSizesThatItPredictsForAnyLegalParameters) {
  const auto type = make_tree_type();
  core::RandomStream random(11, 0, 0, 0, core::Purpose::kParameters);
  for (int i = 0; i < 120; ++i) {
    const Parameters p =
        i % 2 == 0 ? test::random_parameters(*type, random) : anything_legal(*type, random);
    for (int level = 0; level < type->level_count(); ++level) {
      const Mesh mesh = test::synthesise(*type, p, level);  // checks canaries around the mesh
      ASSERT_LE(mesh.size.vertex_count, 65536U);
      ASSERT_EQ(mesh.size.index_count % 3, 0U);
      for (const std::uint16_t index : mesh.indices)
        ASSERT_LT(index, mesh.size.vertex_count);
    }
  }
}

TEST(Tree, UsesEveryVertexAndRepeatsNoneWithinATriangle) {
  const auto type = make_tree_type();
  for (int level = 0; level < type->level_count(); ++level) {
    const Mesh mesh = test::synthesise(*type, with(*type, 5, 4, 3), level);
    std::vector<bool> used(mesh.size.vertex_count);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const std::uint16_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
      EXPECT_TRUE(a != b && b != c && c != a);
      used[a] = used[b] = used[c] = true;
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << "level " << level;
  }
}

TEST(Tree, HasAboutFiveThousandTrianglesOnAverageOverThePapersRanges) {
  const auto type = make_tree_type();
  const double wanted[] = {5000, 1180, 295, 75, 23, 11};
  double sums[6] = {};
  constexpr int kTrees = 1800;
  for (int i = 0; i < kTrees; ++i)
    for (int level = 0; level < 6; ++level)
      sums[level] +=
          type->mesh_size(with(*type, 31 * i, 3 + i % 3, 2 + i / 3 % 3), level).triangle_count();
  for (int level = 0; level < 6; ++level)
    EXPECT_NEAR(sums[level] / kTrees, wanted[level], 0.1 * wanted[level]) << "level " << level;
}

TEST(Tree, NeverHasFewerTrianglesAtAFinerLevel) {
  const auto type = make_tree_type();
  core::RandomStream random(12, 0, 0, 0, core::Purpose::kParameters);
  for (int i = 0; i < 300; ++i) {
    const Parameters p = anything_legal(*type, random);
    for (int level = 1; level < type->level_count(); ++level) {
      EXPECT_LT(type->mesh_size(p, level).triangle_count(),
                type->mesh_size(p, level - 1).triangle_count());
      EXPECT_GT(type->level_error_m(p, level), type->level_error_m(p, level - 1));
      EXPECT_LE(type->complexity(p, level), type->complexity(p, level - 1));
    }
    EXPECT_EQ(type->level_error_m(p, 0), 0.0);
  }
}

TEST(Tree, ReportsTheTightBoxOfItsVerticesInsideItsBounds) {
  const auto type = make_tree_type();
  core::RandomStream random(13, 0, 0, 0, core::Purpose::kParameters);
  for (int i = 0; i < 60; ++i) {
    const Parameters p =
        i % 3 == 0 ? anything_legal(*type, random) : test::random_parameters(*type, random);
    const core::Bounds bounds = type->bounds(p);
    const Mesh mesh = test::synthesise(*type, p, i % 6);
    glm::vec3 low(1e9F), high(-1e9F);
    for (const glm::vec3& place : places_of(*type, p, mesh)) {
      low = glm::min(low, place);
      high = glm::max(high, place);
    }
    const float tolerance = 1e-5F * glm::length(bounds.half_extent());
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(mesh.box.min[axis], low[axis], tolerance);
      EXPECT_NEAR(mesh.box.max[axis], high[axis], tolerance);
      EXPECT_GE(low[axis], bounds.min[axis] - tolerance);
      EXPECT_LE(high[axis], bounds.max[axis] + tolerance);
    }
  }
}

TEST(Tree, IsNotCutByItsBoundsWithOrdinaryParameters) {
  const auto type = make_tree_type();
  for (int i = 0; i < 300; ++i) {
    const Parameters p = with(*type, 77 * i, 3 + i % 3, 2 + i / 3 % 3);
    const core::Bounds bounds = type->bounds(p);
    const core::Bounds box = test::synthesise(*type, p, i % 6).box;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(box.min[axis], bounds.min[axis] + 1e-3F * bounds.half_extent()[axis]);
      EXPECT_LT(box.max[axis], bounds.max[axis] - 1e-3F * bounds.half_extent()[axis]);
    }
  }
}

TEST(Tree, GivesTheSameBytesOnEveryThread) {
  const auto type = make_tree_type();
  const auto hashes = [&] {
    std::vector<std::uint64_t> result;
    for (int i = 0; i < 12; ++i) {
      const Mesh mesh = test::synthesise(*type, with(*type, i, 3 + i % 2, 3), i % 6);
      result.push_back(core::hash_bytes(mesh.vertex_bytes) ^
                       core::hash_bytes(std::as_bytes(std::span(mesh.indices))));
    }
    return result;
  };
  const std::vector<std::uint64_t> expected = hashes();
  std::vector<std::uint64_t> found[4];
  std::vector<std::thread> threads;
  for (auto& result : found)
    threads.emplace_back([&result, &hashes] { result = hashes(); });
  for (std::thread& thread : threads)
    thread.join();
  for (const auto& result : found)
    EXPECT_EQ(result, expected);
}

TEST(Tree, LooksDifferentForEverySeed) {
  const auto type = make_tree_type();
  std::map<std::uint64_t, int> seen;
  for (int seed = 0; seed < 100; ++seed)
    ++seen[core::hash_bytes(test::synthesise(*type, with(*type, seed, 3, 3), 4).vertex_bytes)];
  EXPECT_EQ(seen.size(), 100U);
}

TEST(Tree, HasAtLeastOneBranchIfOneIsRequested) {
  const auto type = make_tree_type();
  for (int seed = 0; seed < 200; ++seed) {
    const TreeCount count = count_tree(plan_of_tree(with(*type, seed, 8, 1)), 8);
    EXPECT_EQ(count.depth, 8);
    EXPECT_GE(count.nodes, 9U);
  }
}

TEST(Tree, HasFromTwoFewerToTwoMoreBranchesEquallyOften) {
  const auto type = make_tree_type();
  const TreePlan plan = plan_of_tree(with(*type, 1, 4, 4));
  std::map<std::uint32_t, int> seen;
  for (std::uint32_t i = 0; i < 50000; ++i)
    ++seen[children_of(plan, 0,
                       number_of(mix32(unmixed_child_key(i, 1, 1)), plan.salt, kDrawNumber))
               .total()];
  ASSERT_EQ(seen.size(), 5U);
  for (const auto& [children, times] : seen) {
    EXPECT_TRUE(children >= 2 && children <= 6);
    EXPECT_NEAR(times, 10000, 400);
  }
}

TEST(Tree, StopsGrowingBeforeItIsTooLarge) {
  const auto type = make_tree_type();
  for (int seed = 0; seed < 20; ++seed) {
    const TreePlan plan = plan_of_tree(with(*type, seed, 8, 6));
    const TreeCount count = count_tree(plan, plan.iterations);
    EXPECT_LE(count.nodes, kMaxTreeNodes);
    EXPECT_LT(count.depth, 8);
    EXPECT_EQ(tree_depth(plan), count.depth);
  }
}

TEST(Tree, FollowsPathsWhoseBranchesAreThoseOfTheWholeTree) {
  const auto type = make_tree_type();
  const auto whole = std::make_unique<TreeSkeleton>();
  const auto some = std::make_unique<TreeSkeleton>();
  const auto for_nodes = [](const TreeSkeleton& s, const auto& visit) {
    for (std::size_t g = 0; g < s.group_count; ++g)
      for (std::uint32_t i = 0; i < s.groups[g].count; ++i)
        visit(s.groups[g].first + i);
  };
  for (int seed = 0; seed < 20; ++seed) {
    const TreePlan plan = plan_of_tree(with(*type, seed, 4, 3));
    grow_tree(plan, plan.iterations, kWholeTree, *whole);
    grow_tree(plan, whole->depth, 16, *some);
    std::map<std::uint32_t, std::uint32_t> by_key;
    for_nodes(*whole, [&](std::uint32_t i) { by_key[whole->key[i]] = i; });
    std::uint32_t tips = 0;
    for (std::size_t g = 0; g < some->group_count; ++g)
      if (some->groups[g].tip) tips += some->groups[g].count;
    EXPECT_LE(tips, 16U);
    EXPECT_GE(tips, 2U);
    for_nodes(*some, [&](std::uint32_t i) {
      ASSERT_TRUE(by_key.contains(some->key[i]));
      const std::uint32_t k = by_key[some->key[i]];
      for (std::size_t r = 0; r < kTreeRows; ++r)
        EXPECT_EQ(some->rows[r][i], whole->rows[r][k]);
    });
  }
}

TEST(Tree, CountsItsBranchesAndTheirGroupsAsSteps) {
  const auto type = make_tree_type();
  const auto grown = [](const TreePlan& plan, int depth, std::uint32_t paths) {
    const auto s = std::make_unique<TreeSkeleton>();
    grow_tree(plan, depth, paths, *s);
    double steps = 0;
    for (std::size_t g = 0; g < s->group_count; ++g)
      steps += s->groups[g].count + 12.0;
    return steps;
  };
  for (int trial = 0; trial < 60; ++trial) {
    Parameters p = default_parameters(*type);
    p.set_integer(kTreeSeed, trial);
    p.set_integer(kTreeIterations, 3 + trial % 3);
    p.set_integer(kTreeBranches, 2 + trial / 3 % 3);
    const TreePlan plan = plan_of_tree(p);
    const double whole = grown(plan, plan.iterations, kWholeTree);
    ASSERT_EQ(type->steps(p, 0), whole);
    ASSERT_EQ(type->steps(p, 1), whole);
    const double crown = grown(plan, tree_depth(plan), 16);
    ASSERT_GE(type->steps(p, 5), crown);
    ASSERT_LE(type->steps(p, 5), crown + (plan.always_complete ? 0.0 : 0.06 * kMaxTreeNodes));
    ASSERT_GT(type->steps(p, 2), type->steps(p, 3)) << "the paths of bark are grown as well";
  }
}

TEST(Tree, FindsTheSamePathsInTheWholeTreeAsItGrows) {
  const auto type = make_tree_type();
  const auto whole = std::make_unique<TreeSkeleton>();
  const auto some = std::make_unique<TreeSkeleton>();
  const auto paths = std::make_unique<TreePaths>();
  for (int seed = 0; seed < 60; ++seed) {
    const TreePlan plan = plan_of_tree(with(*type, seed, 1 + seed % 5, 1 + seed / 5 % 4));
    const std::uint32_t most = seed % 2 == 0 ? 16 : 64;
    grow_tree(plan, plan.iterations, kWholeTree, *whole);
    grow_tree(plan, whole->depth, most, *some);
    find_paths(plan, *whole, most, *paths);
    EXPECT_EQ(paths->depth, some->depth);
    std::uint32_t node = 0;
    for (std::size_t g = 0; g < some->group_count; ++g)
      for (std::uint32_t i = 0; i < some->groups[g].count; ++i, ++node) {
        ASSERT_LT(node, paths->count);
        EXPECT_EQ(paths->nodes[node].kind, some->groups[g].kind);
        EXPECT_EQ(paths->nodes[node].depth, some->groups[g].depth);
        EXPECT_EQ(whole->key[paths->nodes[node].slot], some->key[some->groups[g].first + i]);
      }
    EXPECT_EQ(node, paths->count);
  }
}

TEST(Tree, TapersAndKeepsItsDirectionsUnitVectors) {
  const auto type = make_tree_type();
  const auto tree = std::make_unique<TreeSkeleton>();
  const TreePlan plan = plan_of_tree(with(*type, 3, 5, 3));
  grow_tree(plan, plan.iterations, kWholeTree, *tree);
  float thinnest = plan.radius_m * 1.2F;
  for (std::size_t g = 0; g < tree->group_count; ++g) {
    const TreeGroup& group = tree->groups[g];
    for (std::uint32_t i = group.first; i < group.first + group.count; ++i) {
      EXPECT_LE(tree->rows[kRadius][i], thinnest);
      const glm::vec3 direction{tree->rows[kDirection][i], tree->rows[kDirection + 1][i],
                                tree->rows[kDirection + 2][i]};
      EXPECT_NEAR(glm::length(direction), 1.0F, 1e-5F);
    }
  }
}

TEST(Tree, FacesBarkAndHullsOutwards) {
  const auto type = make_tree_type();
  for (int level = 0; level < type->level_count(); ++level) {
    const Parameters p = with(*type, 9, 4, 3);
    const Mesh mesh = test::synthesise(*type, p, level);
    const auto vertices = mesh.vertices<ModelVertex>();
    const auto places = places_of(*type, p, mesh);
    int outward = 0, all = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const std::size_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
      if (level < 4 && vertices[a].material != 0) continue;
      const glm::vec3 face = glm::cross(places[b] - places[a], places[c] - places[a]);
      const glm::vec3 shading =
          normal_of(vertices[a]) + normal_of(vertices[b]) + normal_of(vertices[c]);
      ++all;
      outward += glm::dot(face, shading) > 0 ? 1 : 0;
    }
    EXPECT_GT(all, 0);
    EXPECT_GE(outward, all * 99 / 100) << "level " << level;
  }
}

TEST(Tree, SwaysMoreTowardsItsTwigsAndNotAtItsBase) {
  const auto type = make_tree_type();
  const Parameters p = with(*type, 21, 4, 3);
  for (int level = 0; level < type->level_count(); ++level) {
    const Mesh mesh = test::synthesise(*type, p, level);
    const auto vertices = mesh.vertices<ModelVertex>();
    const auto places = places_of(*type, p, mesh);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const bool leaf = vertices[i].material == 1, below_foot = places[i].y < 0.0F;
      EXPECT_GE(vertices[i].sway, leaf ? 200 : 0);
      EXPECT_LE(vertices[i].sway, below_foot ? 20 : 255);
    }
  }
}

TEST(Tree, KeepsPositionSizeAndColourOfItsCrownAtEveryLevel) {
  const auto type = make_tree_type();
  for (int seed = 0; seed < 12; ++seed) {
    const Parameters p = with(*type, seed, 4, 3);
    glm::vec3 centre[6], colour[6];
    float spread[6] = {};
    for (int level = 0; level < 6; ++level) {
      const Mesh mesh = test::synthesise(*type, p, level);
      const auto vertices = mesh.vertices<ModelVertex>();
      const auto places = places_of(*type, p, mesh);
      glm::vec3 sum(0), squares(0), tint(0);
      float leaves = 0;
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (vertices[i].material == 0) continue;
        ++leaves;
        sum += places[i];
        squares += places[i] * places[i];
        tint += glm::vec3(vertices[i].colour[0], vertices[i].colour[1], vertices[i].colour[2]);
      }
      centre[level] = sum / leaves;
      colour[level] = tint / leaves;
      const glm::vec3 variance = squares / leaves - centre[level] * centre[level];
      spread[level] = std::sqrt(variance.x + variance.y + variance.z);
    }
    for (int level = 1; level < 6; ++level) {
      EXPECT_LT(glm::distance(centre[level], centre[0]), 0.75F * spread[0]) << "level " << level;
      EXPECT_LT(glm::distance(colour[level], colour[0]), 24.0F) << "level " << level;
      EXPECT_GT(spread[level], 0.6F * spread[0]) << "level " << level;
      EXPECT_LT(spread[level], (level < 4 ? 1.6F : 2.2F) * spread[0]) << "level " << level;
    }
  }
}

TEST(Tree, CostsBranchesToThePowerOfIterations) {
  const auto type = make_tree_type();
  EXPECT_DOUBLE_EQ(type->complexity(with(*type, 1, 5, 4), 0), 1024.0);
  EXPECT_DOUBLE_EQ(type->complexity(with(*type, 2, 3, 2), 0), 8.0);
}

TEST(Tree, RejectsHostileParametersWithoutOverflow) {
  const auto type = make_tree_type();
  const double inf = std::numeric_limits<double>::infinity();
  const auto refused = [&](std::size_t i, double real, std::int64_t integer) {
    Parameters p = default_parameters(*type);
    if (type->parameters()[i].type == ParameterType::kReal)
      p.set_real(i, real);
    else
      p.set_integer(i, integer);
    const auto result = validate(*type, p);
    return !result && result.error().message.find(type->parameters()[i].name) != std::string::npos;
  };
  for (std::size_t i = 1; i < kTreeParameterCount; ++i)
    for (const double v : {inf, -inf, std::nan(""), 1e300, -1e300})
      EXPECT_TRUE(refused(i, v, v > 0 ? 1000000000 : -1000000000)) << type->parameters()[i].name;
  EXPECT_TRUE(refused(kTreeIterations, 0, 1000));
  EXPECT_TRUE(refused(kTreeIterations, 0, 0));
  EXPECT_TRUE(refused(kTreeBranches, 0, INT64_MAX));
  EXPECT_TRUE(refused(kTreeBranches, 0, INT64_MIN));
  EXPECT_NEAR(type->log2_cost(with(*type, 1, 1000, 1000000000)), 1000 * std::log2(1e9), 100);
  EXPECT_TRUE(validate(*type, with(*type, 1, 8, 6)).has_value());
}

TEST(Tree, PredictsACostThatNoSeedExceeds) {
  const auto type = make_tree_type();
  for (int i = 0; i < 2000; ++i) {
    const Parameters p = with(*type, i, 1 + i % 8, 1 + i / 8 % 6);
    EXPECT_GE(type->log2_cost(p), std::log2(type->mesh_size(p, 0).triangle_count()));
  }
}

}  // namespace
}  // namespace psygen::models
