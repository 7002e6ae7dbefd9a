#include "engine/world/far/tree_impostors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include "engine/models/kit/packing.hpp"
#include "engine/world/far/impostor_raster.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using core::kImpostorSide;
using core::kImpostorViews;
using testing::game_file;

struct Forest {
  models::Registry registry = models::make_standard_registry();
  World world;
  std::shared_ptr<const ImpostorSet> pictures;

  explicit Forest(const char* file) {
    auto loaded = load_world(game_file("worlds") / file, registry);
    PSYGEN_CHECK(loaded.has_value(), "a shipped world is sound");
    world = *std::move(loaded);
    pictures = std::make_shared<const ImpostorSet>(world, registry);
  }
};

std::array<std::uint8_t, 4> texel(const core::ImpostorTexture& picture, std::uint32_t level,
                                  std::uint32_t view, std::size_t x, std::size_t y) {
  std::size_t at = 0;
  for (std::uint32_t k = 0; k < level; ++k)
    at += core::impostor_level_bytes(k);
  const std::size_t side = kImpostorSide >> level;
  at += 4 * (view * side * side + y * side + x);
  return {picture[at], picture[at + 1], picture[at + 2], picture[at + 3]};
}

// The fraction of a view's texels that is drawn.
double covered(const core::ImpostorTexture& picture, std::uint32_t level, std::uint32_t view) {
  const std::size_t side = kImpostorSide >> level;
  std::size_t count = 0;
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x)
      count += texel(picture, level, view, x, y)[3] >= 128 ? 1 : 0;
  }
  return static_cast<double>(count) / static_cast<double>(side * side);
}

// A triangle in the plane x = 0 around (0, 5, 2), red.
core::ImpostorTexture triangle_picture() {
  std::vector<Corner> corners(3);
  corners[0].position = {0, 4, 1};
  corners[1].position = {0, 4, 3};
  corners[2].position = {0, 6, 2};
  for (Corner& c : corners)
    c.colour = {1, 0, 0};
  const std::vector<std::uint16_t> indices{0, 1, 2};
  return bake_impostor(corners, indices, {4, 0, 8}, kImpostorViews);
}

TEST(TreePictures, ViewsShowTheModelFromTheirSide) {
  const core::ImpostorTexture picture = triangle_picture();
  // Looking along +x, +z is to the right; along -x, to the left. Along z the view is edge-on.
  const std::size_t middle = kImpostorSide / 2, quarter = kImpostorSide / 4;
  const std::size_t y = kImpostorSide * 3 / 8;
  EXPECT_EQ(texel(picture, 0, 0, middle + quarter, y)[3], 255);
  EXPECT_EQ(texel(picture, 0, 0, middle - quarter, y)[3], 0);
  EXPECT_EQ(texel(picture, 0, 4, middle - quarter, y)[3], 255);
  EXPECT_EQ(texel(picture, 0, 4, middle + quarter, y)[3], 0);
  EXPECT_EQ(covered(picture, 0, 2), 0);
  EXPECT_EQ(covered(picture, 0, 6), 0);
  EXPECT_NEAR(covered(picture, 0, 0), 2.0 / 64, 0.002);  // 2 of 64 square metres
  EXPECT_NEAR(covered(picture, 0, 1), 2.0 / 64 * 0.707, 0.002);
  EXPECT_GT(texel(picture, 0, 0, middle + quarter, y)[0], 100);
  EXPECT_EQ(texel(picture, 0, 0, middle + quarter, y)[1], 0);
  // Transparent texels have the colour of the others.
  EXPECT_EQ(texel(picture, 0, 0, 0, 0)[3], 0);
  EXPECT_GT(texel(picture, 0, 0, 0, 0)[0], 100);
}

TEST(TreePictures, NearerTrianglesHideThoseBehind) {
  std::vector<Corner> corners(6);
  for (std::size_t i = 0; i < 6; ++i) {
    const bool near = i < 3;  // for a viewer along +x
    corners[i].position = {near ? -1 : 1, i % 3 == 2 ? 6 : 2, i % 3 == 0 ? -2 : i % 3 == 1 ? 2 : 0};
    corners[i].colour = near ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  }
  const std::vector<std::uint16_t> indices{0, 1, 2, 3, 4, 5};
  const core::ImpostorTexture picture = bake_impostor(corners, indices, {4, 0, 8}, kImpostorViews);
  const std::size_t middle = kImpostorSide / 2;
  EXPECT_GT(texel(picture, 0, 0, middle, middle)[0], 0);
  EXPECT_EQ(texel(picture, 0, 0, middle, middle)[1], 0);
  EXPECT_EQ(texel(picture, 0, 4, middle, middle)[0], 0);
  EXPECT_GT(texel(picture, 0, 4, middle, middle)[1], 0);
}

