#include "engine/models/water/water_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "tests/engine/models/mesh_helpers.hpp"

namespace psygen::models {
namespace {

constexpr double kBlockM = 64;
constexpr core::BlockCoord kFarBlock{2'147'483'646, -2'147'483'647};

// A river from (20, 30) to the east and south, in pieces of three segments, that falls by 1 m in
// 40 m.
void add_river(EditLayer& layer, int pieces) {
  std::uint32_t id = 1;
  for (int p = 0; p < pieces; ++p) {
    auto river = std::make_shared<RiverPiece>();
    river->body = 7;
    for (int i = 3 * p; i <= 3 * p + 3; ++i) {
      const double along = 8.0 * i;
      river->points.push_back({.at_m = {20 + along, 30 + 0.25 * along},
                               .direction = glm::dvec2(4, 1) / std::sqrt(17.0),
                               .half_width_m = 3,
                               .surface_m = 50 - along / 40,
                               .bed_m = 49 - along / 40,
                               .bank_m = 5,
                               .speed_m_s = 1,
                               .fall = 0.025,
                               .foam = 0.1});
    }
    GroundEdit edit;
    edit.change = GroundChange::kRiver;
    edit.square = true;
    const glm::dvec2 middle = (river->points.front().at_m + river->points.back().at_m) / 2.0;
    edit.centre = core::normalised({{0, 0}, {middle.x, 0, middle.y}}, kBlockM);
    edit.radius_m = 24;
    edit.height_m = 10;
    seal(*river);
    edit.river = std::move(river);
    edit.id = id++;
    seal(edit);
    ASSERT_TRUE(layer.ground.shapes.add(std::make_shared<const GroundEdit>(edit), kBlockM));
  }
}

// A round lake of 40 m around (200, 200) in one tile.
void add_lake(EditLayer& layer) {
  auto lake = std::make_shared<LakePiece>();
  lake->body = 9;
  lake->level_m = 20;
  lake->depth_m = 3;
  lake->low_m = {150, 150};
  lake->high_m = {250, 250};
  constexpr int kSides = 32;
  const auto corner = [](int i) {
    const double turn = 2 * 3.14159265358979 * i / kSides;
    return glm::dvec2(std::cos(turn), std::sin(turn));
  };
  for (int i = 0; i < kSides; ++i) {
    const glm::dvec2 from = corner(i), to = corner(i + 1);
    lake->segments.push_back({.from_m = glm::dvec2(200) + 40.0 * from,
                              .to_m = glm::dvec2(200) + 40.0 * to,
                              .from_normal = from,
                              .to_normal = to});
  }
  GroundEdit edit;
  edit.change = GroundChange::kLake;
  edit.square = true;
  edit.centre = core::normalised({{0, 0}, {200, 0, 200}}, kBlockM);
  edit.radius_m = 60;
  edit.height_m = 30;
  seal(*lake);
  edit.lake = std::move(lake);
  edit.id = 100;
  seal(edit);
  ASSERT_TRUE(layer.ground.shapes.add(std::make_shared<const GroundEdit>(edit), kBlockM));
}

Parameters water_of(const EditLayer& layer, core::BlockCoord node, int level) {
  Parameters p = water_surface_parameters(node, level, kBlockM);
  const auto at = QuadCoord::of(node, static_cast<std::uint32_t>(level));
  p.set_edits(&layer, layer.ground.hash_of(at, 0, kBlockM));
  return p;
}

// The mesh of a node, with positions in metres from the world's origin.
struct Surface {
  std::vector<glm::dvec3> places;
  std::vector<core::WaterVertex> vertices;
  std::vector<std::uint16_t> indices;
};
Surface surface_of_node(const EditLayer& layer, core::BlockCoord node, int level) {
  const auto type = make_water_type();
  const Parameters p = water_of(layer, node, level);
  Surface surface;
  if (!has_water_surface(p)) return surface;
  const test::Mesh mesh = test::synthesise(*type, p, 0);
  const core::Bounds box = type->bounds(p);
  surface.vertices = mesh.vertices<core::WaterVertex>();
  surface.indices = mesh.indices;
  const double side_m = std::ldexp(kBlockM, level);
  for (const core::WaterVertex& v : surface.vertices) {
    glm::dvec3 at = glm::dvec3(box.centre());
    for (int i = 0; i < 3; ++i)
      at[i] += double{box.half_extent()[i]} * v.position[i] / 32767.0;
    surface.places.push_back(at + glm::dvec3(node.x * side_m, 0, node.z * side_m));
  }
  return surface;
}

// The area of all surfaces of a level over the squares of the level that cover 512 m, in m².
double area_of_level(const EditLayer& layer, int level) {
  double area = 0;
  const int nodes = 8 >> level;
  for (int z = 0; z < nodes; ++z) {
    for (int x = 0; x < nodes; ++x) {
      const Surface s = surface_of_node(layer, {x, z}, level);
      for (std::size_t i = 0; i + 2 < s.indices.size(); i += 3) {
        const glm::dvec3 a = s.places[s.indices[i + 1]] - s.places[s.indices[i]];
        const glm::dvec3 b = s.places[s.indices[i + 2]] - s.places[s.indices[i]];
        area += 0.5 * std::abs(a.x * b.z - a.z * b.x);
      }
    }
  }
  return area;
}

TEST(WaterSurface, IsAbsentWithoutWater) {
  EditLayer layer;
  EXPECT_FALSE(has_water_surface(water_of(layer, {0, 0}, 0)));
  add_river(layer, 2);
  EXPECT_TRUE(has_water_surface(water_of(layer, {0, 0}, 0)));
  EXPECT_FALSE(has_water_surface(water_of(layer, {6, 6}, 0)));
}

TEST(WaterSurface, CoversEachStripAndTileOnceAtEveryLevel) {
  EditLayer layer;
  add_river(layer, 5);
  add_lake(layer);
  const double length_m = std::sqrt(17.0) / 4 * 8 * 15;
  const double river_m2 = length_m * (2 * 3 + 2 * 2), lake_m2 = 3.14159 * 42 * 42;
  for (const int level : {0, 1, 2, 3}) {
    // Coarse nodes cut the corners of a lake.
    EXPECT_NEAR(area_of_level(layer, level), river_m2 + lake_m2, 0.07 * (river_m2 + lake_m2))
        << level;
  }
}

TEST(WaterSurface, NeverRisesDownstreamAndNeighboursShareTheirEnds) {
  EditLayer layer;
  add_river(layer, 6);
  std::map<double, double> middles;      // height of the middle of the river, by x in dm
  std::map<double, std::set<int>> ends;  // the same in cm, of each strip that ends there
  for (int x = 0; x < 8; ++x) {
    for (int z = 0; z < 3; ++z) {
      const Surface s = surface_of_node(layer, {x, z}, 0);
      for (std::size_t i = 0; i < s.places.size(); ++i) {
        const double height_m = s.places[i].y, along = (50 - height_m) * 40;
        EXPECT_NEAR(s.places[i].z - 30, 0.25 * along, 6) << "beside the centre line";
        if (i % 7 != 3) continue;
        middles[std::round(10 * s.places[i].x)] = height_m;
        ends[std::round(10 * s.places[i].x)].insert(static_cast<int>(std::lround(height_m * 100)));
        EXPECT_NEAR(s.vertices[i].depth / 255.0 * s.vertices[i].depth / 255.0 * 16, 1, 0.1);
        EXPECT_GT(s.vertices[i].flow[0], 1000);
      }
    }
  }
  EXPECT_EQ(middles.size(), 19U);
  double last_m = 1e9;
  for (const auto& [x, height_m] : middles) {
    EXPECT_LT(height_m, last_m) << x;
    last_m = height_m;
  }
  for (const auto& [x, heights] : ends)
    EXPECT_LE(*heights.rbegin() - *heights.begin(), 1) << x;
}

TEST(WaterSurface, OfALakeIsFlatAndEndsAtItsOutline) {
  EditLayer layer;
  add_lake(layer);
  const Surface s = surface_of_node(layer, {3, 3}, 0);
  ASSERT_GT(s.places.size(), 50U);
  double farthest_m = 0;
  for (std::size_t i = 0; i < s.places.size(); ++i) {
    EXPECT_NEAR(s.places[i].y, 20, 1e-3);
    const double away_m = std::hypot(s.places[i].x - 200, s.places[i].z - 200);
    farthest_m = std::max(farthest_m, away_m);
    if (away_m < 25) {
      EXPECT_GT(s.vertices[i].depth, 80);
    }
    if (away_m > 40.5) {
      EXPECT_EQ(s.vertices[i].depth, 0);
    }
  }
  EXPECT_NEAR(farthest_m, 42, 1);  // the edge reaches under the shore
}

TEST(WaterSurface, IsTheSameFarFromTheOrigin) {
  EditLayer layer;
  GroundEdit edit;
  auto river = std::make_shared<RiverPiece>();
  river->origin = {kFarBlock, {10, 0, 10}};
  river->points = {{.at_m = {0, 0}, .surface_m = 9, .bed_m = 8},
                   {.at_m = {20, 0}, .surface_m = 8, .bed_m = 7}};
  edit.change = GroundChange::kRiver;
  edit.square = true;
  edit.centre = {kFarBlock, {20, 0, 10}};
  edit.radius_m = 20;
  edit.height_m = 5;
  seal(*river);
  edit.river = std::move(river);
  edit.id = 1;
  seal(edit);
  ASSERT_TRUE(layer.ground.shapes.add(std::make_shared<const GroundEdit>(edit), kBlockM));
  const Parameters p = water_of(layer, edit.centre.block, 0);
  ASSERT_TRUE(has_water_surface(p));
  const core::Bounds box = make_water_type()->bounds(p);
  EXPECT_NEAR(box.min.x, 10, 1e-4);
  EXPECT_NEAR(box.max.x, 30, 1e-4);
}

// True if a triangle of a surface lies over a place.
bool covers(const Surface& s, glm::dvec2 at) {
  const auto side = [&](const glm::dvec3& a, const glm::dvec3& b) {
    return (b.x - a.x) * (at.y - a.z) - (b.z - a.z) * (at.x - a.x);
  };
  for (std::size_t i = 0; i + 2 < s.indices.size(); i += 3) {
    const glm::dvec3 &a = s.places[s.indices[i]], &b = s.places[s.indices[i + 1]],
                     &c = s.places[s.indices[i + 2]];
    const double u = side(a, b), v = side(b, c), w = side(c, a);
    if ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) return true;
  }
  return false;
}

void add_network(EditLayer& layer) {
  layer.ground.network = *RiverNetwork::create(
      {.seed = 11, .root_spacing_m = 1024, .halvings = 5, .sea_share = 0.2},
      {.cell_m = 1, .cells_per_block = 64, .relief_m = 200, .sea_level_m = 20},
      std::make_shared<NetworkStore>());
}

TEST(WaterSurface, KeepsItsBits) {
  EditLayer layer;
  add_river(layer, 5);
  add_network(layer);
  std::uint64_t hash = 0, meshes = 0;
  for (int level = 0; level <= 9; ++level) {
    for (int k = 0; k < 36; ++k) {
      const Surface s = surface_of_node(layer, {k % 6 - 2, k / 6 - 2}, level);
      meshes += s.indices.empty() ? 0 : 1;
      hash = core::combine(hash, core::hash_bytes(std::as_bytes(std::span(s.vertices))));
      hash = core::combine(hash, core::hash_bytes(std::as_bytes(std::span(s.indices))));
    }
  }
  EXPECT_GT(meshes, 150U);
  EXPECT_EQ(hash, 0xDF34D5E807B2571CULL) << "note a change of these bits in the commit";
}

// Rivers, and lakes with the channels that run through them.
TEST(WaterSurface, CoversTheWaterOfANetwork) {
  EditLayer layer;
  add_network(layer);
  std::size_t wet = 0, covered = 0;
  for (int z = 0; z < 12; ++z) {
    for (int x = 0; x < 12; ++x) {
      std::vector<Surface> near;
      for (int k = 0; k < 9; ++k)
        near.push_back(surface_of_node(layer, {x + k % 3 - 1, z + k / 3 - 1}, 0));
      for (int i = 0; i < 64; ++i) {
        const glm::dvec2 local(3.5 + 8 * (i % 8), 3.5 + 8 * (i / 8));
        const NetworkWater water = layer.ground.network->water_at({{x, z}, {local.x, 0, local.y}});
        if (water.depth_m < 0.2F || water.surface_m < 20.1F) continue;
        ++wet;
        covered += std::ranges::any_of(
            near, [&](const Surface& s) { return covers(s, local + glm::dvec2(x, z) * kBlockM); });
      }
    }
  }
  EXPECT_GT(wet, 60U);
  EXPECT_GE(static_cast<double>(covered), 0.97 * static_cast<double>(wet)) << wet;
}

}  // namespace
}  // namespace psygen::models
