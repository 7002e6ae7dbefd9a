#include "engine/world/mask.hpp"

#include <gmock/gmock.h>

#include <cstring>

#include "engine/models/kit/packing.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/ground_blends.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/world/shaped_worlds.hpp"

namespace psygen::world {
namespace {

using ::testing::HasSubstr;
using testing::kSmallWorld;
using testing::registry;
using testing::replaced;

// Every image is black on its left half and white on its right half.
class HalfPictures final : public testing::PicturesAlone {
 public:
  core::Result<std::shared_ptr<const GreyPicture>> read_grey(
      const std::filesystem::path& file) const override {
    if (file.filename() == "missing.png")
      return core::fail(core::ErrorCode::kIo, file.string() + ": there is no such file");
    return std::make_shared<const GreyPicture>(
        GreyPicture{4, 1, {0, 0, 65'535, 65'535}, core::hash_bytes({})});
  }
};

core::Result<World> read_masked(const std::string& keys, const ResourceLoader* beside = nullptr) {
  static const HalfPictures pictures;
  const std::string text = replaced(kSmallWorld, "count = 5", "count = 40\n" + keys);
  return parse_world(text, "maps/w.toml", registry(), beside != nullptr ? beside : &pictures);
}

World masked(const std::string& keys) {
  auto world = read_masked(keys);
  if (!world) std::fprintf(stderr, "%s\n", world.error().message.c_str());
  return world.value();
}

std::string mask_error(const std::string& keys) {
  const auto world = read_masked(keys);
  return world ? "" : world.error().message;
}

std::vector<Placement> rocks_of(const World& world) {
  std::vector<Placement> all, block;
  for (std::int32_t i = 0; i < 32; ++i) {
    place_models(world, registry(), {i % 8, i / 8}, block);
    for (Placement& p : block) {
      if (p.model != world.scatter[1].model) continue;
      p.position += glm::vec3(i % 8, 0, i / 8) * static_cast<float>(world.block_size_m());
      p.index += static_cast<std::uint32_t>(i) << 16;
      all.push_back(p);
    }
  }
  return all;
}

TEST(Mask, ImagesSelectInstances) {
  const World world = masked("mask_image = \"m.png\"");
  const double middle_m = 4 * world.block_size_m();
  const std::vector<Placement> all = rocks_of(masked("")), rocks = rocks_of(world);
  EXPECT_NEAR(static_cast<double>(rocks.size()), 0.5 * static_cast<double>(all.size()), 40);
  for (const Placement& rock : rocks)
    EXPECT_GT(static_cast<double>(rock.position.x), 0.74 * middle_m);
  // Outside its area nothing stands.
  const World small = masked("mask_image = \"m.png\"\nmask_area_m = [-100, 0, 300, 100]");
  for (const Placement& rock : rocks_of(small)) {
    EXPECT_LE(rock.position.x, 300);
    EXPECT_LE(rock.position.z, 100);
  }
}

TEST(Mask, NoiseCoversTheRequestedFractionOfTheGround) {
  ScatterMask mask;
  mask.noise_m = 30;
  for (const double share : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    mask.share = share;
    int covered = 0;
    for (int i = 0; i < 40'000; ++i)
      covered += mask_share(mask, 5, {i % 200 * 17.3 - 1500, i / 200 * 17.3}) > 0 ? 1 : 0;
    EXPECT_NEAR(covered / 40'000.0, share, 0.03) << share;
  }
  ScatterMask other = mask;
  mask.share = other.share = 0.5, other.patches = 1;
  int same = 0;
  for (int i = 0; i < 1000; ++i)
    same += mask_share(mask, 5, {i * 21.0, 7}) == mask_share(other, 5, {i * 21.0, 7}) ? 1 : 0;
  EXPECT_NEAR(same, 500, 120);
}

TEST(Mask, PatchesOfAnySizeHaveValuesFarAway) {
  ScatterMask mask;
  for (const double size_m : {1e-300, 1e-6, 0.05, 1e6}) {
    mask.noise_m = size_m;
    for (const double at : {-1e13, 0.0, 1e13}) {
      const double share = mask_share(mask, 5, {at, -at});
      EXPECT_TRUE(share == 0 || share == 1) << size_m << ' ' << at;
    }
  }
}

// Remaining instances do not change: a mask removes instances and moves none.
TEST(Mask, RemainingInstancesKeepPositionAndParameters) {
  const std::vector<Placement> all = rocks_of(masked(""));
  const std::vector<Placement> some = rocks_of(masked("mask_noise_m = 50\nmask_share = 0.4"));
  EXPECT_LT(some.size(), all.size() * 6 / 10);
  EXPECT_GT(some.size(), all.size() * 2 / 10);
  for (const Placement& p : some) {
    const auto same = std::ranges::find(all, p.index, &Placement::index);
    ASSERT_NE(same, all.end());
    EXPECT_EQ(same->position, p.position);
    EXPECT_EQ(same->parameters, p.parameters);
  }
}

TEST(Mask, InstancesStandOnAllowedKindsOfGroundOnly) {
  const World world = masked("on_ground = [\"forest\", \"rock\"]");
  const Palette palette = drawn_palette(world);
  const std::vector<Placement> rocks = rocks_of(world);
  EXPECT_GT(rocks.size(), 100U);
  const auto size = static_cast<float>(world.block_size_m());
  for (const Placement& rock : rocks) {
    const core::BlockCoord block{static_cast<std::int32_t>(rock.position.x / size),
                                 static_cast<std::int32_t>(rock.position.z / size)};
    const glm::vec2 local{rock.position.x - size * static_cast<float>(block.x),
                          rock.position.z - size * static_cast<float>(block.z)};
    const models::BlockGround ground(world.terrain, block, 1);
    const models::GroundPoint point = ground.at(local);
    const GroundBlends blends =
        ground_blends(palette, static_cast<float>(point.height_m), point.normal,
                      pattern_place(block, world.block_size_m(), local));
    EXPECT_THAT(main_kind(blends), ::testing::AnyOf(GroundKind::kForest, GroundKind::kRock));
  }
}

// The merged mesh of a node has its rocks at the positions of the single ones.
TEST(Mask, FarModelsAgreeWithNearOnes) {
  const std::string text =
      replaced(replaced(kSmallWorld, "count = 3", "count = 0"), "count = 5",
               "count = 40\nmask_image = \"m.png\"\nmask_area_m = [0, 0, 128, 128]");
  static const HalfPictures pictures;
  const auto world =
      std::make_shared<const World>(parse_world(text, "w.toml", registry(), &pictures).value());
  const auto plain = std::make_shared<const World>(testing::parsed(
      replaced(replaced(kSmallWorld, "count = 3", "count = 0"), "count = 5", "count = 40")));
  const auto across = [](const models::ModelType& merged) {
    const models::Parameters p = merged_parameters(core::BlockCoord{0, 0}, 1);
    const models::MeshSize size = merged.mesh_size(p, 0);
    std::vector<std::byte> vertices(size.vertex_count * sizeof(core::ModelVertex));
    std::vector<std::uint16_t> indices(size.index_count);
    const core::Bounds tight = merged.synthesise(p, 0, {vertices, indices});
    return glm::vec2(tight.min.x, tight.max.x);
  };
  const auto merged = make_merged_type(world, registry());
  const auto all = make_merged_type(plain, registry());
  EXPECT_LT(across(*all).x, 10);
  EXPECT_GT(across(*merged).x, 40);
  EXPECT_GT(across(*merged).y, 118);
  EXPECT_NE(merged->identity(), all->identity());
}

TEST(Mask, ReadsBackEqual) {
  const World world = masked(
      "on_ground = [\"snow\", \"grass\"]\nmask_image = \"a b.png\"\nmask_noise_m = 12.5\n"
      "mask_share = 0.25\nmask_patches = 3");
  static const HalfPictures pictures;
  const auto again =
      parse_world(write_world(world, registry()), "maps/w.toml", registry(), &pictures);
  ASSERT_TRUE(again.has_value()) << again.error().message;
  EXPECT_EQ(*again, world);
  EXPECT_NE(mask_hash(world.scatter[1].mask), 0U);
  EXPECT_EQ(mask_hash(world.scatter[0].mask), 0U);
}

TEST(Mask, IsRejectedWithLineAndField) {
  EXPECT_THAT(
      mask_error("mask_image = \"missing.png\""),
      HasSubstr("maps/w.toml:23: scatter[1].mask_image: maps/missing.png: there is no such"));
  EXPECT_THAT(mask_error("mask_image = \"../m.png\""), HasSubstr("without .."));
  EXPECT_THAT(mask_error("mask_area_m = [0, 0, 1, 1]"), HasSubstr("mask_image, which is missing"));
  for (const char* area : {"[0, 0, 0, 1]", "[0, 0, 1]", "[0, 0, 1, nan]", "[0, 9, 1, 1]", "7"}) {
    EXPECT_THAT(mask_error(std::string("mask_image = \"m.png\"\nmask_area_m = ") + area),
                HasSubstr("scatter[1].mask_area_m"))
        << area;
  }
  EXPECT_THAT(mask_error("on_ground = [\"moss\"]"),
              HasSubstr("allowed: grass, forest, dry, sand, rock, snow"));
  for (const char* grounds : {"[]", "\"grass\"", "[1]", "[\"grass\", [\"dry\"]]"})
    EXPECT_THAT(mask_error(std::string("on_ground = ") + grounds),
                HasSubstr("scatter[1].on_ground"))
        << grounds;
  EXPECT_THAT(mask_error("mask_share = 1.5"), HasSubstr("scatter[1].mask_share"));
  EXPECT_THAT(mask_error("mask_noise_m = -1"), HasSubstr("scatter[1].mask_noise_m"));
  EXPECT_THAT(mask_error("mask_noises_m = 1"), HasSubstr("did you mean mask_noise_m"));
  const auto unread = parse_world(
      replaced(kSmallWorld, "count = 5", "count = 5\nmask_image = \"m.png\""), "w", registry());
  ASSERT_FALSE(unread.has_value());
  EXPECT_THAT(unread.error().message, HasSubstr("cannot read glTF models and images"));
  const std::string endless = replaced(replaced(kSmallWorld, "[8, 4]", "[0, 4]"), "count = 5",
                                       "count = 5\nmask_image = \"m.png\"");
  static const HalfPictures pictures;
  EXPECT_THAT(parse_world(endless, "w", registry(), &pictures).error().message,
              HasSubstr("needs mask_area_m"));
}

}  // namespace
}  // namespace psygen::world
