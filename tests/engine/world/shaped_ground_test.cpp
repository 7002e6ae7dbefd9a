#include "engine/world/shaped_ground.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/edits/edit_bytes.hpp"
#include "engine/world/far/merged_identity.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/world_schema.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/road_line.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/world/shaped_worlds.hpp"

namespace psygen::world {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::kShapes;
using testing::kSmallWorld;
using testing::parsed;
using testing::read_shaped_world;
using testing::registry;
using testing::replaced;
using testing::shaped_world;

constexpr double kQuantumM = 60.0 / 65535;  // of heights of kSmallWorld
constexpr double kBlockM = 64;

double height_at(const World& world, double x, double z) {
  const core::WorldPosition at = core::normalised({{0, 0}, {x, 0, z}}, kBlockM);
  return models::ground_height_m(terrain_parameters(world, at.block), at.block, at.local.x,
                                 at.local.z);
}

// The finest ground has a vertex at every even metre.
template <class Visit>
void each_vertex(const Visit& visit) {
  for (int z = 0; z < 256; z += 4) {
    for (int x = 0; x < 512; x += 2)
      visit(static_cast<double>(x), static_cast<double>(z));
  }
}

TEST(Stamp, TheGroundHasTheHeightsOfThePictureAtItsPixels) {
  const World world = shaped_world(
      "[[stamp]]\nimage = \"ramp.png\"\ncentre_m = [128, 96]\nsize_m = 64\nbase_m = 5\n"
      "height_m = 40\nborder_m = 0\nmode = \"set\"\n");
  for (int row = 0; row < 17; ++row) {
    for (int column = 0; column < 17; ++column) {
      const double grey = (row * 17 + column) * 65'535 / 288;
      EXPECT_NEAR(height_at(world, 96 + 4 * column, 64 + 4 * row), 5 + 40 * grey / 65'535,
                  0.51 * kQuantumM)
          << column << ' ' << row;
    }
  }
  // Half-way between two pixels it is their mean.
  EXPECT_NEAR(height_at(world, 98, 64), 5 + 40 * 0.5 / 288, 2 * kQuantumM);
}

TEST(Stamp, IsAddedToTheGroundAndChangesNothingElse) {
  const World base = parsed(kSmallWorld);
  const World world = shaped_world(
      "[[stamp]]\nimage = \"white.png\"\ncentre_m = [100, 100]\nsize_m = 40\nheight_m = -2\n"
      "border_m = 0\n");
  each_vertex([&](double x, double z) {
    const bool inside = std::abs(x - 100) <= 20 && std::abs(z - 100) <= 20;
    const double change = height_at(world, x, z) - height_at(base, x, z);
    if (inside)
      EXPECT_NEAR(change, std::max(-2.0, -height_at(base, x, z)), 1.01 * kQuantumM)
          << x << ' ' << z;
    else
      EXPECT_EQ(change, 0) << x << ' ' << z;
  });
}

TEST(Stamp, ItsBorderIsMonotone) {
  const World base = parsed(kSmallWorld);
  const World world = shaped_world(
      "[[stamp]]\nimage = \"white.png\"\ncentre_m = [200, 128]\nsize_m = 160\nheight_m = 8\n"
      "border_m = 50\n");
  double before = 0;
  for (double x = 120; x <= 200; x += 2) {
    const double change = height_at(world, x, 128) - height_at(base, x, 128);
    EXPECT_GE(change, before - 1.01 * kQuantumM) << x;
    EXPECT_LE(change, 8 + kQuantumM);
    before = change;
  }
  EXPECT_NEAR(before, 8, 1.01 * kQuantumM);
  EXPECT_LT(height_at(world, 122, 128) - height_at(base, 122, 128), 0.1);
}

TEST(Stamp, IsTurnedLikeAModel) {
  const std::string stamp =
      "[[stamp]]\nimage = \"ramp.png\"\ncentre_m = [128, 128]\nsize_m = 64\nheight_m = 30\n"
      "border_m = 0\nmode = \"set\"\n";
  const World world = shaped_world(stamp), turned = shaped_world(stamp + "turn_deg = 90\n");
  const World half = shaped_world(stamp + "turn_deg = 180\n");
  for (int z = -30; z <= 30; z += 6) {
    for (int x = -30; x <= 30; x += 6) {
      const double height_m = height_at(world, 128 + x, 128 + z);
      // About +Y by 90 degrees: x becomes -z, z becomes x.
      EXPECT_NEAR(height_at(turned, 128 + z, 128 - x), height_m, 1.01 * kQuantumM);
      EXPECT_NEAR(height_at(half, 128 - x, 128 - z), height_m, 1.01 * kQuantumM);
    }
  }
  // A square that stands on its corner reaches further along the axes.
  const World corner = shaped_world(stamp + "turn_deg = 45\n");
  const World base = parsed(kSmallWorld);
  EXPECT_NE(height_at(corner, 128 + 44, 128), height_at(base, 128 + 44, 128));
  EXPECT_EQ(height_at(corner, 128 + 30, 128 + 30), height_at(base, 128 + 30, 128 + 30));
}

TEST(Road, IsFlatAcrossItsWidth) {
  const World world =
      shaped_world("[[road]]\npoints_m = [[40, 100], [440, 100]]\nwidth_m = 16\nborder_m = 12\n");
  const World base = parsed(kSmallWorld);
  double moved = 0;
  for (double x = 42; x < 438; x += 2) {
    const double middle = height_at(world, x, 100);
    for (double across = -8; across <= 8; across += 2)
      EXPECT_NEAR(height_at(world, x, 100 + across), middle, 1.01 * kQuantumM) << x << across;
    EXPECT_EQ(height_at(world, x, 120.5), height_at(base, x, 120.5));
    moved = std::max(moved, std::abs(height_at(world, x, 108) - height_at(base, x, 108)));
  }
  EXPECT_GT(moved, 0.3);
}

// Everywhere on a road that bends, crosses a stamp and comes near itself, the ground has the height
// of the nearest part of its middle.
TEST(Road, HasTheHeightOfItsMiddleAlsoInBends) {
  const World world = shaped_world(kShapes);
  const Road& road = world.shaped.roads[0];
  const World stamped =
      shaped_world(std::string(kShapes).substr(0, std::string(kShapes).find("[[road]]")));
  const auto line =
      road_line(road, 2 * 10.0 / 6, [&](glm::dvec2 at) { return height_at(stamped, at.x, at.y); });
  int on_it = 0;
  each_vertex([&](double x, double z) {
    double nearest = 1e9, height_m = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
      const glm::dvec2 along = line[i].at_m - line[i - 1].at_m;
      const glm::dvec2 to = glm::dvec2(x, z) - line[i - 1].at_m;
      const double share = std::clamp(
          (to.x * along.x + to.y * along.y) / (along.x * along.x + along.y * along.y), 0.0, 1.0);
      const double away = std::hypot(to.x - share * along.x, to.y - share * along.y);
      if (away >= nearest) continue;
      nearest = away;
      height_m = line[i - 1].height_m + share * (line[i].height_m - line[i - 1].height_m);
    }
    if (nearest > 5) return;
    ++on_it;
    EXPECT_NEAR(height_at(world, x, z), height_m, 0.02) << x << ' ' << z;
  });
  EXPECT_GT(on_it, 500);
}

