#include "engine/handmade/files.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <deque>
#include <limits>
#include <span>

#include "engine/core/cancellation.hpp"
#include "engine/core/read_file.hpp"
#include "engine/image/image_io.hpp"
#include "engine/world/far/tree_impostors.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/files/world_schema.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/handmade/shapes.hpp"
#include "tests/engine/image/test_files.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::handmade {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kHead = R"(format = 1
[world]
name = "small"
seed = 5
blocks = [8, 4]
cell_m = 2
block_vertices = 33
[terrain]
octaves = 4
)";
constexpr const char* kBall = R"([[model]]
name = "ball"
file = "things/ball.glb"
size_m = 3
)";
constexpr const char* kScatter = R"([[scatter]]
model = "ball"
count = 6
max_slope_deg = 40
scale = [0.5, 2]
turn_deg = [0, 360]
)";

// A folder with a world and its models.
struct World {
  TemporaryFolder folder;
  models::Registry registry = models::make_standard_registry();
  std::deque<models::Registry> registries;

  World() {
    std::filesystem::create_directory(folder / "things");
    gltf::write_bytes(folder / "things/ball.glb", ball(24, 40).glb());
  }
  std::string file() const { return (folder / "w.toml").string(); }
  core::Result<world::World> read(const std::string& text) {
    return world::parse_world(text, file(), registry, &files());
  }
  // The error message for a text; the registry must not change.
  std::string error_of(const std::string& text) {
    const std::size_t before = registry.size();
    const auto world = read(text);
    EXPECT_FALSE(world.has_value()) << text;
    EXPECT_EQ(registry.size(), before);
    return world ? "" : world.error().message;
  }
  // The identity of the first model of a text. Reads it into a new registry, which keeps it in use.
  std::uint64_t identity_of(const std::string& text) {
    models::Registry& own = registries.emplace_back(models::make_standard_registry());
    const auto world = world::parse_world(text, file(), own, &files());
    EXPECT_TRUE(world) << world.error().message;
    return world ? own[4].identity() : 0;
  }
  std::string error_with(std::string_view from, const std::string& to) {
    std::string text = std::string(kHead) + kBall + kScatter;
    text.replace(text.find(from), from.size(), to);
    return error_of(text);
  }
};

TEST(HandmadeFiles, MakeAModelThatCanBeScattered) {
  World w;
  const auto world = w.read(std::string(kHead) + kBall + kScatter);
  ASSERT_TRUE(world.has_value()) << world.error().message;
  ASSERT_EQ(w.registry.size(), 5U);
  EXPECT_EQ(w.registry[4].name(), "ball");
  EXPECT_THAT(std::string(w.registry[4].doc()), HasSubstr("things/ball.glb"));
  std::vector<world::Placement> placed;
  world::place_models(*world, w.registry, {3, 2}, placed);
  EXPECT_GT(placed.size(), 0U);
  EXPECT_GT(world::world_size(*world, w.registry).triangles, 0);
}

TEST(HandmadeFiles, ReadBackEqual) {
  World w;
  const auto world = w.read(std::string(kHead) + kBall +
                            "sink_m = 0.5\nlevels = 3\ncollider = \"box\"\n" + kScatter);
  ASSERT_TRUE(world.has_value()) << world.error().message;
  const std::string text = world::write_world(*world, w.registry);
  models::Registry other = models::make_standard_registry();
  const auto again = world::parse_world(text, w.file(), other, &files());
  ASSERT_TRUE(again.has_value()) << again.error().message;
  EXPECT_EQ(*again, *world);
  EXPECT_EQ(other[4].identity(), w.registry[4].identity());
}

TEST(HandmadeFiles, StopBetweenFilesAndLevelsOnceNobodyWantsThem) {
  World w;
  const std::string text = std::string(kHead) + kBall + kScatter;
  std::atomic<bool> cancelled{true};
  {
    const core::CancelScope scope(&cancelled);
    const auto world = w.read(text);
    ASSERT_FALSE(world);
    EXPECT_EQ(world.error().code, core::ErrorCode::kInterrupted);
    EXPECT_TRUE(levels_of(sphere(20, 20), 5).size() <= 1);
  }
  EXPECT_TRUE(w.read(text));
}

