#include "engine/scene/draws/ground.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/ext/matrix_transform.hpp>
#include <set>

#include "engine/core/camera.hpp"

namespace psygen::scene {
namespace {

constexpr std::uint32_t kAll = (1U << 9) - 1;

// A node of 63 m with tiles of 21 m, whose corner is here relative to a camera that looks north
// (−z).
struct Fixture {
  models::TerrainGrid grid{64, 1};
  models::TerrainTiles fine{64};
  GroundOccluder occluder;
  View view;
  glm::vec3 corner;

  explicit Fixture(glm::vec3 at) : corner(at) {
    const core::Projection projection;
    view.frustum = visibility::make_frustum(core::projection_matrix(projection) *
                                            core::view_rotation(core::CameraPose{}));
    occluder.top_m.fill(2);
  }
  NodeTiles tiles() const { return {grid, occluder, corner, 1.0F, -5.0F}; }
  NodeTiles fine_tiles() const { return {fine.grid(), occluder, corner, 1.0F, -5.0F}; }

  std::vector<render::TerrainDraw> draws(std::uint32_t in_view) const {
    std::vector<render::TerrainDraw> list;
    render::TerrainDraw draw;
    draw.morph = 0.5F;
    add_tiles(tiles(), in_view, nullptr, 0, draw, list);
    return list;
  }
};

// A ridge across the view, at this distance and height.
void add_ridge(View& view, float distance_m, float height_m) {
  const std::vector<glm::vec3> line{{-2 * distance_m, height_m, -distance_m},
                                    {2 * distance_m, height_m, -distance_m}};
  view.horizon.add(line);
}

std::set<std::uint32_t> indices_of(const std::vector<render::TerrainDraw>& draws) {
  std::set<std::uint32_t> all;
  for (const render::TerrainDraw& draw : draws) {
    for (std::uint32_t i = 0; i < draw.part.count; ++i)
      EXPECT_TRUE(all.insert(draw.part.first + i).second) << "nothing is drawn twice";
  }
  return all;
}

void insert(core::IndexPart part, std::set<std::uint32_t>& all) {
  for (std::uint32_t i = 0; i < part.count; ++i)
    all.insert(part.first + i);
}

TEST(GroundDraws, TilesInTheFrustumAreInViewAndOthersAreNot) {
  EXPECT_EQ(tiles_in_view(Fixture({-31, -10, -200}).tiles(), Fixture({}).view), kAll);
  EXPECT_EQ(tiles_in_view(Fixture({-31, -10, 100}).tiles(), Fixture({}).view), 0U);
  // 50 m ahead the picture is 86 m wide.
  const Fixture right({40, -10, -113});
  const std::uint32_t seen = tiles_in_view(right.tiles(), right.view);
  EXPECT_NE(seen, 0U);
  EXPECT_NE(seen, kAll);
  EXPECT_NE(seen & 1U, 0U);         // far and left
  EXPECT_EQ(seen & (1U << 8), 0U);  // near and right
}

TEST(GroundDraws, TilesBehindARidgeAreHiddenOnlyIfTheyAreLower) {
  Fixture node({-31, -10, -263});
  add_ridge(node.view, 150, -6);
  EXPECT_EQ(tiles_in_view(node.tiles(), node.view), kAll);  // tops at −8 m are seen over it
  node.occluder.top_m.fill(-2);
  EXPECT_EQ(tiles_in_view(node.tiles(), node.view), 0U);
  node.occluder.top_m[4] = 3;
  EXPECT_EQ(tiles_in_view(node.tiles(), node.view), 1U << 4);
}

TEST(GroundDraws, AllTilesAreOneDrawWithTheSkirtsThatFaceTheCamera) {
  const Fixture north({-31, -10, -200});  // its southern side, the third, faces the camera
  const auto draws = north.draws(kAll);
  ASSERT_EQ(draws.size(), 2U);
  EXPECT_EQ(draws[0].part.first, 0U);
  EXPECT_EQ(draws[0].part.count, 3 * north.grid.surface_triangles());
  EXPECT_EQ(draws[1].part.first, north.grid.skirt(2).first);
  EXPECT_EQ(draws[1].part.count, north.grid.skirt(2).count);
  EXPECT_EQ(draws[0].morph, 0.5F);

  const Fixture north_east({20, -10, -200});
  std::set<std::uint32_t> expected;
  insert({0, 3 * north_east.grid.surface_triangles()}, expected);
  insert(north_east.grid.skirt(2), expected);
  insert(north_east.grid.skirt(3), expected);
  EXPECT_EQ(indices_of(north_east.draws(kAll)), expected);
}

TEST(GroundDraws, OnlyVisibleTilesAndTheirSkirtsAreDrawn) {
  const Fixture node({-31, -10, -200});
  for (std::uint32_t in_view = 0; in_view <= kAll; ++in_view) {
    std::set<std::uint32_t> expected;
    for (int tile = 0; tile < 9; ++tile) {
      if ((in_view >> tile & 1) != 0) insert(node.grid.tile(tile % 3, tile / 3), expected);
    }
    if (in_view >> 6 != 0) insert(node.grid.skirt(2), expected);
    EXPECT_EQ(indices_of(node.draws(in_view)), expected);
  }
}

TEST(GroundDraws, TilesThatReachNearHaveSeparateDraws) {
  // Its rows begin 20, 41 and 62 m away, and 10 m below: the last one has 1.2 m that are near.
  const Fixture node({-31, -10, -83});
  for (const render::TerrainDraw& draw : node.draws(kAll & ~7U))
    EXPECT_EQ(draw.near, draw.part.first < node.grid.skirt(0).first) << draw.part.first;
  for (const render::TerrainDraw& draw : Fixture({-31, -10, -200}).draws(kAll))
    EXPECT_FALSE(draw.near);
  const Fixture across({-31, -10, -100});  // its rows begin 37, 58 and 79 m away
  std::set<std::uint32_t> near, expected;
  for (const render::TerrainDraw& draw : across.draws(kAll)) {
    if (draw.near) insert(draw.part, near);
  }
  for (int tile = 3; tile < 9; ++tile)
    insert(across.grid.tile(tile % 3, tile / 3), expected);
  EXPECT_EQ(near, expected);
}

TEST(GroundDraws, NearTilesOfABlocksFinestGroundAreFine) {
  const Fixture node({-31, -10, -120});
  std::vector<render::TerrainDraw> draws;
  // The southern row begins 78 m away.
  add_tiles(node.fine_tiles(), kAll, &node.fine, 70, {}, draws);
  std::set<std::uint32_t> expected;
  for (int column = 0; column < 3; ++column) {
    insert(node.fine.fine(column, 2), expected);
    insert(node.fine.coarse(column, 1, models::TerrainTiles::kSouth), expected);
    insert(node.fine.coarse(column, 0, models::TerrainTiles::kNone), expected);
  }
  insert(node.fine.skirt(2), expected);
  EXPECT_EQ(indices_of(draws), expected);
  EXPECT_TRUE(std::ranges::all_of(draws, [](const render::TerrainDraw& draw) {
    return draw.morph == render::kMorphByDistance;
  }));
}

// A side with a skirt has all its vertices.
TEST(GroundDraws, TilesBesideSkirtsHaveTheSkirtsVertices) {
  const Fixture node({-31, -10, -120});
  constexpr std::uint32_t kSouthernRow = 7U << 6U;
  std::vector<render::TerrainDraw> draws;
  add_tiles(node.fine_tiles(), kSouthernRow, &node.fine, 10, {}, draws);
  std::set<std::uint32_t> expected;
  for (int column = 0; column < 3; ++column)
    insert(node.fine.coarse(column, 2, models::TerrainTiles::kSouth), expected);
  insert(node.fine.skirt(2), expected);
  EXPECT_EQ(indices_of(draws), expected);
}

}  // namespace
}  // namespace psygen::scene