TEST(Road, FollowsTheGroundCalmlyAndMeetsItAtItsEnds) {
  Road road{{{0, 0}, {100, 0}, {200, 40}}, 6, 6, 30, 1};
  const auto ground = [](glm::dvec2 at) { return 10 + std::sin(at.x / 3); };
  const auto line = road_line(road, 2, ground);
  EXPECT_EQ(line.front().height_m, ground(line.front().at_m));
  EXPECT_EQ(line.back().height_m, ground(line.back().at_m));
  EXPECT_EQ(line.front().at_m, road.points_m.front());
  EXPECT_EQ(line.back().at_m, road.points_m.back());
  for (std::size_t i = 1; i < line.size(); ++i) {
    EXPECT_LT(line[i].along_m - line[i - 1].along_m, 2.5);
    EXPECT_GT(line[i].along_m, line[i - 1].along_m);
    if (line[i].along_m > 40 && line.back().along_m - line[i].along_m > 40) {
      EXPECT_NEAR(line[i].height_m, 10, 0.15);
    }
  }
  road.smoothing_m = 0;
  for (const RoadPoint& point : road_line(road, 2, ground))
    EXPECT_EQ(point.height_m, ground(point.at_m));
}

TEST(Road, NothingStandsOnItAndWhatStandsBesideItStaysThere) {
  const std::string many = replaced(kSmallWorld, "count = 5", "count = 400");
  const World base = parsed(many);
  const World world = *read_shaped_world(
      "[[road]]\npoints_m = [[40, 100], [440, 100]]\nwidth_m = 16\nclear_m = 3\n", many);
  std::size_t cleared = 0;
  for (std::int32_t i = 0; i < 32; ++i) {
    const core::BlockCoord block{i % 8, i / 8};
    std::vector<Placement> before, now;
    place_models(base, registry(), block, before);
    place_models(world, registry(), block, now);
    for (const Placement& was : before) {
      const double x = block.x * kBlockM + static_cast<double>(was.position.x);
      const double z = block.z * kBlockM + static_cast<double>(was.position.z);
      const double ahead = std::max({40 - x, x - 440, 0.0});
      const bool clear = std::hypot(ahead, z - 100) <= 11;
      const auto same = std::ranges::find(now, was.index, &Placement::index);
      EXPECT_EQ(same == now.end(), clear) << x << ' ' << z;
      cleared += clear ? 1 : 0;
      if (same == now.end()) continue;
      EXPECT_EQ(same->position.x, was.position.x);
      EXPECT_EQ(same->position.z, was.position.z);
      EXPECT_NEAR(static_cast<double>(same->position.y), height_at(world, x, z), 1e-4);
    }
  }
  EXPECT_GT(cleared, 500U);
  EXPECT_LT(world_size(world, registry()).models, world_size(base, registry()).models);
}