TEST(HandmadeFiles, ReportHowMuchOfTheModelsIsRead) {
  World w;
  std::string text(kHead);
  for (int i = 0; i < 40; ++i)
    text += "[[model]]\nname = \"m" + std::to_string(i) + "\"\nfile = \"things/ball.glb\"\n";
  std::vector<double> parts;
  const core::ProgressScope progress([&](double part) { parts.push_back(part); });
  const auto world = w.read(text);
  ASSERT_TRUE(world) << world.error().message;
  ASSERT_FALSE(parts.empty());
  EXPECT_TRUE(std::ranges::is_sorted(parts));
  EXPECT_GT(parts.front(), 0);
  EXPECT_EQ(parts.back(), 1);
}

// The models of a pack, each with an image in a copy of its own, and two tables of one file.
TEST(HandmadeFiles, ReadThePackInThreadsAsOneByOne) {
  World w;
  constexpr int kModels = 70;
  ASSERT_TRUE(image::write_png(w.folder / "things/a.png", image::make_image(9, 9, 250, 9, 9)));
  std::vector<std::string> tables;
  for (int i = 0; i < kModels; ++i) {
    gltf::Sample sample = ball(4 + i % 7, 5 + i);
    const std::string image = fmt::format("{}.png", i);
    std::filesystem::copy(w.folder / "things/a.png", w.folder / "things" / image);
    sample.json["images"][0]["uri"] = image;
    sample.json["textures"][0]["source"] = 0;
    sample.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    const std::string name = fmt::format("m{}", i);
    gltf::write_bytes(w.folder / "things" / (name + ".glb"), sample.glb());
    tables.push_back(
        fmt::format("[[model]]\nname = \"{0}\"\nfile = \"things/{0}.glb\"\nsize_m = 2\n", name));
  }
  std::vector<std::uint64_t> alone;
  for (const std::string& table : tables) {
    models::Registry one = models::make_standard_registry();
    const auto world = world::parse_world(kHead + table, w.file(), one, &files());
    ASSERT_TRUE(world) << world.error().message;
    alone.push_back(one[4].identity());
  }
  std::string text = kHead;
  for (const std::string& table : tables)
    text += table;
  gltf::Sample twin = ball(60, 90);
  twin.json["extensionsUsed"] = gltf::list("X_twin");  // noted by each read
  gltf::write_bytes(w.folder / "things/twin.glb", twin.glb());
  for (const char* name : {"twin_a", "twin_b"})
    text += fmt::format("[[model]]\nname = \"{}\"\nfile = \"things/twin.glb\"\n", name);
  ::testing::internal::CaptureStderr();
  const auto world = w.read(text);
  const std::string notes = ::testing::internal::GetCapturedStderr();
  ASSERT_TRUE(world) << world.error().message;
  const std::size_t note = notes.find("X_twin");
  EXPECT_NE(note, std::string::npos) << notes;
  EXPECT_EQ(notes.find("X_twin", note + 1), std::string::npos) << "one read, of a shared shape";
  EXPECT_EQ(w.registry[4 + kModels].identity(), w.registry[5 + kModels].identity());
  for (int i = 0; i < kModels; ++i) {
    const models::ModelType& type = w.registry[static_cast<models::ModelIndex>(4 + i)];
    EXPECT_EQ(type.name(), fmt::format("m{}", i));
    EXPECT_EQ(type.identity(), alone[static_cast<std::size_t>(i)]);
  }
  // The first of several faulty files is named, and no model is kept.
  for (const int i : {66, 31, 48})
    gltf::write_bytes(w.folder / "things" / fmt::format("m{}.glb", i), "broken");
  models::Registry fresh = models::make_standard_registry();
  const auto refused = world::parse_world(text, w.file(), fresh, &files());
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("model[31].file"));
  EXPECT_EQ(fresh.size(), 4U);
}

