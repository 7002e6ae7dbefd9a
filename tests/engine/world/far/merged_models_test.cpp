#include "engine/world/far/merged_models.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <sstream>
#include <thread>

#include "engine/models/kit/packing.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/far/node_walk.hpp"
#include "engine/world/far/outline.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/app/fence.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using models::test::Mesh;
using models::test::synthesise;
using testing::game_file;
using testing::kSmallWorld;
using testing::replaced;

// A world with its own registry and its vegetation.
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
  FarCover cover() const {
    return far_cover(*world, *far_scatters(world, registry), placed_per_block(*world, registry));
  }
  Mesh mesh(core::BlockCoord node, int level, int detail = 0) const {
    return synthesise(*type, merged_parameters(node, level), detail);
  }
  glm::vec3 corner_m(core::BlockCoord block, core::BlockCoord node, int level) const {
    const auto steps = [level](std::int32_t b, std::int32_t n) {
      return static_cast<double>(static_cast<std::uint32_t>(b) -
                                 (static_cast<std::uint32_t>(n) << level));
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

// Metres from the node's corner of all vertices of triangles that are not degenerate. Vertices of
// billboards are on their axes, or as far towards +x and +z, or −x and −z, as they can turn.
std::vector<glm::vec3> shown_triangles(const Scenery& scenery, const Mesh& mesh, int level,
                                       core::BlockCoord node, float reach = 0) {
  const core::Bounds box = scenery.type->bounds(merged_parameters(node, level));
  const auto vertices = mesh.vertices<core::ModelVertex>();
  std::vector<glm::vec3> corners;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    if (mesh.indices[i] == mesh.indices[i + 1]) continue;
    for (std::size_t k = 0; k < 3; ++k)
      corners.push_back(models::unpack_position(vertices[mesh.indices[i + k]], box) +
                        reach * core::billboard_reach_m(vertices[mesh.indices[i + k]]) *
                            glm::vec3(1, 0, 1));
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
  glm::vec3 foot;  // in the node, on its ground as it is drawn
  core::Bounds box;
  bool leafy;
  Silhouette silhouette;
};

std::vector<CoarsestModel> single_models(const Scenery& scenery, core::BlockCoord node, int level) {
  std::vector<CoarsestModel> all;
  SampleMesh mesh;
  const NodeWalk walk(*scenery.world, node, level);
  const models::BlockGround ground = walk.whole_ground(nullptr);
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
      glm::vec3 foot = scenery.corner_m(block, node, level) + p.position;
      foot.y = static_cast<float>(ground.at({foot.x, foot.z}, walk.drawn_stride()).height_m);
      all.push_back({p, foot, box, leafy, mesh.silhouette(type)});
    }
  }
  return all;
}

// The area of a billboard from any side.
Silhouette area_of_billboard(std::span<const core::ModelVertex> vertices,
                             std::span<const glm::vec3> places,
                             std::span<const std::uint16_t> indices) {
  Silhouette sum;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    glm::vec3 corners[3];  // for a viewer who looks along −z
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int16_t* aside = vertices[indices[i + k]].normal;
      corners[k] = places[indices[i + k]] +
                   glm::vec3(aside[0], 0, -aside[1]) * (core::kBillboardReachM / 32767.0F);
    }
    const glm::vec3 twice = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    sum.side_m2 += std::abs(twice.z) / 2;
    sum.plan_m2 += std::abs(twice.y) / 2;
  }
  return sum;
}