TEST(TreePictures, SmallerLevelsKeepTheDrawnArea) {
  const Forest forest("paper.toml");
  ASSERT_GT(forest.pictures->count(), 0U);
  const core::ImpostorTexture picture = forest.pictures->bake(0);
  for (std::uint32_t view = 0; view < kImpostorViews; ++view) {
    const double all = covered(picture, 0, view);
    EXPECT_GT(all, 0.1);
    EXPECT_LT(all, 0.9);
    for (std::uint32_t level = 1; level + 1 < core::kImpostorLevels; ++level) {
      const double texels = std::pow(kImpostorSide >> level, 2);
      EXPECT_NEAR(covered(picture, level, view), all, 0.03 + 2 / texels) << view << " " << level;
    }
  }
}

TEST(TreePictures, AreTheSameOnEveryCall) {
  const Forest a("paper.toml"), b("paper.toml");
  EXPECT_EQ(a.pictures->identity(), b.pictures->identity());
  EXPECT_EQ(a.pictures->bake(1), b.pictures->bake(1));
  EXPECT_NE(a.pictures->bake(0), a.pictures->bake(1));
  EXPECT_NE(a.pictures->identity(), Forest("five_species.toml").pictures->identity());
}

TEST(TreePictures, EverySpeciesHasImpostors) {
  const Forest forest("five_species.toml");
  EXPECT_LE(forest.pictures->count(), core::kMaxImpostors);
  for (const Scatter& scatter : forest.world.scatter) {
    const models::ModelType& type = forest.registry[scatter.model];
    const bool tree = type.name() != "rock" && type.name() != "grass" && scatter.count > 0;
    BlockObstacles block(forest.world, {0, 0});
    const Scattering scattering(forest.world, type, scatter, block);
    if (tree && type.mesh_size(scattering.parameters(0), 0).triangle_count() > 1000) {
      EXPECT_TRUE(forest.pictures->has(scatter.model)) << type.name();
    }
    if (type.name() == "rock") {
      EXPECT_FALSE(forest.pictures->has(scatter.model));
    }
  }
}

TEST(TreePictures, QuadsStandWhereTheirModelsStand) {
  const Forest forest("paper.toml");
  models::Registry registry = models::make_standard_registry();
  const auto tree = static_cast<models::ModelIndex>(registry.find("tree"));
  const auto type = make_quad_type(forest.pictures, forest.registry, tree);
  for (const ImpostorModel& model : forest.pictures->models()) {
    const core::Bounds tight = registry[tree].bounds(model.parameters);
    const models::test::Mesh mesh = models::test::synthesise(*type, model.parameters, 0);
    const auto vertices = mesh.vertices<core::ModelVertex>();
    ASSERT_EQ(vertices.size(), 4U);
    for (const core::ModelVertex& v : vertices) {
      EXPECT_EQ(v.material, kLeaf | core::kBillboardBit | core::kImpostorBit);
      EXPECT_LT(v.colour[0], forest.pictures->count() * kImpostorViews);
      const glm::vec3 at = models::unpack_position(v, tight);
      EXPECT_NEAR(at.x, 0, 0.01);
      EXPECT_NEAR(at.z, 0, 0.01);
    }
    // A model shows its own impostor, or one of the same size, at its own size.
    EXPECT_EQ(forest.pictures->models()[vertices[0].colour[0] / kImpostorViews].coarse_m,
              model.coarse_m);
    EXPECT_NEAR(models::unpack_position(vertices[2], tight).y, model.frame.top_m, 0.02);
  }
}

TEST(TreePictures, ReplaceLevelsThatNoLongerLookLikeATree) {
  const Forest forest("paper.toml");
  const ImpostorModel& model = forest.pictures->models()[0];
  const int first = forest.pictures->first_level(model.model, model.parameters);
  const models::ModelType& type = forest.registry[model.model];
  EXPECT_LT(type.mesh_size(model.parameters, first).triangle_count(), 200U);
  EXPECT_GT(type.mesh_size(model.parameters, first - 1).triangle_count(), 60U);
}

// A crown that is flat, empty or huge.
TEST(TreePictures, OfStrangeModelsAreFiniteOrNone) {
  for (const float scale : {0.0F, 1e-6F, 1000.0F}) {
    std::vector<Corner> corners(3);
    corners[0].position = scale * glm::vec3(0, 0, -1);
    corners[1].position = scale * glm::vec3(0, 0, 1);
    corners[2].position = scale * glm::vec3(0, 1, 0);
    const std::vector<std::uint16_t> indices{0, 1, 2};
    const core::ImpostorTexture picture =
        bake_impostor(corners, indices, {std::max(scale, 1e-3F), 0, std::max(scale, 1e-3F)}, 8);
    EXPECT_EQ(picture.size(), core::impostor_bytes());
  }
  EXPECT_EQ(covered(bake_impostor({}, {}, {1, 0, 1}, 8), 0, 0), 0);
}

}  // namespace
}  // namespace psygen::world
