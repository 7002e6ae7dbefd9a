#include "engine/world/files/shaped_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "engine/world/files/text_edit.hpp"
#include "engine/world/files/world_schema.hpp"
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

TEST(ShapedFile, ReadsBackEqual) {
  const World world = shaped_world(std::string(kShapes) + "smoothing_m = 12.5\n" +
                                   "[[stamp]]\nimage = \"a b/white.png\"\ncentre_m = [3.25e-1, 7]\n"
                                   "mode = \"set\"\n");
  const std::string text = write_world(world, registry());
  const auto again = read_shaped_world("", text);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(*again, world);
  EXPECT_EQ(shape_hash(*again), shape_hash(world));
}

TEST(ShapedFile, RiversAndLakesReadBackEqualAndEditorsSeeTheirKeys) {
  const std::string tables =
      "[[lake]]\ncentre_m = [100, 100]\nradius_m = 40\nspill_m = 30.5\n"
      "[[lake]]\npoints_m = [[300, 60], [380, 60], [340, 130]]\ndepth_m = 2.5\n"
      "[[river]]\npoints_m = [[300, 200], [200, 160], [100, 100]]\nwidth_m = [4, 5.5, 6]\n"
      "depth_m = 1\ndischarge_m3_s = 3.25\nsmoothing_m = 0\n";
  const World world = shaped_world(tables);
  EXPECT_EQ(world.shaped.rivers[0].width_m, (std::vector<double>{4, 5.5, 6}));
  EXPECT_EQ(world.shaped.lakes[0].spill_m, 30.5);
  EXPECT_FALSE(world.shaped.lakes[1].spill_m);
  const std::string text = write_world(world, registry());
  const auto again = read_shaped_world("", text);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(*again, world);
  EXPECT_EQ(shape_hash(*again), shape_hash(world));
  const World other = shaped_world(replaced(tables, "3.25", "3.5"));
  EXPECT_FALSE(other == world);
  EXPECT_NE(shape_hash(other), shape_hash(world));
  EXPECT_EQ(write_world(parsed(kSmallWorld), registry()).find("river"), std::string::npos);
  const auto sections = world_schema(std::string(kSmallWorld) + tables, world, registry());
  ASSERT_TRUE(sections) << sections.error().message;
  const auto field = [&](std::string_view section, std::size_t i, std::string_view key) {
    return *find_field(*sections, TextPath{section, i, key});
  };
  EXPECT_EQ(field("river", 0, "width_m").value, "[4, 5.5, 6]");
  EXPECT_EQ(field("river", 0, "width_m").usual, "8");
  EXPECT_EQ(field("river", 0, "discharge_m3_s").value, "3.25");
  EXPECT_EQ(field("river", 0, "bank_m").usual, "6");
  EXPECT_EQ(field("lake", 0, "radius_m").value, "40");
  EXPECT_EQ(field("lake", 1, "radius_m").value, "");
  EXPECT_EQ(field("lake", 1, "points_m").value, "[[300, 60], [380, 60], [340, 130]]");
}

constexpr const char* kMetres =
    "[[stamp]]\nimage = \"metres.exr\"\ncentre_m = [128, 96]\nsize_m = [64, 32]\nunit = \"m\"\n"
    "no_data = -9999\n";

TEST(ShapedFile, HeightsInMetresReadBackEqualAndEditorsSeeTheirKeys) {
  const World world = shaped_world(kMetres);
  const std::string text = write_world(world, registry());
  const auto again = read_shaped_world("", text);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(*again, world);
  EXPECT_EQ(again->shaped.stamps[0].no_data, -9999);
  EXPECT_EQ(shape_hash(*again), shape_hash(world));
  EXPECT_NE(shape_hash(shaped_world(replaced(kMetres, "[64, 32]", "64"))), shape_hash(world));
  const auto sections = world_schema(std::string(kSmallWorld) + kMetres, world, registry());
  ASSERT_TRUE(sections) << sections.error().message;
  const auto field = [&](std::string_view key) {
    return *find_field(*sections, TextPath{"stamp", 0, key});
  };
  EXPECT_EQ(field("size_m").value, "[64, 32]");
  EXPECT_EQ(field("size_m").kind, FieldKind::kRealPair);
  EXPECT_EQ(field("size_m").label, "Size");
  EXPECT_EQ(field("unit").plain, "m");
  EXPECT_EQ(field("unit").choices, (std::vector<std::string>{"grey", "m"}));
  EXPECT_EQ(field("no_data").value, "-9999");
  EXPECT_THAT(field("no_data").doc, HasSubstr("marks pixels without height"));
}

