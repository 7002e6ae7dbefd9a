#include "engine/models/ground/ground_mask.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "engine/models/edits.hpp"
#include "engine/models/ground/erosion.hpp"
#include "engine/models/network/network.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/shape.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "tests/engine/models/mesh_helpers.hpp"

namespace psygen::models {
namespace {

using core::TerrainVertex;
using test::synthesise;

constexpr double kBlockM = 63, kReliefM = 120;

std::shared_ptr<const GreyPicture> random_picture(std::mt19937& random) {
  auto picture = std::make_shared<GreyPicture>();
  picture->width = 1 + static_cast<std::uint32_t>(random() % 9);
  picture->height = 1 + static_cast<std::uint32_t>(random() % 9);
  for (std::uint32_t i = 0; i < picture->width * picture->height; ++i)
    picture->pixels.push_back(static_cast<std::uint16_t>(random() % 65'536));
  picture->hash = content_hash(*picture);
  return picture;
}

class MaskedGround : public ::testing::Test {
 protected:
  std::unique_ptr<ModelType> type = make_terrain_type();
  Parameters paper = default_parameters(*type);
  EditLayer layer;
  std::mt19937 random{11};
  std::uniform_real_distribution<double> unit{0, 1};

  std::shared_ptr<GroundMask> any_mask(bool with_guide = true) {
    auto mask = std::make_shared<GroundMask>();
    if (random() % 2 == 0) mask->picture = random_picture(random);
    if (random() % 4 == 0) mask->area_m = {-200, -150, 150, 250};
    if (random() % 2 == 0) mask->noise_m = 5 + 100 * unit(random);
    mask->share = unit(random);
    mask->patches = random();
    if (!with_guide) return mask;
    if (random() % 2 == 0)
      mask->height_m = {20 * unit(random), 10 * unit(random), 30 + 60 * unit(random), 5};
    if (random() % 2 == 0) mask->slope.max = unit(random), mask->slope.max_fade = 0.2;
    return mask;
  }
  GroundEdit any_edit(bool with_guide = true) {
    GroundEdit edit;
    edit.change = static_cast<GroundChange>(random() % 4);
    edit.blend = static_cast<GroundBlend>(random() % 3);
    edit.strength = random() % 3 == 0 ? 1 : unit(random);
    edit.centre = {
        {static_cast<std::int32_t>(random() % 4) - 2, static_cast<std::int32_t>(random() % 4) - 2},
        {kBlockM * unit(random), 0, kBlockM * unit(random)}};
    edit.radius_m = 5 + 90 * unit(random);
    edit.falloff = unit(random);
    edit.height_m =
        edit.change == GroundChange::kRaise ? 80 * unit(random) - 40 : 100 * unit(random);
    if (is_stamp(edit.change)) {
      auto map = std::make_shared<Heightmap>();
      map->columns = map->rows = 2 + static_cast<std::uint32_t>(random() % 9);
      for (std::uint32_t i = 0; i < map->columns * map->rows; ++i)
        map->heights_m.push_back(static_cast<float>(60 * unit(random)));
      edit.map = map;
      edit.square = true;
      edit.sides = {1, 0.5 + 0.5 * unit(random)};
      edit.turn = {0.6, 0.8};
    }
    if (random() % 4 != 0) edit.mask = any_mask(with_guide);
    return edit;
  }
  void add(GroundEdit edit) {
    edit.id = layer.next_id++;
    seal(edit);
    ASSERT_TRUE(layer.ground.edits.add(std::make_shared<const GroundEdit>(edit), kBlockM));
  }
  Parameters node(std::int64_t x, std::int64_t z, int level, bool edited = true) const {
    Parameters p = paper;
    p.set_integer(kTerrainBlockX, x);
    p.set_integer(kTerrainBlockZ, z);
    p.set_integer(kTerrainNodeLevel, level);
    if (edited) p.set_edits(&layer, 1);
    return p;
  }
  double metres_of(float value) const { return double{value} * double{TerrainShape(paper).metres}; }
  double median_m(std::vector<float> values) const {
    std::ranges::sort(values);
    return metres_of(values[values.size() / 2]);
  }
  std::vector<float> heights(const Parameters& p, std::span<const std::int64_t> x,
                             std::span<const std::int64_t> z, GroundDetail detail = {}) const {
    std::vector<float> values(x.size() * z.size());
    TerrainShape(p).evaluate(x, z, values, x.size(), detail);
    return values;
  }
};

std::vector<std::int64_t> range(std::int64_t first, std::size_t count, std::int64_t step = 1) {
  std::vector<std::int64_t> at(count);
  for (std::size_t i = 0; i < count; ++i)
    at[i] = first + static_cast<std::int64_t>(i) * step;
  return at;
}

// Every operation is monotone in the height below it, so what it makes of the lowest and of the
// highest ground bounds what it makes of any: at a million samples, with the true ground between.
TEST_F(MaskedGround, FoldedBoundsHoldAtAMillionSamples) {
  const TerrainShape shape(node(0, 0, 0, false));
  const GroundScale scale{.cells_per_block = 63,
                          .cell_m = 1,
                          .unit_m = static_cast<double>(shape.metres),
                          .highest = 65535.0F / shape.quantum};
  class Guide final : public ErosionGuide {
   public:
    explicit Guide(const RidgedNoise& noise) : noise_(noise) {}
    void heights(std::span<const std::int64_t> columns, std::span<const std::int64_t> rows, double,
                 std::span<float> values, std::size_t stride) const override {
      noise_.evaluate(columns, rows, values, stride, 4);
    }

   private:
    const RidgedNoise& noise_;
  } const guide(shape.noise);
  std::size_t samples = 0, moved = 0;
  while (samples < 1'000'000) {
    layer = {};
    for (int i = 0; i < 12; ++i)
      add(any_edit());
    const auto x = range(-126, 144), z = range(-126, 144);
    std::vector<float> real(x.size() * z.size());
    shape.noise.evaluate(x, z, real, x.size());
    std::vector<float> low(real.size(), 0.0F), high(real.size(), scale.highest);
    const std::vector<float> before = real;
    for (std::vector<float>* values : {&real, &low, &high})
      layer.ground.edits.apply(scale, x, z, *values, x.size(), 0, &guide);
    std::array<double, 16> max_m;  // of the blocks
    for (std::int32_t b = 0; b < 16; ++b)
      max_m[static_cast<std::size_t>(b)] =
          layer.ground.edits.max_change_in(QuadCoord::of({b % 4 - 2, b / 4 - 2}), kBlockM).change_m;
    for (std::size_t i = 0; i < real.size(); ++i) {
      const std::size_t block = i / x.size() / 63 * 4 + i % x.size() / 63;
      ASSERT_LE(low[i], real[i]) << i;
      ASSERT_LE(real[i], high[i]) << i;
      ASSERT_LE(std::abs(double{real[i]} - double{before[i]}) * scale.unit_m, max_m[block] + 1e-3);
      moved += real[i] != before[i] ? 1 : 0;
    }
    samples += real.size();
  }
  EXPECT_GT(moved, samples / 4);
}

TEST_F(MaskedGround, AHeightHasTheSameBitsInAnyBatch) {
  for (int i = 0; i < 40; ++i)
    add(any_edit());
  for (const int level : {0, 3}) {
    const GroundDetail detail = GroundDetail::of_node(level);
    const auto x = range(-120, 40, 5), z = range(-100, 40, 5);
    const auto together = heights(node(0, 0, 0), x, z, detail);
    std::size_t changed = 0;
    const auto base = heights(node(0, 0, 0, false), x, z, detail);
    for (std::size_t k = 0; k < z.size(); ++k) {
      for (std::size_t i = 0; i < x.size(); ++i) {
        const std::int64_t at_x[]{x[i]}, at_z[]{z[k]};
        ASSERT_EQ(heights(node(0, 0, 0), at_x, at_z, detail)[0], together[k * x.size() + i]);
        changed += together[k * x.size() + i] != base[k * x.size() + i] ? 1 : 0;
      }
    }
    EXPECT_GT(changed, x.size());
  }
}

TEST_F(MaskedGround, SharedVerticesOfNeighboursAndLevelsAgree) {
  for (int i = 0; i < 60; ++i)
    add(any_edit());
  for (int level = 0; level <= 4; ++level) {
    const auto vertices = [&](std::int64_t x, std::int64_t z, int of) {
      return synthesise(*type, node(x, z, of), 1).vertices<TerrainVertex>();
    };
    const auto here = vertices(-1, 0, level), east = vertices(0, 0, level),
               south = vertices(-1, 1, level);
    constexpr std::size_t n = 22, last = n - 1;
    for (std::size_t k = 0; k < n; ++k) {
      EXPECT_EQ(here[k * n + last].height, east[k * n].height) << level;
      EXPECT_EQ(here[last * n + k].height, south[k].height) << level;
      EXPECT_EQ(here[k * n + last].coarse_height, east[k * n].coarse_height) << level;
    }
    if (level == 0) continue;
    const auto child = vertices(-2, 0, level - 1);
    for (std::size_t z = 0; 2 * z < n; ++z) {
      for (std::size_t x = 0; 2 * x < n; ++x)
        EXPECT_EQ(here[z * n + x].height, child[2 * z * n + 2 * x].height) << level;
    }
  }
}

TEST_F(MaskedGround, NoMeshDeviatesFromTheGroundByMoreThanItsError) {
  for (int round = 0; round < 40; ++round) {
    layer = {};
    for (int i = 0; i < 3; ++i) {
      GroundEdit edit = any_edit();
      edit.centre.block = {0, 0};
      edit.falloff = 0.5;
      add(edit);
    }
    const BlockGround base(node(0, 0, 0, false), {0, 0}, 100'000);
    const BlockGround edited(node(0, 0, 0), {0, 0}, 100'000);
    const double limit_m =
        std::min(layer.ground.error_m(QuadCoord::of({0, 0}), 9, kBlockM), kReliefM);
    for (int z = 0; z < 63; ++z) {
      for (int x = 0; x < 63; ++x) {
        const auto change = [&](int stride) {
          return edited.at({x, z}, stride).height_m - base.at({x, z}, stride).height_m;
        };
        ASSERT_LE(std::abs(change(1) - change(9)), limit_m + 0.01) << round;
      }
    }
  }
}

// A mask of patches alone has a bound of its steepness, so its error is below its height.
TEST_F(MaskedGround, WidePatchesHaveSmallErrorsBetweenVertices) {
  GroundEdit hill;
  hill.radius_m = 1000;
  hill.height_m = 20;
  GroundMask mask;
  mask.noise_m = 2000;
  hill.mask = std::make_shared<const GroundMask>(mask);
  add(hill);
  EXPECT_LT(layer.ground.error_m(QuadCoord::of({0, 0}), 3, kBlockM), 2);
  layer = {};
  mask.height_m.min = 10;
  hill.mask = std::make_shared<const GroundMask>(mask);
  add(hill);
  EXPECT_EQ(layer.ground.error_m(QuadCoord::of({0, 0}), 3, kBlockM), 20);
}

TEST_F(MaskedGround, StrengthZeroAndBlackMasksChangeNoBit) {
  auto black = std::make_shared<GreyPicture>(GreyPicture{1, 1, {0}, 0});
  for (int i = 0; i < 80; ++i) {
    GroundEdit edit = any_edit();
    auto mask = any_mask();
    if (i % 4 == 0) edit.strength = 0;
    if (i % 4 == 1) mask->picture = black;
    if (i % 4 == 2) mask->noise_m = 50, mask->share = 0;
    if (i % 4 == 3) mask->height_m = {200, 0, 300, 0};
    edit.mask = mask;
    add(edit);
  }
  const auto x = range(-126, 126), z = range(-126, 126);
  EXPECT_EQ(heights(node(0, 0, 0), x, z), heights(node(0, 0, 0, false), x, z));
}

TEST_F(MaskedGround, BlendsOnlyRaiseOrOnlyLower) {
  const auto x = range(-126, 126), z = range(-126, 126);
  const auto base = heights(node(0, 0, 0, false), x, z);
  const double middle_m = median_m(base);
  const auto changes = [&](GroundBlend blend) {
    layer = {};
    GroundEdit flat;
    flat.change = GroundChange::kFlatten;
    flat.radius_m = 150;
    flat.height_m = middle_m;
    flat.blend = blend;
    add(flat);
    const auto now = heights(node(0, 0, 0), x, z);
    std::pair<std::size_t, std::size_t> count;
    for (std::size_t i = 0; i < now.size(); ++i) {
      count.first += now[i] > base[i] ? 1 : 0;
      count.second += now[i] < base[i] ? 1 : 0;
    }
    return count;
  };
  const auto [up, down] = changes(GroundBlend::kMix);
  EXPECT_GT(up, 500U);
  EXPECT_GT(down, 500U);
  EXPECT_EQ(changes(GroundBlend::kHighest), std::pair(up, std::size_t{0}));
  EXPECT_EQ(changes(GroundBlend::kLowest), std::pair(std::size_t{0}, down));
}

// The guide that a mask reads has no narrow octaves, and shapes below do not move it.
TEST_F(MaskedGround, RangesFollowTheSlowGround) {
  const auto x = range(-126, 126), z = range(-126, 126);
  const auto base = heights(node(0, 0, 0, false), x, z);
  const double middle_m = median_m(base);
  GroundEdit mark;
  mark.square = true;
  mark.radius_m = 500;
  mark.falloff = 0;
  mark.height_m = 1;
  GroundMask high;
  high.height_m.min = middle_m;
  mark.mask = std::make_shared<const GroundMask>(high);
  const auto marked = [&] {
    const auto now = heights(node(0, 0, 0), x, z);
    layer.ground.edits = {};
    return now;
  };
  add(mark);
  const auto alone = marked();
  std::size_t wrong = 0, inside = 0;
  for (std::size_t i = 0; i < base.size(); ++i) {
    inside += alone[i] > base[i] ? 1 : 0;
    wrong += (alone[i] > base[i]) != (metres_of(base[i]) > middle_m) ? 1 : 0;
  }
  EXPECT_GT(inside, base.size() / 10);
  EXPECT_LT(inside, base.size() * 9 / 10);
  EXPECT_LT(wrong, base.size() / 10);  // near the border, by narrow octaves
  GroundEdit tower = mark;
  tower.mask = nullptr;
  tower.height_m = 10;
  add(tower);
  add(mark);
  const auto after = marked();
  for (std::size_t i = 0; i < base.size(); ++i) {
    if (metres_of(base[i]) > kReliefM - 12) continue;  // the height range ends
    ASSERT_NEAR(metres_of(after[i] - base[i]), alone[i] > base[i] ? 11 : 10, 0.01) << i;
  }
}

TEST_F(MaskedGround, PatchesCoverTheirShareAndPicturesTheirArea) {
  GroundMask mask;
  mask.noise_m = 10;
  mask.patches = 4;
  for (const double share : {0.2, 0.5, 0.8}) {
    mask.share = share;
    double sum = 0;
    for (int i = 0; i < 40'000; ++i)
      sum += mask.at({3.1 * (i % 200), 3.1 * (i / 200)}, {0, 0});
    EXPECT_NEAR(sum / 40'000, share, 0.05);
  }
  mask.share = 1;
  EXPECT_EQ(mask.at({3, 4}, {0, 0}), 1);
  mask.noise_m = 0;
  mask.picture = std::make_shared<const GreyPicture>(GreyPicture{2, 1, {0, 65'535}, 1});
  EXPECT_EQ(mask.at({1e6, 0}, {0.1, 0}), 0);
  EXPECT_EQ(mask.at({1e6, 0}, {0.9, 0}), 1);
  EXPECT_EQ(mask.at({1e6, 0}, {0.5, 0}), 0.5);
  mask.area_m = {100, 100, 200, 200};
  EXPECT_EQ(mask.at({1e6, 0}, {0.9, 0}), 0);
  EXPECT_EQ(mask.at({190, 150}, {0, 0}), 1);
  EXPECT_EQ(mask.at({110, 150}, {0, 0}), 0);
}

TEST_F(MaskedGround, EveryMemberIsPartOfTheHash) {
  GroundEdit edit;
  seal(edit);
  std::vector<std::uint64_t> hashes{edit.content};
  const auto note = [&](const std::function<void(GroundEdit&, GroundMask&)>& change) {
    GroundEdit changed;
    GroundMask mask;
    change(changed, mask);
    changed.mask = std::make_shared<const GroundMask>(mask);
    seal(changed);
    hashes.push_back(changed.content);
  };
  note([](GroundEdit&, GroundMask&) {});
  note([](GroundEdit& e, GroundMask&) { e.strength = 0.5; });
  note([](GroundEdit& e, GroundMask&) { e.blend = GroundBlend::kHighest; });
  note([](GroundEdit& e, GroundMask&) { e.blend = GroundBlend::kLowest; });
  note([&](GroundEdit&, GroundMask& m) { m.picture = random_picture(random); });
  note([](GroundEdit&, GroundMask& m) { m.area_m[3] = 1; });
  note([](GroundEdit&, GroundMask& m) { m.noise_m = 3; });
  note([](GroundEdit&, GroundMask& m) { m.share = 0.1; });
  note([](GroundEdit&, GroundMask& m) { m.patches = 3; });
  note([](GroundEdit&, GroundMask& m) { m.height_m.min = 3; });
  note([](GroundEdit&, GroundMask& m) { m.height_m.min_fade = 3; });
  note([](GroundEdit&, GroundMask& m) { m.height_m.max = 3; });
  note([](GroundEdit&, GroundMask& m) { m.height_m.max_fade = 3; });
  note([](GroundEdit&, GroundMask& m) { m.slope.min = 3; });
  note([](GroundEdit&, GroundMask& m) { m.slope.max = 3; });
  std::ranges::sort(hashes);
  EXPECT_EQ(std::ranges::adjacent_find(hashes), hashes.end());
}

TEST_F(MaskedGround, MasksCostTime) {
  const auto steps_of = [&](const GroundMask* mask) {
    layer = {};
    GroundEdit edit;
    edit.radius_m = 500;
    if (mask != nullptr) edit.mask = std::make_shared<const GroundMask>(*mask);
    add(edit);
    return type->steps(node(0, 0, 0), 0);
  };
  GroundMask patches, slope;
  patches.noise_m = 10;
  slope.slope.max = 1;
  EXPECT_GT(steps_of(&patches), steps_of(nullptr));
  EXPECT_GT(steps_of(&slope), steps_of(nullptr));
}

// The reads are priced apart: those of a network take far more time than those of noise, and masks
// over the same places share them.
TEST_F(MaskedGround, ReadsOfTheGuideCostTime) {
  GroundMask slope;
  slope.slope.max = 1;
  const auto more = [&](bool over_network, int masks) {
    layer = {};
    if (over_network)
      layer.ground.network = *RiverNetwork::create(
          {.seed = 11, .root_spacing_m = 1024, .halvings = 5},
          {.cell_m = 1, .cells_per_block = 63, .relief_m = 120}, std::make_shared<NetworkStore>());
    const double bare = type->steps(node(0, 0, 0), 0);
    GroundEdit edit;
    edit.radius_m = 500;
    edit.mask = std::make_shared<const GroundMask>(slope);
    for (int i = 0; i < masks; ++i)
      add(edit);
    return type->steps(node(0, 0, 0), 0) - bare;
  };
  EXPECT_GT(more(true, 1), 4 * more(false, 1));
  EXPECT_LT(more(true, 3), 1.5 * more(true, 1));
  EXPECT_NEAR(more(true, 3) - more(true, 2), more(false, 3) - more(false, 2), 1);
}

// Counts the heights that masks read of it.
struct CountedGuide final : ErosionGuide {
  mutable std::size_t reads = 0;
  void heights(std::span<const std::int64_t> columns, std::span<const std::int64_t> rows, double,
               std::span<float> values, std::size_t stride) const override {
    reads += columns.size() * rows.size();
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t c = 0; c < columns.size(); ++c)
        values[r * stride + c] = 0.01F * static_cast<float>(columns[c] + 2 * rows[r]);
    }
  }
};

TEST_F(MaskedGround, EditsOverTheSamePlacesReadTheGuideOnce) {
  const std::vector<std::int64_t> at = range(0, 63);
  const auto reads = [&](std::initializer_list<GroundEdit> edits) {
    layer = {};
    for (const GroundEdit& edit : edits)
      add(edit);
    const CountedGuide guide;
    std::vector<float> values(at.size() * at.size());
    layer.ground.edits.apply({}, at, at, values, at.size(), 0, &guide);
    return guide.reads;
  };
  GroundMask slope, height;
  slope.slope.max = 1;
  height.height_m.min = 0.1;
  GroundEdit wide;
  wide.square = true;
  wide.radius_m = 500;
  wide.mask = std::make_shared<const GroundMask>(slope);
  GroundEdit low = wide;
  low.mask = std::make_shared<const GroundMask>(height);
  EXPECT_EQ(reads({low}), 63 * 63U);
  EXPECT_EQ(reads({wide}), 5 * 63 * 63U);
  EXPECT_EQ(reads({wide, low, wide}), 5 * 63 * 63U);
  GroundEdit corner = wide, other = low;
  corner.radius_m = other.radius_m = 4;
  corner.centre.local = {5, 0, 5};
  other.centre.local = {55, 0, 55};
  EXPECT_EQ(reads({corner, other}), 6 * 81U) << "nothing between them";
}

}  // namespace
}  // namespace psygen::models
