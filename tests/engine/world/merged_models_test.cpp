#include "engine/world/merged_models.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <sstream>
#include <thread>

#include "engine/models/packing.hpp"
#include "engine/models/terrain.hpp"
#include "engine/world/outline.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/world/files.hpp"

namespace psygen::world {
namespace {

using models::test::Mesh;
using models::test::synthesize;
using testing::game_file;
using testing::kSmallWorld;
using testing::replaced;

constexpr std::uint32_t kLeaf = 1;

// A world with a registry of its own and its vegetation.
struct Scenery {
  models::Registry registry = models::make_standard_registry();
  std::shared_ptr<const World> world;
  std::unique_ptr<models::ModelType> type;

  explicit Scenery(std::string_view text, std::unique_ptr<models::ModelType> own = nullptr) {
    if (own) PSYGEN_CHECK(registry.add(std::move(own)).has_value(), "the type is sound");
    auto parsed = parse_world(text, "test.toml", registry);
    PSYGEN_CHECK(parsed.has_value(), "the world of the test is sound");
    world = std::make_shared<const World>(*std::move(parsed));
    type = make_merged_type(world, registry);
  }
  Mesh mesh(core::BlockCoord node, int level) const {
    return synthesize(*type, merged_parameters(node, level), 0);
  }
  glm::vec3 corner_m(core::BlockCoord block, core::BlockCoord node, int level) const {
    const auto steps = [level](std::int32_t b, std::int32_t n) {
      return static_cast<double>(static_cast<std::uint32_t>(b) - (static_cast<std::uint32_t>(n) << level));
    };
    return {steps(block.x, node.x) * world->block_size_m(), 0,
            steps(block.z, node.z) * world->block_size_m()};
  }
};

std::string text_of(const char* file) {
  std::ifstream in(game_file("worlds") / file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

constexpr const char* kWorldFiles[] = {"paper.toml", "five_species.toml", "silver_combe.toml"};

// Metres from the node's corner of all vertices of triangles that are not degenerate.
std::vector<glm::vec3> shown_triangles(const Scenery& scenery, const Mesh& mesh, int level,
                                       core::BlockCoord node) {
  const core::Bounds box = scenery.type->bounds(merged_parameters(node, level));
  const auto vertices = mesh.vertices<core::ModelVertex>();
  std::vector<glm::vec3> corners;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    if (mesh.indices[i] == mesh.indices[i + 1]) continue;
    for (std::size_t k = 0; k < 3; ++k)
      corners.push_back(models::unpack_position(vertices[mesh.indices[i + k]], box));
  }
  return corners;
}

std::vector<Placement> placements_of(const Scenery& scenery, core::BlockCoord block) {
  std::vector<Placement> placements;
  place_models(*scenery.world, scenery.registry, block, placements);
  return placements;
}

// Blocks of a node that the world contains.
std::vector<core::BlockCoord> blocks_of(const World& world, core::BlockCoord node, int level) {
  std::vector<core::BlockCoord> blocks;
  for (std::uint32_t z = 0; z < 1U << level; ++z) {
    for (std::uint32_t x = 0; x < 1U << level; ++x) {
      const core::BlockCoord block{
          static_cast<std::int32_t>((static_cast<std::uint32_t>(node.x) << level) + x),
          static_cast<std::int32_t>((static_cast<std::uint32_t>(node.z) << level) + z)};
      if (world.contains(block)) blocks.push_back(block);
    }
  }
  return blocks;
}

struct CoarsestModel {
  Placement placement;
  glm::vec3 foot;  // in the node
  core::Bounds box;
  bool leafy;
  Silhouette silhouette;
};

std::vector<CoarsestModel> single_models(const Scenery& scenery, core::BlockCoord node,
                                         int level) {
  std::vector<CoarsestModel> all;
  CoarsestMesh mesh;
  for (const core::BlockCoord block : blocks_of(*scenery.world, node, level)) {
    for (const Placement& p : placements_of(scenery, block)) {
      const models::ModelType& type = scenery.registry[p.model];
      mesh.make(type, p.parameters);
      core::Bounds box{glm::vec3(1e9F), glm::vec3(-1e9F)};
      bool leafy = false;
      for (std::size_t i = 0; i < mesh.vertices().size(); i += sizeof(core::ModelVertex)) {
        core::ModelVertex v;
        std::memcpy(&v, mesh.vertices().data() + i, sizeof v);
        const glm::vec3 place = models::unpack_position(v, mesh.box());
        box = {glm::min(box.min, place), glm::max(box.max, place)};
        leafy = leafy || v.material == kLeaf;
      }
      all.push_back({p, scenery.corner_m(block, node, level) + p.position, box, leafy,
                     mesh.silhouette(type)});
    }
  }
  return all;
}

// Areas of the forms of a mesh, each by itself. Forms are runs of triangles that share vertices;
// those of a tree and of its trunk are two.
Silhouette area_of_forms(const Scenery& scenery, const Mesh& mesh, int level,
                         core::BlockCoord node, float least_height_m) {
  const core::Bounds box = scenery.type->bounds(merged_parameters(node, level));
  const auto vertices = mesh.vertices<core::ModelVertex>();
  Silhouette sum;
  for (std::size_t i = 0; i < mesh.indices.size();) {
    if (mesh.indices[i] == mesh.indices[i + 1]) break;
    std::size_t end = i;
    std::uint16_t first = UINT16_MAX, last = 0;
    for (; end < mesh.indices.size() && mesh.indices[end] != mesh.indices[end + 1]; end += 3) {
      const auto [low, high] = std::minmax(
          {mesh.indices[end], mesh.indices[end + 1], mesh.indices[end + 2]});
      if (end > i && low > last) break;
      first = std::min(first, low);
      last = std::max(last, high);
    }
    std::vector<glm::vec3> places;
    std::vector<std::uint16_t> indices;
    float lowest = 1e9F, highest = -1e9F;
    for (std::uint32_t v = first; v <= last; ++v) {
      places.push_back(models::unpack_position(vertices[v], box));
      lowest = std::min(lowest, places.back().y);
      highest = std::max(highest, places.back().y);
    }
    for (glm::vec3& place : places)
      place.y -= lowest;
    for (; i < end; ++i)
      indices.push_back(static_cast<std::uint16_t>(mesh.indices[i] - first));
    if (highest - lowest < least_height_m || vertices[first].material != kLeaf) continue;
    const Silhouette one = silhouette_of(places, indices);
    sum.side_m2 += one.side_m2;
    sum.plan_m2 += one.plan_m2;
  }
  return sum;
}

TEST(MergedModels, KeepTheirPromisesAtEveryNodeLevelOfEveryWorld) {
  for (const char* file : kWorldFiles) {
    const Scenery scenery(text_of(file));
    for (int level = 1; level <= kMaxMergedLevel; ++level) {
      const models::Parameters p = merged_parameters({2, 1}, level);
      const Mesh mesh = scenery.mesh({2, 1}, level);
      EXPECT_LE(mesh.size.vertex_count, 65'536U) << file;
      EXPECT_GT(mesh.size.vertex_count, 0U) << file;
      const core::Bounds box = scenery.type->bounds(p);
      const glm::vec3 slack = box.half_extent() * 1e-4F;
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(mesh.box.min, box.min - slack)));
      EXPECT_TRUE(glm::all(glm::lessThanEqual(mesh.box.max, box.max + slack)));
      for (const std::uint16_t index : mesh.indices)
        ASSERT_LT(index, mesh.size.vertex_count);
      for (const core::ModelVertex& v : mesh.vertices<core::ModelVertex>()) {
        const glm::vec3 place = models::unpack_position(v, box);
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(place, mesh.box.min - slack)) &&
                    glm::all(glm::lessThanEqual(place, mesh.box.max + slack)));
        ASSERT_LE(v.material, kLeaf);
        ASSERT_TRUE(level == 1 || v.sway == 0);
      }
      EXPECT_GT(scenery.type->complexity(p, 0), 0);
      EXPECT_NEAR(scenery.type->log2_cost(p), std::log2(mesh.size.triangle_count()), 1e-9);
    }
  }
}