// Vertices know the share of a road, in meshes of all levels, as queries do.
TEST(Road, IsMarkedInTheGround) {
  const World world =
      shaped_world("[[road]]\npoints_m = [[40, 100], [440, 100]]\nwidth_m = 16\nborder_m = 12\n");
  const models::ModelType& terrain = registry()[world.terrain_model];
  for (int level = 0; level < 3; ++level) {
    const auto vertices =
        models::test::synthesize(terrain, terrain_parameters(world, {0, 0}, level), 0)
            .vertices<core::TerrainVertex>();
    const int step_m = 2 << level;
    for (int k = 0; k < 33; ++k) {
      for (int i = 0; i < 33; ++i) {
        const int x = i * step_m, z = k * step_m;
        const bool on_it = x >= 40 && x <= 440 && std::abs(z - 100) <= 7;
        const bool off_it = x < 31 || x > 449 || std::abs(z - 100) >= 9;
        const std::uint8_t road = vertices[static_cast<std::size_t>(k * 33 + i)].road;
        if (on_it) {
          EXPECT_EQ(road, 255) << x << ' ' << z;
        }
        if (off_it) {
          EXPECT_EQ(road, 0) << x << ' ' << z;
        }
        const core::BlockCoord block{x / 64, z / 64};
        EXPECT_NEAR(road_at(world, block, {x % 64, z % 64}), road / 255.0F, 0.003F);
      }
    }
  }
  const World base = parsed(kSmallWorld);
  EXPECT_EQ(road_at(base, {1, 1}, {36, 36}), 0);
}

TEST(Road, RoadsAndStampsMayLieOnEachOther) {
  std::string tables;
  for (int i = 0; i < 20; ++i) {
    tables +=
        "[[stamp]]\nimage = \"ramp.png\"\ncentre_m = [200, 128]\nsize_m = 100\nheight_m = 9\n";
    tables += "[[road]]\npoints_m = [[20, 128], [480, 128]]\n";
    tables += "[[road]]\npoints_m = [[200, 20], [200, 240]]\n";
  }
  const World world = shaped_world(tables);
  each_vertex([&](double x, double z) {
    const double height_m = height_at(world, x, z);
    EXPECT_TRUE(height_m >= 0 && height_m <= 60.001) << x << ' ' << z;
  });
}

// Nodes of all levels agree at shared vertices.
TEST(ShapedGround, IsTheSameInEveryNodeThatHasAVertex) {
  const World world = shaped_world(kShapes);
  const models::ModelType& terrain = registry()[world.terrain_model];
  const World base = parsed(kSmallWorld);
  const auto heights = [&](const World& of, core::BlockCoord node, int level) {
    std::vector<int> values;
    for (const auto& v : models::test::synthesize(terrain, terrain_parameters(of, node, level), 0)
                             .vertices<core::TerrainVertex>())
      values.push_back(v.height);
    return values;
  };
  std::size_t changed = 0;
  for (int level = 0; level < 3; ++level) {
    const auto here = heights(world, {0, 0}, level), east = heights(world, {1, 0}, level);
    const auto plain = heights(base, {0, 0}, level);
    for (std::size_t k = 0; k < 33; ++k)
      EXPECT_EQ(here[k * 33 + 32], east[k * 33]) << level;
    for (std::size_t i = 0; i < 33 * 33; ++i)
      changed += here[i] != plain[i] ? 1 : 0;
    if (level == 0) continue;
    const auto child = heights(world, {0, 0}, level - 1);
    for (std::size_t z = 0; z < 17; ++z)
      for (std::size_t x = 0; x < 17; ++x)
        EXPECT_EQ(here[z * 33 + x], child[2 * z * 33 + 2 * x]) << level;
  }
  EXPECT_GT(changed, 500U);
}