TEST(ShapedFile, NumbersThatAreNoHeightsAreRejectedWithTheirRangeAndTheKey) {
  const auto error = [](const std::string& from, const std::string& to) {
    const auto world = read_shaped_world(replaced(kMetres, from, to));
    return world ? "" : world.error().message;
  };
  EXPECT_THAT(error("unit = \"m\"\n", ""),
              AllOf(HasSubstr("w.toml:25: stamp[0].image: the numbers of the image are 10 to 24"),
                    HasSubstr("unit = \"m\"")));
  EXPECT_THAT(
      error("no_data = -9999\n", ""),
      AllOf(HasSubstr("stamp[0].image: the stamp reaches -9999 m"), HasSubstr("-60 to 60")));
  EXPECT_THAT(error("-9999", "3"), HasSubstr("reaches -9999 m"));
  EXPECT_THAT(error("metres.exr", "colours.exr"), HasSubstr("the image has colours"));
  EXPECT_THAT(error("\"m\"", "\"ft\""), HasSubstr("stamp[0].unit: it must be one of grey, m"));
  EXPECT_THAT(error("-9999", "nan"), HasSubstr("stamp[0].no_data"));
  EXPECT_THAT(error("[64, 32]", "[64, 32]\nborder_m = 17"),
              HasSubstr("at most half of size_m, 16"));
  for (const char* size : {"[64]", "[64, 0]", "[64, nan]", "[1, 2, 3]", "\"wide\""})
    EXPECT_THAT(error("[64, 32]", size), HasSubstr("w.toml:27: stamp[0].size_m")) << size;
}

const std::string kMasked =
    "[[stamp]]\nimage = \"white.png\"\ncentre_m = [100, 100]\nmode = \"highest\"\n"
    "strength = 0.5\nenabled = false\nmask_image = \"ramp.png\"\n"
    "mask_area_m = [0, 10, 200, 180]\nmask_noise_m = 30\nmin_height_m = 5\nheight_fade_m = 2\n"
    "max_slope_deg = 30\n[[road]]\npoints_m = [[10, 10], [40, 40]]\nstrength = 0.25\n";

TEST(ShapedFile, MasksAndSwitchesReadBackEqualAndDefaultsAreNotWritten) {
  const std::string off = "enabled = false\n";
  const std::string tables = kMasked + "[[lake]]\ncentre_m = [400, 100]\nradius_m = 40\n" + off +
                             "[[river]]\npoints_m = [[300, 200], [200, 160]]\n" + off;
  const World world = shaped_world(tables);
  const std::string text = write_world(world, registry());
  const auto again = read_shaped_world("", text);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(*again, world);
  EXPECT_EQ(shape_hash(*again), shape_hash(world));
  EXPECT_FALSE(world.shaped.lakes[0].enabled);
  EXPECT_FALSE(world.shaped.rivers[0].enabled);
  EXPECT_THAT(text, HasSubstr("min_height_m = 5\nheight_fade_m = 2\nmax_slope_deg = 30\n"));
  const std::string plain = write_world(shaped_world(kShapes), registry());
  for (const char* key : {"strength", "enabled", "mask_", "_fade_", "slope_deg = 90"})
    EXPECT_EQ(plain.find(key), std::string::npos) << key;
  const auto sections = world_schema(std::string(kSmallWorld) + tables, world, registry());
  ASSERT_TRUE(sections) << sections.error().message;
  const auto field = [&](std::string_view section, std::string_view key) {
    return *find_field(*sections, TextPath{section, 0, key});
  };
  EXPECT_EQ(field("stamp", "mode").choices,
            (std::vector<std::string>{"add", "set", "highest", "lowest"}));
  EXPECT_EQ(field("stamp", "strength").value, "0.5");
  EXPECT_EQ(field("stamp", "enabled").kind, FieldKind::kBoolean);
  EXPECT_EQ(field("stamp", "mask_image").kind, FieldKind::kImage);
  EXPECT_EQ(field("stamp", "mask_area_m").value, "[0, 10, 200, 180]");
  EXPECT_EQ(field("stamp", "max_height_m").value, "");
  EXPECT_EQ(field("stamp", "slope_fade_deg").usual, "10");
  EXPECT_EQ(field("road", "strength").value, "0.25");
  EXPECT_EQ(field("lake", "enabled").value, "false");
  EXPECT_EQ(field("river", "enabled").usual, "true");
}