TEST(MergedModels, StayBoundedInSizeByTheThirdLevel) {
  for (const char* file : kWorldFiles) {
    const Scenery scenery(text_of(file));
    const auto triangles = [&](int level) {
      return scenery.type->mesh_size(merged_parameters({0, 0}, level), 0).triangle_count();
    };
    for (int level = 4; level <= kMaxMergedLevel; ++level)
      EXPECT_LE(triangles(level), triangles(3)) << file;
    EXPECT_LE(triangles(3), 4 * triangles(2)) << file;
  }
}

TEST(MergedModels, AreTheSameOnEveryThread) {
  const Scenery scenery(text_of("five_species.toml"));
  for (int level = 1; level <= kMaxMergedLevel; ++level) {
    std::array<Mesh, 3> meshes;
    std::vector<std::thread> threads;
    for (Mesh& mesh : meshes)
      threads.emplace_back([&] { mesh = scenery.mesh({-3, 5}, level); });
    for (std::thread& thread : threads)
      thread.join();
    for (const Mesh& mesh : meshes) {
      EXPECT_EQ(mesh.vertex_bytes, meshes[0].vertex_bytes);
      EXPECT_EQ(mesh.indices, meshes[0].indices);
    }
  }
}

// At level 1 every tree is the double pyramid of its own coarsest mesh.
TEST(MergedModels, OfLevelOneHaveTheExtentsOfTheSingleTrees) {
  for (const char* file : kWorldFiles) {
    const Scenery scenery(text_of(file));
    const core::BlockCoord node{4, 3};
    const auto corners = shown_triangles(scenery, scenery.mesh(node, 1), 1, node);
    std::size_t trees = 0;
    for (const CoarsestModel& single : single_models(scenery, node, 1)) {
      if (!single.leafy || single.box.max.y < 2) continue;
      ++trees;
      // The highest corner near its place is its top; there may be a higher neighbour.
      const glm::vec3 top = single.foot + glm::vec3(0, single.box.max.y, 0);
      float nearest = 1e9F;
      for (const glm::vec3& c : corners)
        nearest = std::min(nearest, std::abs(c.y - top.y) +
                                        0.1F * (std::abs(c.x - top.x) + std::abs(c.z - top.z)));
      EXPECT_LT(nearest, 0.3F) << file;
    }
    EXPECT_GT(trees, 10U) << file;
  }
}