TEST(ShapedGround, WorldsWithoutItHaveTheirOldHashes) {
  const World world = parsed(kSmallWorld);
  EXPECT_EQ(shape_hash(world), 0U);
  EXPECT_EQ(world.shaped.layer, nullptr);
  EXPECT_EQ(world.terrain.edits(), nullptr);
  const World shaped = shaped_world(kShapes);
  EXPECT_NE(shape_hash(shaped), 0U);
  EXPECT_EQ(shape_hash(shaped), shape_hash(shaped_world(kShapes)));
  EXPECT_NE(merged_identity(world, registry()), merged_identity(shaped, registry()));
  // Blocks that nothing reaches keep the keys of their meshes.
  const World small = shaped_world(
      "[[stamp]]\nimage = \"white.png\"\ncentre_m = [20, 20]\nsize_m = 4\nborder_m = 1\n");
  EXPECT_NE(terrain_parameters(small, {0, 0}), terrain_parameters(world, {0, 0}));
  EXPECT_EQ(terrain_parameters(small, {6, 3}), terrain_parameters(world, {6, 3}));
  EXPECT_EQ(terrain_parameters(small, {6, 3}).hash(), terrain_parameters(world, {6, 3}).hash());
}

TEST(ShapedGround, EveryKeyOfItIsPartOfItsHash) {
  const std::uint64_t hash = shape_hash(shaped_world(kShapes));
  for (const auto& [from, to] : {std::pair{"ramp.png", "white.png"},
                                 {"[128, 128]", "[128, 129]"},
                                 {"size_m = 96", "size_m = 97"},
                                 {"base_m = 4", "base_m = 5"},
                                 {"height_m = 20", "height_m = 21"},
                                 {"border_m = 16", "border_m = 17"},
                                 {"turn_deg = 30", "turn_deg = 31"},
                                 {"turn_deg = 30", "mode = \"set\"\nturn_deg = 30"},
                                 {"[260, 60]", "[260, 61]"},
                                 {"width_m = 10", "width_m = 11"},
                                 {"border_m = 8", "border_m = 9"},
                                 {"clear_m = 2", "clear_m = 3"},
                                 {"clear_m = 2", "clear_m = 2\nsmoothing_m = 50"}})
    EXPECT_NE(shape_hash(shaped_world(replaced(kShapes, from, to))), hash) << to;
}

TEST(ShapedGround, EditsLieOverItAndAreStoredWithoutIt) {
  World world = shaped_world(kShapes);
  const World function = world;
  const double road_m = height_at(world, 140, 140), far_m = height_at(world, 480, 240);
  Edits edits;
  ASSERT_TRUE(edits.raise(world, {{0, 0}, {140, 0, 140}}, 12, 3));
  set_edits(world, edits.layer());
  EXPECT_NEAR(height_at(world, 140, 140), road_m + 3, 2 * kQuantumM);
  EXPECT_EQ(height_at(world, 480, 240), far_m);
  EXPECT_EQ(terrain_parameters(world, {7, 3}), terrain_parameters(function, {7, 3}));
  // What a save holds makes the same world again.
  Edits loaded;
  const core::BlockCoord block{2, 2};
  const auto bytes = encode_block(edits, registry(), block);
  EXPECT_LT(bytes.size(), 200U);
  ASSERT_TRUE(load_block(loaded, world, registry(), block, bytes));
  World again = function;
  set_edits(again, loaded.layer());
  EXPECT_EQ(height_at(again, 140, 140), height_at(world, 140, 140));
  EXPECT_EQ(terrain_parameters(again, {2, 2}), terrain_parameters(world, {2, 2}));
  // Those of the world, set again, are the same ones.
  const Edits of_world(world.edits);
  EXPECT_TRUE(changed_blocks(edits, of_world).empty());
  set_edits(again, of_world.layer());
  EXPECT_EQ(height_at(again, 140, 140), height_at(world, 140, 140));
  // Another world has another ground below the same edits.
  World other = parsed(kSmallWorld);
  const double plain_m = height_at(other, 140, 140);
  set_edits(other, of_world.layer());
  EXPECT_NEAR(height_at(other, 140, 140), std::min(plain_m + 3, 60.0), 2 * kQuantumM);
  set_edits(world, nullptr);
  EXPECT_EQ(world, function);
  EXPECT_EQ(height_at(world, 140, 140), road_m);
}