TEST(HandmadeFiles, KeepOneTypeForEqualModelsAndRejectOthersWithItsName) {
  World w;
  const std::string text = std::string(kHead) + kBall + kScatter;
  ASSERT_TRUE(w.read(text).has_value());
  ASSERT_TRUE(w.read(text).has_value());
  EXPECT_EQ(w.registry.size(), 5U);
  EXPECT_THAT(w.error_with("size_m = 3", "size_m = 4"),
              AllOf(StartsWith(w.file() + ":11: model[0].name: "),
                    HasSubstr("another model is named ball")));
  const models::Registry& constant = w.registry;
  EXPECT_TRUE(world::parse_world(text, w.file(), constant, &files()).has_value());
  // A changed file is read again.
  gltf::write_bytes(w.folder / "things/ball.glb", ball(20, 30).glb());
  EXPECT_THAT(w.error_of(text), HasSubstr("another model is named ball"));
}

TEST(HandmadeFiles, RejectWithFileLineAndField) {
  World w;
  const std::string at = w.file() + ":12: model[0].file: ";
  EXPECT_THAT(w.error_with("things/ball.glb", "things/no.glb"),
              AllOf(StartsWith(at), HasSubstr("no.glb")));
  EXPECT_THAT(w.error_with("things/ball.glb", "../ball.glb"),
              AllOf(StartsWith(at), HasSubstr("..")));
  EXPECT_THAT(w.error_with("things/ball.glb", "/etc/passwd"), HasSubstr("relative to the folder"));
  EXPECT_THAT(w.error_with("things/ball.glb", "things"), StartsWith(at));
  EXPECT_THAT(w.error_with("file = \"things/ball.glb\"", ""), HasSubstr("model[0].file"));
  EXPECT_THAT(w.error_with("name = \"ball\"\nfile", "name = \"Ball\"\nfile"),
              HasSubstr("snake_case"));
  EXPECT_THAT(w.error_with("name = \"ball\"\nfile", "name = \"tree\"\nfile"),
              HasSubstr("another model is named tree"));
  EXPECT_THAT(w.error_with("size_m = 3", "size_m = -3"), HasSubstr("model[0].size_m"));
  EXPECT_THAT(w.error_with("size_m = 3", "size_m = 3\nscale = 2"),
              AllOf(HasSubstr("model[0].scale"), HasSubstr("only one")));
  EXPECT_THAT(w.error_with("size_m = 3", "levels = 9"), HasSubstr("model[0].levels"));
  EXPECT_THAT(w.error_with("size_m = 3", "collider = \"mesh\""), HasSubstr("hull, box, none"));
  EXPECT_THAT(w.error_with("size_m = 3", "sizes_m = 3"), HasSubstr("did you mean size_m"));
  EXPECT_THAT(w.error_with("scale = [0.5, 2]", "scale = 1000"), HasSubstr("scatter[0].scale"));
  EXPECT_THAT(w.error_with("size_m = 3", "scale = 1e5"),
              AllOf(StartsWith(at), HasSubstr("its size would be")));
  const auto without = world::parse_world(std::string(kHead) + kBall, w.file(), w.registry);
  ASSERT_FALSE(without.has_value());
  EXPECT_THAT(without.error().message, HasSubstr("cannot read glTF models"));
}

constexpr const char* kMask = R"([[scatter]]
model = "rock"
count = 20
subdivisions = 1
mask_image = "m.png"
)";

std::size_t rocks_with(World& w) {
  const auto world = w.read(std::string(kHead) + kMask);
  EXPECT_TRUE(world.has_value()) << (world ? "" : world.error().message);
  std::vector<world::Placement> placed;
  if (world) world::place_models(*world, w.registry, {3, 2}, placed);
  return placed.size();
}

TEST(HandmadeFiles, ReadMasksAndReadThemAgainWhenTheyChange) {
  World w;
  ASSERT_TRUE(image::write_png(w.folder / "m.png", image::make_image(2, 2, 255, 255, 255, 255)));
  EXPECT_EQ(rocks_with(w), 20U);
  const auto kept = w.read(std::string(kHead) + kMask);  // keeps the image in use
  ASSERT_TRUE(image::write_png(w.folder / "m.png", image::make_image(64, 32)));
  EXPECT_EQ(rocks_with(w), 0U);
  // One pixel is an image too.
  ASSERT_TRUE(image::write_png(w.folder / "m.png", image::make_image(1, 1, 255, 255, 255, 255)));
  EXPECT_EQ(rocks_with(w), 20U);
}