TEST(MergedModels, StandWhereTheSingleModelsStand) {
  const std::string text(kSmallWorld);
  const Scenery scenery(text.substr(0, text.rfind("[[scatter]]")));  // trees only
  const core::BlockCoord node{1, 0};
  for (int level = 1; level <= 2; ++level) {
    const auto corners = shown_triangles(scenery, scenery.mesh(node, level), level, node);
    const auto singles = single_models(scenery, node, level);
    const std::size_t each = corners.size() / singles.size();
    ASSERT_EQ(each * singles.size(), corners.size());
    for (std::size_t i = 0; i < corners.size(); i += each) {
      core::Bounds box{corners[i], corners[i]};
      for (std::size_t k = 0; k < each; ++k)
        box = {glm::min(box.min, corners[i + k]), glm::max(box.max, corners[i + k])};
      float best = 1e9F;
      for (const CoarsestModel& single : singles) {
        const glm::vec3 middle = single.foot + single.box.center();
        const glm::vec3 apart = box.center() - middle;
        const float top = std::abs(box.max.y - single.foot.y - single.box.max.y);
        best = std::min(best, std::max({std::abs(apart.x), std::abs(apart.z), top}));
      }
      EXPECT_LT(best, level == 1 ? 0.1F : 1.0F) << "level " << level;
    }
  }
}

// Trees of more than 2 m; smaller things are left out sooner or later.
TEST(MergedModels, CoverAsMuchOfThePictureAsTheSingleTrees) {
  for (const char* file : kWorldFiles) {
    const Scenery scenery(text_of(file));
    for (int level = 1; level <= 5; ++level) {
      const core::BlockCoord node{1, 1};
      Silhouette single;
      for (const CoarsestModel& model : single_models(scenery, node, level)) {
        if (!model.leafy || model.box.max.y < 2) continue;
        single.side_m2 += model.silhouette.side_m2;
        single.plan_m2 += model.silhouette.plan_m2;
      }
      const Silhouette merged =
          area_of_forms(scenery, scenery.mesh(node, level), level, node, 1.2F);
      std::printf("%s level %d: side %.3f plan %.3f\n", file, level,
                  merged.side_m2 / single.side_m2, merged.plan_m2 / single.plan_m2);
    }
  }
}

}  // namespace
}  // namespace psygen::world