TEST(ShapedGround, ModelsKeepTheirPlacesWhenEditsComeAndGo) {
  World world = shaped_world(kShapes);
  std::vector<Placement> before, after;
  place_models(world, registry(), {2, 2}, before);
  Edits edits;
  ASSERT_TRUE(edits.raise(world, {{0, 0}, {140, 0, 140}}, 60, 9));
  set_edits(world, edits.layer());
  place_models(world, registry(), {2, 2}, after);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].position.x, after[i].position.x);
    EXPECT_EQ(before[i].position.z, after[i].position.z);
  }
}

// The merged meshes of nodes stand on the same ground and leave the road free.
TEST(ShapedGround, MergedModelsAreOnItAndNotOnRoads) {
  const std::string many =
      replaced(replaced(kSmallWorld, "count = 3", "count = 0"), "count = 5", "count = 200");
  const std::string tables =
      "[[road]]\npoints_m = [[4, 64], [250, 64]]\nwidth_m = 20\nclear_m = 8\n"
      "[[stamp]]\nimage = \"white.png\"\ncentre_m = [64, 20]\nsize_m = 30\nheight_m = 25\n"
      "border_m = 0\n";
  const auto make = [&](const World& world) {
    const auto merged = make_merged_type(std::make_shared<const World>(world), registry());
    const models::Parameters p = merged_parameters(world, {0, 0}, 1);
    return models::test::synthesize(*merged, p, 0);
  };
  const auto plain = make(parsed(many)), shaped = make(*read_shaped_world(tables, many));
  EXPECT_LT(shaped.box.max.y, plain.box.max.y + 30);
  EXPECT_GT(shaped.box.max.y, plain.box.max.y + 5);
  EXPECT_NE(plain.vertex_bytes, shaped.vertex_bytes);
}

TEST(ShapedGround, ReadsBackAsItWasWritten) {
  const World world = shaped_world(std::string(kShapes) + "smoothing_m = 12.5\n" +
                                   "[[stamp]]\nimage = \"a b/white.png\"\ncentre_m = [3.25e-1, 7]\n"
                                   "mode = \"set\"\n");
  const std::string text = write_world(world, registry());
  const auto again = read_shaped_world("", text);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(*again, world);
  EXPECT_EQ(shape_hash(*again), shape_hash(world));
}

TEST(ShapedGround, EditorsSeeItsFields) {
  const std::string text = std::string(kSmallWorld) + kShapes;
  const auto sections = world_schema(text, shaped_world(kShapes), registry());
  ASSERT_TRUE(sections) << sections.error().message;
  const auto value = [&](const TextPath& path) {
    const WorldField* field = find_field(*sections, path);
    return field != nullptr ? field->value : "nothing";
  };
  EXPECT_EQ(value({"stamp", 0, "image"}), "\"ramp.png\"");
  EXPECT_EQ(value({"stamp", 0, "centre_m"}), "[128, 128]");
  EXPECT_EQ(value({"stamp", 0, "mode"}), "\"add\"");
  EXPECT_EQ(value({"road", 0, "width_m"}), "10");
  EXPECT_EQ(value({"road", 0, "smoothing_m"}), "30");
  EXPECT_THAT(value({"road", 0, "points_m"}), ::testing::StartsWith("[[20, 30], [140, 140]"));
  EXPECT_EQ(sections->back().title, "road 1");
  // Values that are written as they are usual change nothing.
  std::string all = text;
  for (const WorldSection& section : *sections)
    for (const WorldField& field : section.fields)
      if (!field.is_set && !field.usual.empty())
        all = with_value(all, field.path, field.usual).value();
  const auto again = read_shaped_world("", all);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(*again, shaped_world(kShapes));
  EXPECT_FALSE(world_schema(text, parsed(kSmallWorld), registry()));
}

std::string shape_error(const std::string& tables) {
  const auto world = read_shaped_world(tables);
  return world ? "" : world.error().message;
}