// A model whose buffer is in a separate file.
TEST(HandmadeFiles, ReadModelsAgainWhenAFileThatTheyNameChanges) {
  World w;
  gltf::Sample sample = ball(24, 40);
  const auto buffer = w.folder / "things/ball.bin";
  gltf::write_bytes(w.folder / "things/ball.gltf", sample.text("ball.bin"));
  gltf::write_bytes(buffer, sample.binary);
  std::string text = std::string(kHead) + kBall + kScatter;
  text.replace(text.find("ball.glb"), 8, "ball.gltf");
  const std::uint64_t before = w.identity_of(text);
  const auto time = std::filesystem::last_write_time(buffer);
  std::swap(sample.binary.front(), sample.binary.back());  // another triangle, and a normal
  gltf::write_bytes(buffer, sample.binary);
  std::filesystem::last_write_time(buffer, time);
  EXPECT_EQ(w.identity_of(text), before) << "size and time are the same, so it is not read again";
  std::filesystem::last_write_time(buffer, time + std::chrono::seconds(1));
  EXPECT_NE(w.identity_of(text), before);
}

TEST(HandmadeFiles, ReadModelsAgainWhenAnImageThatTheyLackedAppears) {
  World w;
  gltf::Sample sample = ball(24, 40);
  const int uvs = sample.add("accessors",
                             {{"componentType", gltf::kFloats}, {"count", 1000}, {"type", "VEC2"}});
  sample.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uvs;  // all zero
  sample.json["images"][0]["uri"] = "late.png";
  sample.json["textures"][0]["source"] = 0;
  sample.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
  gltf::write_bytes(w.folder / "things/ball.glb", sample.glb());
  const std::string text = std::string(kHead) + kBall;
  const std::uint64_t before = w.identity_of(text);
  EXPECT_EQ(w.identity_of(text), before);
  ASSERT_TRUE(image::write_png(w.folder / "things/late.png", image::make_image(2, 2, 9, 99, 9)));
  EXPECT_NE(w.identity_of(text), before);
}

constexpr const char* kStamp = R"([[stamp]]
image = "m.exr"
centre_m = [256, 128]
size_m = 64
height_m = 100
border_m = 0
mode = "set"
)";

TEST(HandmadeFiles, GiveStampsTheMetresOfAnImage) {
  World w;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(image::write_exr(w.folder / "m.exr", {2, 2, {12.5F, 13, 14, nan}}));
  EXPECT_THAT(w.error_of(std::string(kHead) + kStamp),
              AllOf(StartsWith(w.file() + ":11: stamp[0].image: the numbers of the image are 12.5 "
                                          "to 14, but grey is 0 (black) to 1"),
                    HasSubstr("unit = \"m\"")));
  ::testing::internal::CaptureStderr();
  const auto world = w.read(std::string(kHead) + kStamp + "unit = \"m\"\n");
  const std::string notes = ::testing::internal::GetCapturedStderr();
  ASSERT_TRUE(world.has_value()) << world.error().message;
  EXPECT_THAT(notes, HasSubstr("m.exr: 1 of 4 pixels are NaN or infinite; the ground stays"));
  const world::HeightPicture& picture = *world->shaped.stamps[0].picture;
  EXPECT_EQ(picture.values[0], 12.5F);
  EXPECT_TRUE(std::isnan(picture.values[3]));
}