TEST(ShapedFile, BadMasksAndSwitchesAreRejectedWithLineAndField) {
  const auto error = [](const std::string& from, const std::string& to) {
    const auto world = read_shaped_world(replaced(kMasked, from, to));
    return world ? "" : world.error().message;
  };
  for (const char* strength : {"-0.1", "1.01", "nan", "inf", "\"full\""})
    EXPECT_THAT(error("strength = 0.5", std::string("strength = ") + strength),
                HasSubstr("w.toml:28: stamp[0].strength"))
        << strength;
  EXPECT_THAT(error("strength = 0.25", "strength = 2"), HasSubstr("w.toml:38: road[0].strength"));
  EXPECT_THAT(error("highest", "multiply"),
              HasSubstr("w.toml:27: stamp[0].mode: it must be one of add, set, highest, lowest"));
  EXPECT_THAT(error("enabled = false", "enabled = 0"), HasSubstr("w.toml:29: stamp[0].enabled"));
  EXPECT_THAT(error("ramp.png", "no.png"),
              HasSubstr("w.toml:30: stamp[0].mask_image: maps/no.png: there is no such file"));
  EXPECT_THAT(error("mask_image = \"ramp.png\"\n", ""),
              HasSubstr("w.toml:30: stamp[0].mask_area_m: it is the area of mask_image"));
  EXPECT_THAT(error("[0, 10, 200, 180]", "[0, 180, 200, 10]"),
              HasSubstr("w.toml:31: stamp[0].mask_area_m: it must be [x0, z0, x1, z1]"));
  EXPECT_THAT(error("height_fade_m = 2", "max_height_m = 4"),
              HasSubstr("w.toml:33: stamp[0].min_height_m: it must not be above max_height_m"));
  EXPECT_THAT(error("height_fade_m = 2", "height_fade_m = -2"),
              HasSubstr("w.toml:34: stamp[0].height_fade_m"));
  EXPECT_THAT(error("max_slope_deg = 30", "max_slope_deg = 30\nmin_slope_deg = 31"),
              HasSubstr("w.toml:36: stamp[0].min_slope_deg: it must not be above max_slope_deg"));
  EXPECT_THAT(error("max_slope_deg = 30", "max_slope_deg = 91"),
              HasSubstr("w.toml:35: stamp[0].max_slope_deg"));
  EXPECT_THAT(error("strength = 0.25", "mask_noise_m = 3"), HasSubstr("road[0].mask_noise_m"));
  EXPECT_THAT(error("[[road]]", "on_ground = [\"rock\"]\n[[road]]"), HasSubstr("on_ground"));
}

TEST(ShapedFile, EditorsSeeItsFields) {
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
  // Writing default values changes nothing.
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

TEST(ShapedFile, BadStampsAreRejectedWithLineAndField) {
  const std::string stamp = "[[stamp]]\nimage = \"white.png\"\ncentre_m = [100, 100]\n";
  ASSERT_EQ(shape_error(stamp), "");
  const auto with = [&](const std::string& from, const std::string& to) {
    return shape_error(replaced(stamp, from, to));
  };
  EXPECT_THAT(with("white.png", "no.png"),
              HasSubstr("maps/w.toml:25: stamp[0].image: maps/no.png: there is no such file"));
  EXPECT_THAT(with("white.png", "dot.png"),
              HasSubstr("1 x 1 pixels; a stamp needs at least 2 x 2"));
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
  EXPECT_THAT(unread.error().message, HasSubstr("cannot read glTF models and images"));
}

TEST(ShapedFile, BadRoadsAreRejectedWithLineAndField) {
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
  EXPECT_THAT(with(points + "]"), HasSubstr("longer than the allowed 100000 m"));
}

TEST(ShapedFile, ARoadThatCoversAnAreaIsRejected) {
  std::string points = "[[10, 10]";
  for (int i = 1; i < 1000; ++i)
    points += i % 2 == 0 ? ", [10, 10]" : ", [90, 60]";
  const std::string road = "[[road]]\npoints_m = " + points + "]\nwidth_m = 0.5\n";
  EXPECT_THAT(shape_error(road), HasSubstr("more than 1000 pieces of the road"));
}

TEST(ShapedFile, TooManyOverlappingShapesAreRejected) {
  const std::string large_blocks =
      replaced(kSmallWorld, "block_vertices = 33", "block_vertices = 128");
  // To and fro in lanes a metre apart, which do not touch.
  const auto error = [&](int lanes) {
    std::string points;
    for (int i = 0; i < 2 * lanes; ++i)
      points +=
          fmt::format("{}[{}, {}]", i == 0 ? "" : ", ", (i + 1) / 2 % 2 == 0 ? 8 : 248, 8 + i / 2);
    const auto world = read_shaped_world(
        "[[road]]\npoints_m = [" + points + "]\nwidth_m = 0.5\nborder_m = 0\n", large_blocks);
    return world ? "" : world.error().message;
  };
  EXPECT_EQ(error(20), "");
  EXPECT_THAT(error(230),
              AllOf(HasSubstr("w.toml:25: road[0].points_m"),
                    HasSubstr("1024 stamps and pieces of roads or water overlap there")));
}

}  // namespace
}  // namespace psygen::world