// Areas of the single forms of a mesh. Forms are runs of triangles that share vertices; a tree and
// its trunk are two forms.
Silhouette area_of_forms(const Scenery& scenery, const Mesh& mesh, int level, core::BlockCoord node,
                         float min_height_m) {
  const core::Bounds box = scenery.type->bounds(merged_parameters(node, level));
  const auto vertices = mesh.vertices<core::ModelVertex>();
  Silhouette sum;
  for (std::size_t i = 0; i < mesh.indices.size();) {
    if (mesh.indices[i] == mesh.indices[i + 1]) break;
    std::size_t end = i;
    std::uint16_t first = UINT16_MAX, last = 0;
    for (; end < mesh.indices.size() && mesh.indices[end] != mesh.indices[end + 1]; end += 3) {
      const auto [low, high] =
          std::minmax({mesh.indices[end], mesh.indices[end + 1], mesh.indices[end + 2]});
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
    const std::uint8_t material = vertices[first].material;
    if (highest - lowest < min_height_m || (material & kLeaf) == 0) continue;
    const Silhouette one =
        (material & core::kBillboardBit) != 0
            ? area_of_billboard(std::span(vertices).subspan(first), places, indices)
            : silhouette_of(places, indices);
    sum.side_m2 += one.side_m2;
    sum.plan_m2 += one.plan_m2;
  }
  return sum;
}

TEST(MergedModels, KeepTheirContractAtEveryNodeLevelOfEveryWorld) {
  for (const char* file : kWorldFiles) {
    const Scenery scenery(text_of(file));
    for (int i = 0; i < 2 * kMaxMergedLevel; ++i) {
      const int level = 1 + i / 2, detail = i % 2;
      const models::Parameters p = merged_parameters({2, 1}, level);
      const Mesh mesh = scenery.mesh({2, 1}, level, detail);
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
        const float reach = core::billboard_reach_m(v);
        const glm::vec3 around(reach, 0, reach);
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(place - around, mesh.box.min - slack)) &&
                    glm::all(glm::lessThanEqual(place + around, mesh.box.max + slack)));
        ASSERT_LE(v.material, kLeaf | core::kBillboardBit);
        ASSERT_TRUE((level == 1 && detail == 0) || v.sway == 0);
      }
      EXPECT_GT(scenery.type->complexity(p, detail), 0);
      if (detail > 0) continue;
      EXPECT_NEAR(scenery.type->log2_cost(p), std::log2(mesh.size.triangle_count()), 1e-9);
    }
  }
}

TEST(MergedModels, AreAtMostTwoFifthsAsManyTrianglesInTheCoarserLevelOfDetail) {
  const Scenery scenery(text_of("paper.toml"));
  for (int level = 1; level <= kMaxMergedLevel; ++level) {
    const models::Parameters p = merged_parameters({2, 1}, level);
    const auto triangles = [&](int detail) {
      return scenery.type->mesh_size(p, detail).triangle_count();
    };
    EXPECT_LE(5 * triangles(1), 2 * triangles(0)) << level;
    EXPECT_GT(triangles(1), 0U) << level;
    EXPECT_GT(scenery.type->level_error_m(p, 1), scenery.type->level_error_m(p, 0)) << level;
  }
}

// A mesh of all models that are too small would be empty.
TEST(MergedModels, AreNeverEmptyInTheCoarserLevelOfDetailOnly) {
  const Scenery scenery(replaced(
      text_of("paper.toml"),
      "[[scatter]]\nmodel = \"tree\"\ncount = 23\niterations = [3, 5]\nbranches = [2, 4]\n", ""));
  EXPECT_GT(scenery.type->mesh_size(merged_parameters({2, 1}, 1), 0).triangle_count(), 0U);
  for (int level = 1; level <= kMaxMergedLevel; ++level) {
    const models::Parameters p = merged_parameters({2, 1}, level);
    EXPECT_EQ(scenery.type->mesh_size(p, 0).triangle_count() > 0,
              scenery.type->mesh_size(p, 1).triangle_count() > 0)
        << level;
    const bool same =
        scenery.mesh({2, 1}, level, 0).vertex_bytes == scenery.mesh({2, 1}, level, 1).vertex_bytes;
    EXPECT_EQ(scenery.type->level_count_of(p), same ? 1 : 2) << level;
  }
}