TEST(HandmadeFiles, NameAndHashTheMaskOfAStamp) {
  World w;
  ASSERT_TRUE(image::write_exr(w.folder / "m.exr", {2, 2, {12, 13, 14, 15}}));
  ASSERT_TRUE(image::write_png(w.folder / "s.png", image::make_image(2, 2, 255, 255, 255, 255)));
  const auto world = w.read(std::string(kHead) + kStamp + "unit = \"m\"\nmask_image = \"s.png\"\n");
  ASSERT_TRUE(world.has_value()) << world.error().message;
  EXPECT_EQ(*files_named_by(*world, w.file()),
            (std::vector<std::filesystem::path>{"m.exr", "s.png"}));
  const auto hash = hash_of_files(*world, w.file());
  ASSERT_TRUE(image::write_png(w.folder / "s.png", image::make_image(2, 2, 9, 9, 9, 255)));
  EXPECT_NE(*hash_of_files(*world, w.file()), *hash);
}

TEST(HandmadeFiles, CountThePixelsOfMasksThatAreNoShares) {
  World w;
  const float infinite = std::numeric_limits<float>::infinity();
  ASSERT_TRUE(image::write_exr(w.folder / "m.exr", {2, 2, {0.5F, 3, -1, infinite}}));
  ::testing::internal::CaptureStderr();
  const auto picture = files().read_grey(w.folder / "m.exr");
  const std::string notes = ::testing::internal::GetCapturedStderr();
  ASSERT_TRUE(picture.has_value()) << picture.error().message;
  EXPECT_EQ((*picture)->pixels, (std::vector<std::uint16_t>{32'768, 65'535, 0, 0}));
  EXPECT_THAT(notes, AllOf(HasSubstr("1 of 4 pixels are NaN or infinite; they count as black"),
                           HasSubstr("the numbers are -1 to 3; below 0 they count as black")));
}

TEST(HandmadeFiles, LeaveTheGroundUnderTransparentPixelsOfAStamp) {
  World w;
  image::Image image = image::make_image(2, 2, 51, 51, 51, 255);
  image.pixel(1, 1)[3] = 0;
  ASSERT_TRUE(image::write_png(w.folder / "m.exr", image));
  const auto picture = files().read_heights(w.folder / "m.exr");
  ASSERT_TRUE(picture.has_value()) << picture.error().message;
  EXPECT_EQ((*picture)->values[0], 51);
  EXPECT_EQ((*picture)->white, 255);
  EXPECT_TRUE(std::isnan((*picture)->values[3]));
}

TEST(HandmadeFiles, RejectBadMasks) {
  World w;
  const auto error = [&] { return w.error_of(std::string(kHead) + kMask); };
  const std::string at = w.file() + ":14: scatter[0].mask_image: ";
  EXPECT_THAT(error(), AllOf(StartsWith(at), HasSubstr("m.png")));
  ASSERT_TRUE(image::write_png(w.folder / "m.png", image::make_image(4097, 1)));
  EXPECT_THAT(error(), AllOf(StartsWith(at), HasSubstr("4097 x 1")));
  ASSERT_TRUE(image::write_png(w.folder / "m.png", image::make_image(64, 64, 9, 99, 200)));
  const auto whole = core::read_file(w.folder / "m.png", 1 << 20);
  ASSERT_TRUE(whole.has_value());
  for (std::size_t length = 0; length < whole->size(); length += 7) {
    image::write_bytes(w.folder / "m.png", std::span(*whole).first(length));
    EXPECT_THAT(error(), StartsWith(at)) << length;
  }
  for (std::size_t byte = 0; byte < whole->size(); byte += 11) {
    auto damaged = *whole;
    damaged[byte] ^= 0x55;
    image::write_bytes(w.folder / "m.png", damaged);
    EXPECT_THAT(error(), StartsWith(at)) << byte;
  }
  std::filesystem::remove(w.folder / "m.png");
  std::filesystem::create_directory(w.folder / "m.png");
  EXPECT_THAT(error(), StartsWith(at));
}

