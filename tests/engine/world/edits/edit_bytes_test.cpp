#include "engine/world/edits/edit_bytes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <span>

#include "engine/models/terrain/terrain.hpp"
#include "tests/engine/world/edits/edited_world.hpp"

namespace psygen::world {
namespace {

using testing::hash_of;
using ::testing::HasSubstr;

class EditBytes : public ::testing::Test, protected testing::EditedWorld {
 protected:
  void SetUp() override {
    ASSERT_TRUE(edits.remove(world, {{2, 3}, 4}));
    ASSERT_TRUE(edits.remove(world, {{2, 3}, 1}));
    const std::uint32_t tree = unedited({2, 3})[3].index;
    ASSERT_TRUE(edits.move(world, registry, {{2, 3}, tree}, {{2, 3}, {62.9999999, 0, 7}}));
    ASSERT_TRUE(edits.raise(world, {{2, 3}, {30, 0, 31}}, 20, 9));
    ASSERT_TRUE(edits.flatten(world, {{2, 3}, {35, 0, 31}}, 20, 30));
    models::GroundEdit stamp;
    stamp.change = models::GroundChange::kStampAdd;
    stamp.centre = {{2, 4}, {1, 0, 1}};
    stamp.radius_m = 30;
    auto map = std::make_shared<models::Heightmap>();
    *map = {3, 2, {1, 2, 3, 4, 5, 6}};
    stamp.map = map;
    ASSERT_TRUE(edits.edit_ground(world, stamp));
    stamp.strength = 0.5;
    stamp.blend = models::GroundBlend::kHighest;
    ASSERT_TRUE(edits.edit_ground(world, stamp));
  }
};

// Where a text begins in the bytes.
std::vector<std::byte>::iterator find(std::vector<std::byte>& bytes, std::string_view text) {
  const auto wanted = std::as_bytes(std::span(text));
  return std::search(bytes.begin(), bytes.end(), wanted.begin(), wanted.end());
}

TEST_F(EditBytes, LoadingTheBlocksInAnyOrderGivesTheSameEdits) {
  std::map<core::BlockCoord, std::vector<std::byte>> stored;
  for (const core::BlockCoord block : changed_blocks({}, edits))
    stored[block] = encode_block(edits, registry, block);
  EXPECT_EQ(stored.size(), 2u);
  Edits forward, backward;
  for (auto it = stored.begin(); it != stored.end(); ++it)
    ASSERT_TRUE(load_block(forward, world, registry, it->first, it->second));
  for (auto it = stored.rbegin(); it != stored.rend(); ++it) {
    const auto ok = load_block(backward, world, registry, it->first, it->second);
    ASSERT_TRUE(ok) << ok.error().message;
  }
  for (const Edits& loaded : {forward, backward}) {
    EXPECT_EQ(hash_of(loaded), hash_of(edits));
    const models::QuadCoord all{models::QuadCoord::kMaxLevel, 0, 0};
    EXPECT_EQ(loaded.layer()->ground.hash_of(all, 0, world.block_size_m()),
              edits.layer()->ground.hash_of(all, 0, world.block_size_m()));
    EXPECT_EQ(loaded.layer()->next_id, edits.layer()->next_id);
    EXPECT_EQ(encode_block(loaded, registry, {2, 3}), stored.begin()->second);
    EXPECT_EQ(loaded.layer()->blocks.root()->summary.reach_m,
              edits.layer()->blocks.root()->summary.reach_m);
  }
}

TEST_F(EditBytes, BlocksWithoutEditsHaveNoBytes) {
  EXPECT_TRUE(encode_block(edits, registry, {9, 9}).empty());
  EXPECT_TRUE(encode_block({}, registry, {2, 3}).empty());
}

TEST_F(EditBytes, TruncatedOrExtendedBytesAreRejected) {
  const std::vector<std::byte> whole = encode_block(edits, registry, {2, 3});
  Edits loaded;
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto ok = load_block(loaded, world, registry, {2, 3}, std::span(whole).first(length));
    ASSERT_FALSE(ok) << length;
    EXPECT_THAT(ok.error().message, HasSubstr("edits of block (2, 3) cannot be read"));
  }
  std::vector<std::byte> longer = whole;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(load_block(loaded, world, registry, {2, 3}, longer));
  EXPECT_FALSE(load_block(loaded, world, registry, {-2, 3}, whole)) << "outside the world";
  EXPECT_TRUE(loaded.empty());
}

// Old saves hold models of types that have gained a parameter since.
TEST_F(EditBytes, AParameterThatAnOlderVersionLackedHasItsDefault) {
  const models::PlacedModel& moved = edits.layer()->block({2, 3})->placed.front();
  const models::ModelType& type = registry[*type_of(moved, registry)];
  const std::size_t last = type.parameters().size() - 1;
  std::vector<std::byte> bytes = encode_block(edits, registry, {2, 3});
  const auto count = find(bytes, type.name()) + std::ssize(type.name());
  ASSERT_EQ(std::to_integer<std::size_t>(*count), last + 1);
  *count = std::byte(last);
  const auto value = count + 1 + static_cast<std::ptrdiff_t>(8 * last);
  bytes.erase(value, value + 8);
  Edits loaded;
  const auto ok = load_block(loaded, world, registry, {2, 3}, bytes);
  ASSERT_TRUE(ok) << ok.error().message;
  const models::Parameters& found = loaded.layer()->block({2, 3})->placed.front().parameters;
  EXPECT_EQ(found.integer(last), models::default_parameters(type).integer(last));
  for (std::size_t i = 0; i < last; ++i)
    EXPECT_EQ(found.integer(i), moved.parameters.integer(i));
}

// Bytes of the block with another name for the type of the moved model.
std::vector<std::byte> renamed(std::vector<std::byte> bytes, std::string_view from,
                               std::string_view to) {
  std::ranges::copy(std::as_bytes(std::span(to)), find(bytes, from));
  return bytes;
}

TEST_F(EditBytes, AModelOfAMissingTypeIsKeptHiddenAndStoredAgain) {
  const std::string type = edits.layer()->block({2, 3})->placed.front().type;
  const std::vector<std::byte> whole = encode_block(edits, registry, {2, 3});
  const std::vector<std::byte> foreign = renamed(whole, type, std::string(type.size(), 'q'));
  Edits loaded;
  const auto ok = load_block(loaded, world, registry, {2, 3}, foreign);
  ASSERT_TRUE(ok) << ok.error().message;
  EXPECT_EQ(hidden_models(loaded, registry),
            (std::vector<EditName>{{{2, 3}, edits.layer()->block({2, 3})->placed.front().id}}));
  EXPECT_EQ(encode_block(loaded, registry, {2, 3}), foreign);
  EXPECT_EQ(loaded.counts().removed, 3u) << "the other edits hold";
  apply();
  const std::size_t with_model = placements({2, 3}).size();
  set_edits(world, loaded.layer());
  EXPECT_EQ(placements({2, 3}).size() + 1, with_model);
  EXPECT_TRUE(hidden_models(edits, registry).empty());
  auto decoded = *decode_block({2, 3}, foreign);
  const auto unfit = unfit_edits(decoded, world, registry, {2, 3});
  ASSERT_EQ(unfit.size(), 1u);
  EXPECT_TRUE(unfit[0].kind == EditKind::kPlaced && unfit[0].hidden);
  EXPECT_EQ(unfit[0].reason, "there is no model type \"" + std::string(type.size(), 'q') + "\"");
}

TEST_F(EditBytes, AModelThatItsTypeDoesNotAllowIsKeptHidden) {
  const models::PlacedModel& moved = edits.layer()->block({2, 3})->placed.front();
  const models::ModelType& type = registry[*type_of(moved, registry)];
  std::vector<std::byte> bytes = encode_block(edits, registry, {2, 3});
  const auto end = find(bytes, type.name()) + std::ssize(type.name());
  const std::size_t count = type.parameters().size();
  *end = std::byte(count + 1);  // as if the type had lost a parameter
  const auto value = end + 1 + static_cast<std::ptrdiff_t>(8 * count);
  bytes.insert(value, 8, std::byte{1});
  Edits loaded;
  const auto ok = load_block(loaded, world, registry, {2, 3}, bytes);
  ASSERT_TRUE(ok) << ok.error().message;
  EXPECT_EQ(hidden_models(loaded, registry).size(), 1u);
  EXPECT_EQ(encode_block(loaded, registry, {2, 3}), bytes);
  find(bytes, type.name())[std::ssize(type.name())] = std::byte{200};
  const auto absurd = load_block(loaded, world, registry, {2, 3}, bytes);
  ASSERT_FALSE(absurd);
  EXPECT_THAT(absurd.error().message, HasSubstr("200 parameters, but the maximum is 24"));
}

TEST_F(EditBytes, EditsThatAWorldDoesNotAllowAreListedByKindAndId) {
  const std::vector<std::byte> whole = encode_block(edits, registry, {2, 3});
  World flat = function;
  flat.scatter.clear();
  flat.terrain.set_real(models::kTerrainReliefM, 20);
  auto decoded = *decode_block({2, 3}, whole);
  const auto unfit = unfit_edits(decoded, flat, registry, {2, 3});
  std::vector<std::pair<EditKind, std::uint32_t>> found;
  for (const UnfitEdit& edit : unfit)
    found.emplace_back(edit.kind, edit.id);
  const auto& here = *edits.layer()->block({2, 3});
  EXPECT_EQ(found, (std::vector<std::pair<EditKind, std::uint32_t>>{
                       {EditKind::kRemoved, here.removed[0].index},
                       {EditKind::kRemoved, here.removed[1].index},
                       {EditKind::kRemoved, here.removed[2].index},
                       {EditKind::kGround, here.ground[1]->id}}));
  EXPECT_THAT(unfit.back().reason, HasSubstr("ground at 30 m is not allowed"));
  EXPECT_EQ(encode_block(decoded), whole) << "listing changes no edit";
}

TEST_F(EditBytes, ANewerVersionIsRejectedByItsNumber) {
  std::vector<std::byte> newer = encode_block(edits, registry, {2, 3});
  newer[4] = std::byte{9};
  Edits loaded;
  const auto ok = load_block(loaded, world, registry, {2, 3}, newer);
  ASSERT_FALSE(ok);
  EXPECT_THAT(ok.error().message, HasSubstr("version is 9"));
}

// The target block of the moved model is not loaded.
TEST_F(EditBytes, TheIdOfAMovedModelIsNotReused) {
  Edits one;
  const auto moved = one.move(world, registry, {{2, 3}, unedited({2, 3})[3].index}, {{4, 3}, {}});
  ASSERT_TRUE(moved) << moved.error().message;
  Edits loaded;
  ASSERT_TRUE(load_block(loaded, world, registry, {2, 3}, encode_block(one, registry, {2, 3})));
  const Scatter& rocks = world.scatter[1];
  const auto placed = loaded.place(
      world, registry, {rocks.model, scatter_parameters(registry, rocks), {{4, 3}, {5, 0, 5}}, 0});
  ASSERT_TRUE(placed) << placed.error().message;
  EXPECT_NE(placed->id, moved->id);
  ASSERT_TRUE(loaded.restore({{2, 3}, unedited({2, 3})[3].index}));
  EXPECT_EQ(loaded.counts().placed, 1u) << "the rock stays";
}

TEST_F(EditBytes, AMovedModelWithAnIdAboveTheMaximumIsRejected) {
  Edits one;
  ASSERT_TRUE(one.move(world, registry, {{2, 3}, unedited({2, 3})[3].index}, {{4, 3}, {}}));
  std::vector<std::byte> bytes = encode_block(one, registry, {2, 3});
  constexpr std::size_t kMovedId = 4 + 2 + 4 + 4;  // magic, version, count, index
  ASSERT_EQ(bytes[kMovedId], std::byte{1});
  std::fill_n(bytes.begin() + kMovedId, 4, std::byte{0xFF});
  Edits loaded;
  const auto ok = load_block(loaded, world, registry, {2, 3}, bytes);
  ASSERT_FALSE(ok);
  EXPECT_THAT(ok.error().message, HasSubstr("id 4294967295"));
}

TEST_F(EditBytes, AStoredStampIsAlwaysSquare) {
  const std::vector<std::byte> whole = encode_block(edits, registry, {2, 4});
  constexpr std::size_t kSquare = 4 + 2 + 3 * 4 + 4 + 1;  // magic, version, counts, id, change
  ASSERT_EQ(whole[kSquare], std::byte{1});
  std::vector<std::byte> disc = whole;
  disc[kSquare] = std::byte{0};
  Edits loaded;
  ASSERT_TRUE(load_block(loaded, world, registry, {2, 4}, disc));
  EXPECT_EQ(encode_block(loaded, registry, {2, 4}), whole);
}

// Edits that make their whole change have the bytes of older programs, except rivers, which have
// their discharge; older programs reject the others.
TEST_F(EditBytes, StrengthAndBlendOfAnEditAreStored) {
  models::GroundEdit flat;
  flat.change = models::GroundChange::kFlatten;
  flat.centre = {{5, 5}, {20, 0, 30}};
  flat.radius_m = 25;
  flat.height_m = 30;
  Edits whole, part;
  ASSERT_TRUE(whole.edit_ground(world, flat));
  flat.strength = 0.75;
  flat.blend = models::GroundBlend::kLowest;
  ASSERT_TRUE(part.edit_ground(world, flat));
  const std::vector<std::byte> of_whole = encode_block(whole, registry, {5, 5}),
                               of_part = encode_block(part, registry, {5, 5});
  EXPECT_EQ(of_whole.size() + 9, of_part.size());
  constexpr std::size_t kChange = 4 + 2 + 3 * 4 + 4;  // magic, version, counts, id
  EXPECT_EQ(of_whole[kChange], std::byte{1});
  EXPECT_EQ(of_part[kChange], std::byte{0x81});
  Edits loaded;
  ASSERT_TRUE(load_block(loaded, world, registry, {5, 5}, of_part));
  EXPECT_EQ(hash_of(loaded), hash_of(part));
  EXPECT_NE(hash_of(loaded), hash_of(whole));
  const models::GroundEdit& back = *loaded.layer()->block({5, 5})->ground[0];
  EXPECT_EQ(back.strength, 0.75);
  EXPECT_EQ(back.blend, models::GroundBlend::kLowest);
}

TEST_F(EditBytes, BlocksFromDifferentEditsMayHaveTheSameIds) {
  Edits hill, flat, loaded;
  const auto raised = hill.raise(world, {{2, 3}, {60, 0, 31}}, 20, 9);
  const auto flattened = flat.flatten(world, {{3, 3}, {3, 0, 31}}, 20, 30);
  ASSERT_TRUE(raised && flattened);
  ASSERT_EQ(raised->id, flattened->id);
  ASSERT_TRUE(load_block(loaded, world, registry, {2, 3}, encode_block(hill, registry, {2, 3})));
  ASSERT_TRUE(load_block(loaded, world, registry, {3, 3}, encode_block(flat, registry, {3, 3})));
  ASSERT_TRUE(loaded.remove_ground(world, *raised));
  set_edits(world, loaded.layer());
  const std::uint64_t left = terrain_parameters(world, {2, 3}).edits_hash();
  set_edits(world, flat.layer());
  EXPECT_EQ(left, terrain_parameters(world, {2, 3}).edits_hash());
  EXPECT_NE(left, 0u);
}

// All decoded edits are legal: they can be used, and are equal when stored again.
TEST_F(EditBytes, AnyBytesAreRejectedOrGiveLegalEdits) {
  std::mt19937 random(17);
  std::size_t accepted = 0, refused = 0;
  for (const core::BlockCoord block : {core::BlockCoord{2, 3}, core::BlockCoord{2, 4}}) {
    const std::vector<std::byte> whole = encode_block(edits, registry, block);
    for (int round = 0; round < 3000; ++round) {
      std::vector<std::byte> bytes = whole;
      for (std::size_t k = 0; k <= random() % 4; ++k)
        bytes[random() % bytes.size()] = static_cast<std::byte>(random());
      Edits loaded;
      if (!load_block(loaded, world, registry, block, bytes)) {
        ++refused;
        EXPECT_TRUE(loaded.empty());
        continue;
      }
      ++accepted;
      World copy = function;
      set_edits(copy, loaded.layer());
      std::vector<Placement> out;
      if (round % 50 == 0) place_models(copy, registry, block, out);
      Edits again;
      EXPECT_TRUE(load_block(again, world, registry, block, encode_block(loaded, registry, block)));
      EXPECT_EQ(hash_of(again), hash_of(loaded));
    }
  }
  EXPECT_GT(accepted, 100u);
  EXPECT_GT(refused, 100u);
}

}  // namespace
}  // namespace psygen::world