TEST(MergedModels, StayBoundedInSizeByTheThirdLevel) {
  for (const char* file : kWorldFiles) {
    const Scenery scenery(text_of(file));
    const auto triangles = [&](int level) {
      return scenery.type->mesh_size(merged_parameters({0, 0}, level), 0).triangle_count();
    };
    for (int level = 4; level <= kMaxMergedLevel; ++level)
      EXPECT_LE(3 * triangles(level), 4 * triangles(3) + 30) << file;
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
      // The highest corner near its position is its top; a neighbour may be higher.
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

// kSmallWorld with trees only; `blocks` and `filter` are lines of its text.
std::string trees(const std::string& blocks = "blocks = [0, 0]", const std::string& filter = "") {
  const std::string text = replaced(kSmallWorld, "blocks = [8, 4]", blocks);
  return text.substr(0, text.rfind("[[scatter]]")) + filter;
}

// The mesh has one form at each placed tree. At level 1 the form has the extents of the tree's own
// crown; at level 2, which uses representatives, it has the tree's base point.
void expect_same_places(const Scenery& scenery, core::BlockCoord node, int level) {
  const Mesh mesh = scenery.mesh(node, level);
  const auto corners = shown_triangles(scenery, mesh, level, node);
  const auto low = shown_triangles(scenery, mesh, level, node, -1);
  const auto high = shown_triangles(scenery, mesh, level, node, 1);
  const auto singles = single_models(scenery, node, level);
  ASSERT_GT(singles.size(), 0U);
  const std::size_t each = corners.size() / singles.size();
  ASSERT_EQ(each * singles.size(), corners.size());
  ASSERT_EQ(each, level == 1 ? 27U : 9U);
  for (std::size_t i = 0; i < corners.size(); i += each) {
    core::Bounds box{low[i], high[i]};
    for (std::size_t k = 0; k < each; ++k)
      box = {glm::min(box.min, low[i + k]), glm::max(box.max, high[i + k])};
    const glm::vec3 foot = corners[i + each - 3];  // the trunk's, which comes last
    float best = 1e9F;
    for (const CoarsestModel& single : singles) {
      const glm::vec3 apart = box.centre() - single.foot - single.box.centre();
      const float top = std::abs(box.max.y - single.foot.y - single.box.max.y);
      const glm::vec3 beside = foot - single.foot;
      const float aside = level == 1 ? std::max(std::abs(apart.x), std::abs(apart.z))
                                     : std::max(std::abs(beside.x), std::abs(beside.z));
      const float sunk = std::max(beside.y, -0.6F - beside.y);  // roots are in the ground
      best = std::min(best, std::max({aside, level == 1 ? top : 0.1F * top, sunk}));
    }
    EXPECT_LT(best, 0.1F) << "level " << level;
  }
}

TEST(MergedModels, StandWhereTheSingleModelsStand) {
  const Scenery scenery(trees());
  for (int level = 1; level <= 2; ++level)
    expect_same_places(scenery, {3, -2}, level);
}

TEST(MergedModels, StandWhereTheSingleModelsStandAtTheEndOfAllCoordinates) {
  const Scenery scenery(trees());
  for (int level = 1; level <= 2; ++level) {
    expect_same_places(scenery, {INT32_MAX >> level, INT32_MIN >> level}, level);
    expect_same_places(scenery, {(1 << 30) >> level, -(1 << 30) >> level}, level);
  }
}

TEST(MergedModels, BeginAboveTheGroundThatIsDrawn) {
  for (const char* file : kWorldFiles) {
    const Scenery scenery(text_of(file));
    const core::BlockCoord node{1, 2};
    for (int level = 3; level <= kMaxMergedLevel; ++level) {
      const NodeWalk walk(*scenery.world, node, level);
      const models::BlockGround ground = walk.whole_ground(nullptr);
      const auto corners = shown_triangles(scenery, scenery.mesh(node, level), level, node);
      double lowest = 1e9;
      for (const glm::vec3& c : corners)
        lowest = std::min(lowest, c.y - ground.at({c.x, c.z}, walk.drawn_stride()).height_m);
      // Axes of crowns are beside the base point, where the ground is higher or lower.
      EXPECT_GT(lowest, -2.5) << file << " level " << level;
      EXPECT_LT(lowest, 3) << file << " level " << level;
    }
  }
}

// At the edge of a finite world only existing blocks have models.
TEST(MergedModels, EndWithTheWorld) {
  const Scenery scenery(trees("blocks = [3, 7]"));
  expect_same_places(scenery, {1, 3}, 1);
  expect_same_places(scenery, {0, 1}, 2);
  for (int level = 1; level <= kMaxMergedLevel; ++level) {
    const Mesh beyond = scenery.mesh({-1, 0}, level);
    EXPECT_TRUE(shown_triangles(scenery, beyond, level, {-1, 0}).empty());
    EXPECT_EQ(beyond.box.min, beyond.box.max);
    EXPECT_GT(beyond.size.vertex_count, 0U);
  }
}

TEST(MergedModels, AreFilteredAsTheSingleModelsAre) {
  const Scenery some(trees("blocks = [0, 0]", "max_slope_deg = 12\nmin_height_m = 20\n"));
  const Scenery all(trees());
  const std::size_t placed = single_models(some, {0, 0}, 2).size();
  EXPECT_LT(placed, single_models(all, {0, 0}, 2).size());
  expect_same_places(some, {0, 0}, 2);
  EXPECT_EQ(some.mesh({0, 0}, 2).size, all.mesh({0, 0}, 2).size);
  const Scenery none(trees("blocks = [0, 0]", "min_height_m = 1000\n"));
  for (int level = 1; level <= kMaxMergedLevel; ++level) {
    const auto shown = shown_triangles(none, none.mesh({0, 0}, level), level, {0, 0});
    EXPECT_TRUE(shown.empty());
  }
}

// With rivers, slopes come from a coarser lattice from level 3 on: about as many models find a
// position.
TEST(MergedModels, KeepAboutAsManyModelsOnTheCoarserGround) {
  const Scenery scenery(text_of("silver_combe.toml"));
  const core::BlockCoord node{1, 1};
  std::size_t fine = 0;
  const float least = 2;
  for (const CoarsestModel& single : single_models(scenery, node, 3))
    fine += single.leafy && single.box.max.y > least ? 1 : 0;
  const auto triangles = shown_triangles(scenery, scenery.mesh(node, 3), 3, node).size() / 3;
  EXPECT_NEAR(static_cast<double>(triangles), static_cast<double>(fine),
              0.2 * static_cast<double>(fine));
}

TEST(MergedModels, FaceOutwards) {
  const Scenery scenery(trees());
  const core::Bounds box = scenery.type->bounds(merged_parameters({0, 0}, 1));
  const Mesh mesh = scenery.mesh({0, 0}, 1);
  const auto vertices = mesh.vertices<core::ModelVertex>();
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    if ((vertices[mesh.indices[i]].material & core::kBillboardBit) != 0) continue;
    glm::vec3 places[3], normal(0.0F);
    for (std::size_t k = 0; k < 3; ++k) {
      const core::ModelVertex& v = vertices[mesh.indices[i + k]];
      places[k] = models::unpack_position(v, box);
      normal += models::decode_octahedral(glm::vec2(v.normal[0], v.normal[1]) / 32767.0F);
    }
    EXPECT_GT(glm::dot(glm::cross(places[1] - places[0], places[2] - places[0]), normal), 0);
  }
}

TEST(MergedModels, OfAUsersTypeAreBuiltFromItsCoarsestMesh) {
  const std::string fences = trees() +
                             "\n[[scatter]]\nmodel = \"fence\"\ncount = 12\n"
                             "posts = [40, 60]\nheight_m = [3, 5]\n";
  const Scenery with(fences, std::make_unique<my_game::FenceType>()), without(trees());
  for (int level = 1; level <= 3; ++level) {
    EXPECT_GT(with.mesh({0, 0}, level).size.index_count,
              without.mesh({0, 0}, level).size.index_count);
    EXPECT_GT(shown_triangles(with, with.mesh({0, 0}, level), level, {0, 0}).size(),
              shown_triangles(without, without.mesh({0, 0}, level), level, {0, 0}).size());
  }
}

constexpr const char* kGrass = "\n[[scatter]]\nmodel = \"grass\"\ncount = 40\n";

TEST(MergedModels, LeaveOutModelsThatAreInvisibleFromFar) {
  const Scenery with(trees() + kGrass), without(trees());
  for (int level = 1; level <= kMaxMergedLevel; ++level) {
    const models::Parameters p = merged_parameters({0, 0}, level);
    EXPECT_EQ(with.type->mesh_size(p, 0), without.type->mesh_size(p, 0));
    EXPECT_EQ(with.type->complexity(p, 0), without.type->complexity(p, 0));
    EXPECT_EQ(with.mesh({0, 0}, level).vertex_bytes, without.mesh({0, 0}, level).vertex_bytes);
  }
  const FarCover green = with.cover();
  const FarCover bare = without.cover();
  EXPECT_EQ(green.share, bare.share);
  EXPECT_EQ(green.albedo, bare.albedo);
}

TEST(MergedModels, OfGrassAloneAreEmpty) {
  const std::string text = trees();
  const Scenery grass(text.substr(0, text.find("[[scatter]]")) + kGrass);
  ASSERT_EQ(grass.world->scatter.size(), 1U);
  for (int level = 1; level <= kMaxMergedLevel; ++level) {
    const models::Parameters p = merged_parameters({0, 0}, level);
    EXPECT_EQ(grass.type->mesh_size(p, 0).vertex_count, 0U);
    EXPECT_EQ(grass.type->level_count_of(p), 1);
  }
  EXPECT_EQ(grass.cover().share, 0);
}

// Behaves as a fence until it is synthesised.
class ThrowingType final : public models::ModelType {
 public:
  std::string_view name() const override { return "fence"; }
  std::string_view doc() const override { return "throws"; }
  std::span<const models::ParameterSpec> parameters() const override { return {}; }
  int level_count() const override { return 1; }
  double level_error_m(const models::Parameters&, int) const override { return 0; }
  core::Bounds bounds(const models::Parameters&) const override { return {{}, glm::vec3(1)}; }
  models::MeshSize mesh_size(const models::Parameters&, int) const override { return {3, 3}; }
  double complexity(const models::Parameters&, int) const override { return 1; }
  double log2_cost(const models::Parameters&) const override { return 0; }
  core::Bounds synthesise(const models::Parameters&, int, const models::MeshView&) const override {
    throw std::runtime_error("broken");
  }
  void write_shared_indices(std::uint32_t, std::span<std::uint16_t>) const override {}
};

TEST(MergedModels, LeaveOutATypeThatThrows) {
  const std::string broken = trees() + "\n[[scatter]]\nmodel = \"fence\"\ncount = 12\n";
  const Scenery with(broken, std::make_unique<ThrowingType>()), without(trees());
  EXPECT_EQ(with.mesh({0, 0}, 1).vertex_bytes, without.mesh({0, 0}, 1).vertex_bytes);
}

TEST(MergedModels, MayRunOnTheMainThreadIfAllTheirTypesMay) {
  for (const char* file : kWorldFiles)
    EXPECT_TRUE(Scenery(text_of(file)).type->may_run_on_main_thread())
        << file << ": grass is no part";
  const std::string fences = trees() + "\n[[scatter]]\nmodel = \"fence\"\ncount = 12\n";
  const Scenery with(fences, std::make_unique<my_game::FenceType>());
  EXPECT_FALSE(with.type->may_run_on_main_thread()) << "a user's type may hang";
}

TEST(MergedModels, OfTheMostModelsThatABlockMayHaveStillFitAMesh) {
  const Scenery crowd(replaced(trees(), "count = 3", "count = 16000"));
  for (int level = 1; level <= kMaxMergedLevel; ++level) {
    const models::MeshSize size = crowd.type->mesh_size(merged_parameters({0, 0}, level), 0);
    EXPECT_LE(size.vertex_count, 65'536U);
    EXPECT_GT(size.vertex_count, 10'000U);
  }
  const Mesh mesh = crowd.mesh({0, 0}, 1);
  EXPECT_GT(shown_triangles(crowd, mesh, 1, {0, 0}).size() / 3, mesh.size.index_count / 4);
}

TEST(MergedModels, OfAnEmptyWorldAreAnEmptyMesh) {
  const std::string text = trees();
  const Scenery scenery(text.substr(0, text.find("[[scatter]]")));
  EXPECT_EQ(scenery.mesh({0, 0}, 3).size, (models::MeshSize{0, 0}));
  EXPECT_EQ(scenery.cover().share, 0);
}

TEST(MergedModels, OfDifferentWorldsHaveDifferentIdentities) {
  const std::string base(kSmallWorld);
  const std::uint64_t identity = Scenery(base).type->identity();
  EXPECT_EQ(identity, Scenery(base).type->identity());
  EXPECT_EQ(identity, Scenery(replaced(base, "\"small\"", "\"other\"")).type->identity());
  for (const auto& [from, to] : {std::pair("seed = 5", "seed = 6"),
                                 {"count = 3", "count = 4"},
                                 {"[2, 3]", "[2, 4]"},
                                 {"octaves = 4", "octaves = 5"},
                                 {"[8, 4]", "[8, 5]"},
                                 {"cell_m = 2", "cell_m = 3"},
                                 {"count = 5", "count = 5\nmax_slope_deg = 40"}})
    EXPECT_NE(identity, Scenery(replaced(base, from, to)).type->identity()) << to;
}

TEST(FarCover, GrowsWithTheNumberOfTreesAndIsGreen) {
  const auto cover = [](const std::string& text) {
    const Scenery scenery(text);
    return scenery.cover();
  };
  const FarCover few = cover(trees()), many = cover(replaced(trees(), "count = 3", "count = 300"));
  EXPECT_GT(few.share, 0);
  EXPECT_GT(many.share, 10 * few.share);
  EXPECT_LT(many.share, 1);
  EXPECT_GT(few.albedo.y, few.albedo.x);
  EXPECT_GT(few.albedo.y, few.albedo.z);
  EXPECT_LT(few.albedo.y, 0.5F);
  const FarCover none = cover(trees("blocks = [0, 0]", "min_height_m = 1000\n"));
  EXPECT_EQ(none.share, 0);
}

// Trees of more than 2 m; at some level smaller models are left out.
TEST(MergedModels, CoverAsMuchOfTheImageAsTheSingleTrees) {
  for (const char* file : kWorldFiles) {
    const Scenery scenery(text_of(file));
    for (int level = 1; level <= 4; ++level) {
      const core::BlockCoord node{1, 1};
      Silhouette single;
      for (const CoarsestModel& model : single_models(scenery, node, level)) {
        if (!model.leafy || model.box.max.y < 2) continue;
        single.side_m2 += model.silhouette.side_m2;
        single.plan_m2 += model.silhouette.plan_m2;
      }
      const Silhouette merged =
          area_of_forms(scenery, scenery.mesh(node, level), level, node, 1.2F);
      EXPECT_NEAR(merged.side_m2 / single.side_m2, 1, 0.25F) << file << " level " << level;
      // From above billboards have half the area, because a slanted view also shows their side.
      const float share = level == 1 ? 1.0F : 0.5F;
      EXPECT_NEAR(merged.plan_m2 / single.plan_m2, share, 0.25F * share)
          << file << " level " << level;
    }
  }
}

}  // namespace
}  // namespace psygen::world