TEST(HandmadeFiles, RejectLinksThatLeadOutOfTheFolder) {
  World w;
  const auto inner = w.folder / "inner";
  std::filesystem::create_directories(inner / "things");
  ASSERT_TRUE(image::write_png(w.folder / "m.png", image::make_image(64, 64, 9, 99, 200)));
  std::filesystem::create_symlink(w.folder / "m.png", inner / "m.png");
  std::filesystem::create_symlink(w.folder / "things/ball.glb", inner / "things/ball.glb");
  const auto error_of = [&](const std::string& rest) {
    models::Registry types = models::make_standard_registry();
    const auto world =
        world::parse_world(kHead + rest, (inner / "w.toml").string(), types, &files());
    return world ? "" : world.error().message;
  };
  const char* const out = "leads out of the folder of the world file";
  EXPECT_THAT(error_of(kMask), HasSubstr(out));
  EXPECT_THAT(error_of(std::string(kBall) + kScatter), HasSubstr(out));
  // Links may lead anywhere within the folder.
  std::filesystem::remove(inner / "m.png");
  std::filesystem::copy(w.folder / "m.png", inner / "things/real.png");
  std::filesystem::create_symlink(inner / "things/real.png", inner / "m.png");
  EXPECT_EQ(error_of(kMask), "");
}

TEST(HandmadeFiles, RejectEveryTruncatedFile) {
  World w;
  const std::string whole = ball(4, 5).glb();
  for (std::size_t n = 0; n < whole.size(); n += 37) {
    gltf::write_bytes(w.folder / "things/ball.glb", whole.substr(0, n));
    EXPECT_THAT(w.error_of(std::string(kHead) + kBall), HasSubstr("ball.glb")) << n;
  }
}

TEST(HandmadeFiles, RejectModelsAboveTheirBudget) {
  World w;
  std::string text = kHead;
  for (int i = 0; i < 4097; ++i)
    text += fmt::format("[[model]]\nname = \"m{}\"\nfile = \"things/ball.glb\"\n", i);
  EXPECT_THAT(w.error_of(text), HasSubstr("at most 4096 tables"));
  gltf::write_bytes(w.folder / "things/ball.glb", ball(60, 90).glb());  // 10,800 triangles
  EXPECT_THAT(w.error_with("count = 6", "count = 16384"), HasSubstr("too large"));
}

// All instances share one impostor, which does not sway.
TEST(HandmadeFiles, ShareOneImpostor) {
  World w;
  const auto world = w.read(std::string(kHead) + kBall + kScatter);
  ASSERT_TRUE(world.has_value());
  const world::ImpostorSet pictures(*world, w.registry);
  ASSERT_EQ(pictures.count(), 1U);
  const models::ModelIndex ball = 4;
  EXPECT_TRUE(pictures.has(ball));
  models::Parameters p = pictures.models()[0].parameters;
  const auto view_of = [&](double turn_deg) {
    p.set_real(1, turn_deg);
    world::ProxyMesh quad;
    pictures.make_quad(ball, p, nullptr, quad);
    EXPECT_EQ(quad.corners[2].sway, 0);
    return static_cast<int>(std::lround(quad.corners[0].colour.x * 255));
  };
  p.set_real(0, 1);
  const double own = pictures.models()[0].turn_deg;
  EXPECT_EQ(view_of(own), 0);
  for (int k = 0; k < 8; ++k) {
    const double turn = own + 45 * k > 360 ? own + 45 * k - 360 : own + 45 * k;
    EXPECT_EQ(view_of(turn), k);
  }
}

TEST(HandmadeFiles, AreSectionsOfTheSchema) {
  World w;
  const std::string text = std::string(kHead) + kBall + kScatter;
  const auto world = w.read(text);
  ASSERT_TRUE(world.has_value());
  const auto sections = world::world_schema(text, *world, w.registry);
  ASSERT_TRUE(sections.has_value());
  const world::WorldField* file = world::find_field(*sections, {"model", 0, "file"});
  ASSERT_NE(file, nullptr);
  EXPECT_EQ(file->plain, "things/ball.glb");
  EXPECT_TRUE(file->required);
  EXPECT_NE(world::find_field(*sections, {"model", 0, "levels"}), nullptr);
  const world::WorldField* turn = world::find_field(*sections, {"scatter", 0, "turn_deg"});
  ASSERT_NE(turn, nullptr);
  EXPECT_EQ(turn->kind, world::FieldKind::kRealRange);
}

}  // namespace
}  // namespace psygen::handmade