TEST(ShapedGround, BadStampsAreRefusedWithLineAndField) {
  const std::string stamp = "[[stamp]]\nimage = \"white.png\"\ncentre_m = [100, 100]\n";
  ASSERT_EQ(shape_error(stamp), "");
  const auto with = [&](const std::string& from, const std::string& to) {
    return shape_error(replaced(stamp, from, to));
  };
  EXPECT_THAT(with("white.png", "no.png"),
              HasSubstr("maps/w.toml:25: stamp[0].image: maps/no.png: there is no such file"));
  EXPECT_THAT(with("white.png", "dot.png"), HasSubstr("1 x 1; a stamp needs 2 x 2"));
  EXPECT_THAT(with("white.png", "../white.png"), HasSubstr("without .."));
  EXPECT_THAT(with("image = \"white.png\"\n", ""), HasSubstr("stamp[0].image"));
  EXPECT_THAT(with("centre_m = [100, 100]\n", ""), HasSubstr("stamp[0].centre_m"));
  for (const char* centre :
       {"[100]", "[1, 2, 3]", "[nan, 1]", "[inf, 1]", "[1e9, 1]", "7", "[-1, 5]", "[512, 5]"})
    EXPECT_THAT(with("[100, 100]", centre), HasSubstr("stamp[0].centre_m")) << centre;
  for (const char* key : {"size_m = 0", "size_m = nan", "size_m = 30000", "border_m = -1",
                          "border_m = 101", "turn_deg = 361", "height_m = 1e6", "height_m = 61",
                          "mode = \"multiply\"", "mode = 1", "heights_m = 3"})
    EXPECT_THAT(shape_error(stamp + key), HasSubstr("w.toml:27: stamp[0].")) << key;
  EXPECT_THAT(shape_error(stamp + "mode = \"set\"\nbase_m = -1\nheight_m = 9"),
              AllOf(HasSubstr("stamp[0].height_m"), HasSubstr("-1 m"), HasSubstr("0 to 60 m")));
  std::string many;
  for (int i = 0; i < 65; ++i)
    many += stamp;
  EXPECT_THAT(shape_error(many), HasSubstr("stamp: it must be at most 64 tables"));
  const auto unread = parse_world(kSmallWorld + stamp, "w", registry());
  ASSERT_FALSE(unread);
  EXPECT_THAT(unread.error().message, HasSubstr("reads no files beside"));
}

TEST(ShapedGround, BadRoadsAreRefusedWithLineAndField) {
  const auto with = [&](const std::string& points, const std::string& more = "") {
    return shape_error("[[road]]\npoints_m = " + points + "\n" + more);
  };
  ASSERT_EQ(with("[[10, 10], [40.5, 40]]"), "");
  for (const char* points :
       {"[[10, 10]]", "[]", "7", "[10, 10]", "[[10, 10], [nan, 4]]", "[[10, 10], [inf, 4]]",
        "[[10, 10], [10, 10.5]]", "[[10, 10], [40, 40, 40]]", "[[10, 10], [\"a\", 4]]",
        "[[10, 10], [1e9, 4]]", "[[10, 10], [-20, 4]]", "[[10, 10], [40, 256.5]]"})
    EXPECT_THAT(with(points), HasSubstr("maps/w.toml:25: road[0].points_m")) << points;
  EXPECT_THAT(shape_error("[[road]]\nwidth_m = 4\n"), HasSubstr("road[0].points_m"));
  for (const char* key : {"width_m = 0", "width_m = nan", "border_m = -1", "smoothing_m = 1e4",
                          "clear_m = 101", "wide_m = 4"})
    EXPECT_THAT(with("[[10, 10], [40, 40]]", key), HasSubstr("w.toml:26: road[0].")) << key;
  std::string points = "[[0, 0]";
  for (int i = 1; i < 1001; ++i)
    points += i % 2 == 0 ? ", [0, 0]" : ", [500, 0]";
  EXPECT_THAT(with(points + "]"), HasSubstr("2 to 1000 points"));
  points = "[[0, 0]";
  for (int i = 1; i < 300; ++i)
    points += i % 2 == 0 ? ", [0, 0]" : ", [500, 200]";
  EXPECT_THAT(with(points + "]"), HasSubstr("longer than 100000 m"));
}

TEST(ShapedGround, TooMuchOnTopOfEachOtherIsRefused) {
  std::string points = "[[10, 10]";
  for (int i = 1; i < 1000; ++i)
    points += i % 2 == 0 ? ", [10, 10]" : ", [90, 60]";
  std::string tables;
  const std::string road = "[[road]]\npoints_m = " + points + "]\nwidth_m = 0.5\n";
  EXPECT_THAT(shape_error(road), HasSubstr("on top of each other"));
}

}  // namespace
}  // namespace psygen::world
