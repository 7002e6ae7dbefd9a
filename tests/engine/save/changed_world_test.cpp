// Saves whose world has changed since: harmless changes, refused and accepted ones, edits that are
// kept aside, old formats, hostile identities, and versions of the game.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "engine/models/edits.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/save/adaptation.hpp"
#include "engine/save/save_file.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/save/file_faults.hpp"
#include "tests/engine/save/support.hpp"
#include "tests/engine/world/shaped_worlds.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::save {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using world::EditKind;
using world::testing::kSmallWorld;
using world::testing::parsed;
using world::testing::registry;
using world::testing::replaced;

// The instances 0 … 2 of a block are trees, 3 … 7 rocks.
constexpr const char* kFern = "\n[[scatter]]\nmodel = \"grass\"\ncount = 4\n";

// A stamp at a point of the world, in metres. Blocks have sides of 64 m.
std::string stamp_at(int x, int z) {
  return fmt::format(
      "\n[[stamp]]\nimage = \"white.png\"\ncentre_m = [{}, {}]\nsize_m = 40\nheight_m = 9\n"
      "border_m = 4\n",
      x, z);
}

class ChangedWorld : public ::testing::Test {
 protected:
  // Saves edits of the small world: in block (1, 1) a tree and a rock are removed, a rock is placed
  // and ground is raised; in block (5, 2) a tree is removed.
  void SetUp() override {
    const world::World& world = small_;
    const world::Scatter& rocks = world.scatter[1];
    ASSERT_TRUE(edits_.remove(world, {{1, 1}, 1}));
    ASSERT_TRUE(edits_.remove(world, {{1, 1}, 4}));
    ASSERT_TRUE(edits_.remove(world, {{5, 2}, 2}));
    ASSERT_TRUE(edits_.place(
        world, registry(),
        {rocks.model, world::scatter_parameters(registry(), rocks), {{1, 1}, {9, 0, 9}}, 0}));
    ASSERT_TRUE(edits_.raise(world, {{1, 1}, {30, 0, 30}}, 8, 3));
    auto save = SaveGame::open(file_, world, registry());
    ASSERT_TRUE(save) << save.error().message;
    ASSERT_TRUE(save->put_changes({}, edits_));
    ASSERT_TRUE(save->save());
  }

  core::Result<SaveGame> open(const world::World& world, Accept accept = Accept::kSameWorld) const {
    return SaveGame::open(file_, world, registry(), {.accept = accept});
  }
  // The error message without the name of the file, after checking that the file is unchanged.
  std::string refusal(const world::World& world, Accept accept = Accept::kSameWorld) const {
    const std::string before = file_content(file_);
    const auto save = open(world, accept);
    EXPECT_TRUE(file_content(file_) == before);
    if (save) return "it was opened";
    EXPECT_EQ(save.error().code, core::ErrorCode::kInvalidArgument);
    return save.error().message.substr(file_.string().size() + 2);
  }
  // The edits that a save has in a world, in short: "(1, 1) -1 -4 +1 ^1".
  static std::string list(const SaveGame& save, const world::World& world) {
    const auto edits = save.load_edits(world, registry());
    if (!edits) return edits.error().message;
    std::set<std::string> blocks;
    for (const core::BlockCoord at : world::changed_blocks({}, *edits)) {
      const models::BlockEdits& block = *edits->layer()->block(at);
      std::string text = fmt::format("({}, {})", at.x, at.z);
      for (const auto& removed : block.removed)
        text += fmt::format(" -{}", removed.index);
      if (!block.placed.empty()) text += fmt::format(" +{}", block.placed.size());
      if (!block.ground.empty()) text += fmt::format(" ^{}", block.ground.size());
      blocks.insert(text);
    }
    return fmt::format("{}", fmt::join(blocks, "; "));
  }
  static std::vector<std::string> list(const std::vector<Misfit>& misfits) {
    std::vector<std::string> texts;
    for (const Misfit& m : misfits)
      texts.push_back(fmt::format("({}, {}) {}{}: {}", m.block.x, m.block.z,
                                  m.kind ? "-+^"[static_cast<int>(*m.kind)] : '?', m.count,
                                  m.reason));
    std::ranges::sort(texts);
    return texts;
  }
  // Makes the file one of format 1, as programs before the parts wrote it.
  void make_format_1() const {
    auto database = Database::open(file_);
    ASSERT_TRUE(database);
    ASSERT_TRUE(
        database->run("DROP TABLE psygen_surfaces; DROP TABLE psygen_kept; PRAGMA user_version=1;"
                      "DELETE FROM psygen_facts WHERE name IN ('world parts', 'game version')",
                      "tamper"));
  }
  void tamper(const std::string& sql) const {
    auto database = Database::open(file_);
    ASSERT_TRUE(database);
    const auto done = database->run(sql.c_str(), "tamper");
    ASSERT_TRUE(done) << done.error().message;
  }

  static constexpr const char* kAll = "(1, 1) -1 -4 +1 ^1; (5, 2) -2";
  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "game.save";
  const world::World small_ = parsed(kSmallWorld);
  world::Edits edits_;
};

TEST_F(ChangedWorld, HarmlessChangesOpenAndTheNextSaveStoresTheNewIdentity) {
  const std::string more = std::string(kSmallWorld) + kFern;
  const std::pair<const char*, std::string> harmless[] = {
      {"one more scatter at the end", more},
      {"more instances at the end", replaced(kSmallWorld, "count = 5", "count = 6")},
      {"another range", replaced(kSmallWorld, "size_m = [1.5, 2.5]", "size_m = [1.5, 3.5]")},
      {"another name", replaced(kSmallWorld, "\"small\"", "\"large\"")},
      {"a larger world", replaced(kSmallWorld, "[8, 4]", "[80, 40]")},
      {"another sky", std::string(kSmallWorld) + "\n[sky]\nstart_hour = 17\n"},
      {"water below the edits", std::string(kSmallWorld) + "\n[water]\nlevel_m = 0.5\n"},
      {"a single model",
       std::string(kSmallWorld) + "\n[[place]]\nmodel = \"rock\"\nat_m = [100, 100]\n"}};
  const std::string first = file_content(file_);
  for (const auto& [what, text] : harmless) {
    testing::write_file(file_, first);
    const world::World world = parsed(text);
    {
      auto save = open(world);
      ASSERT_TRUE(save) << what << ": " << save.error().message;
      EXPECT_EQ(list(*save, world), kAll) << what;
      EXPECT_THAT(save->misfits(), IsEmpty()) << what;
      EXPECT_TRUE(save->has_unsaved()) << what;
      EXPECT_EQ(save->world_changes().empty(),
                what == std::string("another range") || what == std::string("another name"));
      ASSERT_TRUE(save->save());
      EXPECT_FALSE(save->has_unsaved());
    }
    EXPECT_EQ(*world_of(file_), identity_of(world, registry())) << what;
    // The same judgement without the world, for the ground as a whole.
    testing::write_file(file_, first);
    const bool needs_world = std::string_view(what).starts_with("a larger") ||
                             std::string_view(what).starts_with("water");
    const auto by_parts = SaveGame::open(file_, identity_of(world, registry()));
    EXPECT_EQ(by_parts.has_value(), !needs_world) << what;
  }
}

TEST_F(ChangedWorld, AWorldThatIsTheSameHasNothingToSave) {
  const auto save = open(small_);
  ASSERT_TRUE(save);
  EXPECT_FALSE(save->has_unsaved());
  EXPECT_THAT(save->world_changes(), IsEmpty());
}

TEST_F(ChangedWorld, GroundMattersUnderTheEditedBlocksOnly) {
  const world::World elsewhere = world::testing::shaped_world(stamp_at(224, 32));
  const auto save = open(elsewhere);
  ASSERT_TRUE(save) << save.error().message;
  ASSERT_EQ(save->world_changes().size(), 1u);
  EXPECT_EQ(save->world_changes()[0].text, "the ground differs");
  const world::World under = world::testing::shaped_world(stamp_at(96, 96));
  EXPECT_EQ(surface_hash(elsewhere, {1, 1}), surface_hash(small_, {1, 1}));
  EXPECT_NE(surface_hash(under, {1, 1}), surface_hash(small_, {1, 1}));
}

TEST_F(ChangedWorld, TheSeaChangesTheSurfaceOfBlocksThatItCovers) {
  const double relief_m = small_.terrain.real(models::kTerrainReliefM);
  int covered = 0, dry = 0;
  for (std::int32_t x = 0; x < 8; ++x) {
    const auto heights = world::ground_of_block(small_, {x, 1});
    const double lowest_m = *std::ranges::min_element(heights) / 65535.0 * relief_m;
    for (const double level_m : {lowest_m - 1, lowest_m, lowest_m + 1}) {
      world::World world = small_;
      world.water.level_m = level_m;
      const std::uint64_t without = surface_hash(small_, {x, 1});
      const bool covers = level_m > lowest_m;
      EXPECT_EQ(surface_hash(world, {x, 1}),
                covers ? core::combine(without, std::bit_cast<std::uint64_t>(level_m)) : without);
      ++(covers ? covered : dry);
    }
  }
  EXPECT_EQ(covered, 8);
  EXPECT_EQ(dry, 16);
}

TEST_F(ChangedWorld, ChangesThatTouchEditsAreNamedWithTheirPlaces) {
  EXPECT_EQ(refusal(world::testing::shaped_world(stamp_at(96, 96))),
            "the world 'small' has changed since it was saved: the ground differs under 4 edits, "
            "such as in block (1, 1). Open it with the world of that time, or accept the change: "
            "edits that no longer fit are then kept aside and listed");
  const std::string text = kSmallWorld;
  const std::string trees =
      text.substr(text.find("[[scatter]]"), text.rfind("[[scatter]]") - text.find("[[scatter]]"));
  const std::string rocks = text.substr(text.rfind("[[scatter]]"));
  const std::string head = text.substr(0, text.find("[[scatter]]"));
  EXPECT_THAT(refusal(parsed(head + rocks)),
              AllOf(HasSubstr("scatter 1 of 2 'tree' is gone under 2 edits"),
                    HasSubstr("scatter 2 of 2 'rock' has moved to other indices under 1 edit, such "
                              "as in block (1, 1)")));
  EXPECT_THAT(refusal(parsed(head + rocks + "\n" + trees)),
              HasSubstr("scatter 1 of 2 'tree' has moved to other indices under 2 edits"));
  EXPECT_THAT(refusal(parsed(replaced(kSmallWorld, "count = 3", "count = 2"))),
              AllOf(HasSubstr("'tree' has 2 instead of 3 models per block under 1 edit, such as in "
                              "block (5, 2)"),
                    HasSubstr("'rock' has moved")));
  EXPECT_THAT(refusal(parsed(replaced(kSmallWorld, "subdivisions = 1\n",
                                      "subdivisions = 1\nmax_slope_deg = 80\n"))),
              HasSubstr("scatter 2 of 2 'rock' differs under 1 edit"));
  EXPECT_THAT(refusal(parsed(text + "\n[water]\nlevel_m = 59\n")),
              HasSubstr("the water differs under 5 edits"));
  EXPECT_THAT(refusal(parsed(replaced(kSmallWorld, "[8, 4]", "[5, 4]"))),
              HasSubstr("the world has another extent under 1 edit, such as in block (5, 2)"));
  EXPECT_THAT(refusal(parsed(replaced(kSmallWorld, "cell_m = 2", "cell_m = 3"))),
              HasSubstr("the blocks have another size"));
  EXPECT_THAT(refusal(parsed(replaced(kSmallWorld, "seed = 5", "seed = 6"))),
              HasSubstr("the seed differs, so this is another world"));
}

TEST_F(ChangedWorld, AnotherSeedNeedsMoreThanAnAcceptedChange) {
  const world::World other = parsed(replaced(kSmallWorld, "seed = 5", "seed = 6"));
  EXPECT_THAT(refusal(other, Accept::kChangedWorld), HasSubstr("this is another world"));
  const auto save = open(other, Accept::kAnyWorld);
  ASSERT_TRUE(save) << save.error().message;
  EXPECT_EQ(list(*save, other), "(1, 1) +1 ^1") << "no model of this world was removed";
}

TEST_F(ChangedWorld, AcceptedChangesKeepMisfitsAsideUntilTheirWorldReturns) {
  const std::string text = kSmallWorld;
  const world::World no_trees =
      parsed(text.substr(0, text.find("[[scatter]]")) + text.substr(text.rfind("[[scatter]]")));
  const std::string before = file_content(file_);
  {
    const auto save = open(no_trees, Accept::kChangedWorld);
    ASSERT_TRUE(save) << save.error().message;
    EXPECT_EQ(list(*save, no_trees), "(1, 1) +1 ^1");
    EXPECT_THAT(list(save->misfits()),
                ElementsAre("(1, 1) -1: scatter 1 of 2 'tree' is gone",
                            "(1, 1) -1: scatter 2 of 2 'rock' has moved to other indices",
                            "(5, 2) -1: scatter 1 of 2 'tree' is gone"));
  }
  EXPECT_TRUE(file_content(file_) == before) << "only save() writes";
  {
    auto save = open(no_trees, Accept::kChangedWorld);
    ASSERT_TRUE(save);
    save->discard();
    EXPECT_EQ(list(*save, no_trees), "(1, 1) +1 ^1") << "what open() did stays";
    ASSERT_TRUE(save->save());
    EXPECT_EQ(save->kept_blocks()->size(), 2u);
  }
  {
    auto save = open(no_trees);
    ASSERT_TRUE(save) << "it is a save of this world now";
    EXPECT_THAT(save->misfits(), IsEmpty());
    world::Edits edits = *save->load_edits(no_trees, registry());
    const world::Edits loaded = edits;
    ASSERT_TRUE(edits.remove(no_trees, {{1, 1}, 0}));
    ASSERT_TRUE(edits.raise(no_trees, {{1, 1}, {20, 0, 20}}, 4, 1));
    ASSERT_TRUE(save->put_changes(loaded, edits));
    ASSERT_TRUE(save->save());
  }
  EXPECT_THAT(refusal(small_), HasSubstr("'rock' has moved to other indices under 1 edit"));
  {
    auto save = open(small_, Accept::kChangedWorld);
    ASSERT_TRUE(save);
    EXPECT_EQ(list(*save, small_), "(1, 1) -1 -4 +1 ^2; (5, 2) -2");
    ASSERT_TRUE(save->save());
    EXPECT_EQ(save->kept_blocks()->size(), 1u) << "rock 0 of the other world";
    save->forget_kept();
    ASSERT_TRUE(save->save());
    EXPECT_THAT(*save->kept_blocks(), IsEmpty());
  }
  EXPECT_EQ(list(*open(small_), small_), "(1, 1) -1 -4 +1 ^2; (5, 2) -2");
}

TEST_F(ChangedWorld, GroundAndBlocksThatNoLongerExistAreKeptAside) {
  const std::string flat =
      replaced(replaced(kSmallWorld, "relief_m = 60", "relief_m = 2"), "[8, 4]", "[5, 4]");
  const world::World world = parsed(flat);
  auto save = open(world, Accept::kChangedWorld);
  ASSERT_TRUE(save) << save.error().message;
  EXPECT_EQ(list(*save, world), "(1, 1) -1 -4 +1");
  EXPECT_THAT(list(save->misfits()),
              ElementsAre("(1, 1) ^1: raising ground by 3 m is not allowed: at most 2 m, up or "
                          "down",
                          "(5, 2) -1: the block is outside the world"));
  ASSERT_TRUE(save->save());
  save = core::fail(core::ErrorCode::kInternal, "closed");
  EXPECT_EQ(list(*open(small_, Accept::kChangedWorld), small_), kAll);
  const world::World coarse = parsed(replaced(kSmallWorld, "cell_m = 2", "cell_m = 3"));
  EXPECT_EQ(list(*open(coarse, Accept::kChangedWorld), coarse), "");
}

TEST_F(ChangedWorld, APlacedModelOfAChangedSpeciesIsTouchedAndOfAMissingOneHidden) {
  models::Registry species = models::make_standard_registry();
  const world::World world =
      *world::load_world(world::testing::game_file("worlds/five_species.toml"), species);
  const models::Species& oak = world.species[0];
  const std::filesystem::path file = folder_ / "trees.save";
  const auto type = static_cast<models::ModelIndex>(species.find(oak.name));
  world::Edits edits;
  ASSERT_TRUE(edits.place(
      world, species, {type, models::default_parameters(species[type]), {{3, 3}, {9, 0, 9}}, 0}));
  {
    auto save = SaveGame::open(file, world, species);
    ASSERT_TRUE(save && save->put_changes({}, edits) && save->save());
  }
  world::World changed = world;
  changed.species[1].branches += 1;
  EXPECT_TRUE(SaveGame::open(file, changed, species)) << "no tree of it is placed";
  changed.species[0].branches += 1;
  const auto refused = SaveGame::open(file, changed, species);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              HasSubstr("the species '" + oak.name + "' differs under 1 edit"));
  const auto name = oak.name;
  world::World without = world;
  without.species.clear();
  without.scatter.clear();
  auto save = SaveGame::open(file, without, registry(), {.accept = Accept::kChangedWorld});
  ASSERT_TRUE(save) << save.error().message;
  EXPECT_THAT(list(save->misfits()),
              ElementsAre("(3, 3) +1: there is no model type \"" + name + "\""));
  const auto loaded = save->load_edits(without, registry());
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(world::hidden_models(*loaded, registry()).size(), 1u);
}

TEST_F(ChangedWorld, ASaveOfFormat1OpensAndIsUpgradedAtTheNextSave) {
  make_format_1();
  const std::string old = file_content(file_);
  EXPECT_THAT(world_of(file_)->parts, IsEmpty());
  {
    const auto save = open(small_);
    ASSERT_TRUE(save) << save.error().message;
    EXPECT_EQ(list(*save, small_), kAll);
    EXPECT_TRUE(save->has_unsaved());
    EXPECT_THAT(*save->kept_blocks(), IsEmpty());
  }
  EXPECT_TRUE(file_content(file_) == old);
  const world::World other = parsed(replaced(kSmallWorld, "octaves = 4", "octaves = 5"));
  EXPECT_THAT(refusal(other), HasSubstr("saves of its format do not tell which parts differ"));
  EXPECT_EQ(list(*open(other, Accept::kChangedWorld), other), kAll);
  const world::World more = parsed(std::string(kSmallWorld) + kFern + kFern);
  ASSERT_TRUE(open(more)) << "it only grew at its end";
  EXPECT_EQ(open(more)->world_changes()[0].text, "scatter 3 of 4 'grass' is new");
  ASSERT_TRUE(open(small_)->save());
  EXPECT_EQ(*world_of(file_), identity_of(small_, registry()));
  EXPECT_TRUE(open(more)) << "now the parts are known";
  EXPECT_TRUE(open(world::testing::shaped_world(stamp_at(224, 32)))) << "and the surfaces";
}

TEST_F(ChangedWorld, AFullDiskDuringTheUpgradeLeavesTheOldFormat) {
  make_format_1();
  const std::string old = file_content(file_);
  bool fits = false;
  int refusals = 0;
  for (std::size_t calls = 0; !fits; ++calls) {
    testing::write_file(file_, old);
    {
      auto save = open(small_);
      ASSERT_TRUE(save) << save.error().message;
      {
        const testing::FileFaults full(testing::Fault::kFullDisk, calls);
        const auto saved = save->save();
        fits = !full.was_met();
        EXPECT_TRUE(!fits || saved);
        refusals += saved ? 0 : 1;
      }
      EXPECT_EQ(list(*save, small_), kAll);
      ASSERT_TRUE(save->save()) << "the next one has everything";
    }
    EXPECT_EQ(*world_of(file_), identity_of(small_, registry()));
  }
  EXPECT_GT(refusals, 0);
}

// Kills a process that stores an accepted change before each of its writes.
TEST_F(ChangedWorld, AKilledSaveOfAnAcceptedChangeHasTheOldOrTheNewWorld) {
  const std::string text = kSmallWorld;
  const world::World no_trees =
      parsed(text.substr(0, text.find("[[scatter]]")) + text.substr(text.rfind("[[scatter]]")));
  const std::string first = file_content(file_);
  int old_worlds = 0, new_worlds = 0;
  for (std::size_t calls = 0;; ++calls) {
    std::filesystem::remove(file_.string() + "-journal");
    testing::write_file(file_, first);
    const int status = testing::in_child([&] {
      auto save = open(no_trees, Accept::kChangedWorld);
      const testing::FileFaults kill(testing::Fault::kKillHalf, calls);
      const bool saved = save && save->save();
      save = core::fail(core::ErrorCode::kInternal, "closed");
      return saved;
    });
    if (WIFEXITED(status)) {
      EXPECT_EQ(WEXITSTATUS(status), 0);
      break;
    }
    const auto save = open(small_);
    ASSERT_TRUE(save) << save.error().message;
    ++(save->world_changes().empty() ? old_worlds : new_worlds);
    EXPECT_EQ(list(*save, small_), kAll) << "also what was kept aside";
  }
  EXPECT_GT(old_worlds, 3);
  EXPECT_GE(new_worlds, 1);
}

TEST_F(ChangedWorld, HostilePartsAreAClearError) {
  const auto parts = encode_parts(identity_of(small_, registry()).parts);
  EXPECT_EQ(*decode_parts(parts), identity_of(small_, registry()).parts);
  for (std::size_t length = 0; length < parts.size(); ++length)
    EXPECT_FALSE(decode_parts(std::span(parts).first(length))) << length;
  const std::vector<WorldPart> many(5000);
  EXPECT_EQ(decode_parts(encode_parts(many)).error().message,
            "the parts of its world cannot be read: they are 5000; at most 4096 are allowed; "
            "the file is damaged");
  EXPECT_THAT(decode_parts(encode_parts({{static_cast<PartKind>(77), "x", 1, 2}})).error().message,
              HasSubstr("its world has a part of a kind that psygen "));
  for (const char* value :
       {"zeroblob(0)", "zeroblob(300000)", "x'ffffffff0000000000000000'", "7"}) {
    tamper(fmt::format("UPDATE psygen_facts SET value = {} WHERE name = 'world parts'", value));
    const auto save = open(small_, Accept::kAnyWorld);
    ASSERT_FALSE(save);
    EXPECT_EQ(save.error().code, core::ErrorCode::kParse);
    EXPECT_THAT(save.error().message,
                HasSubstr("game.save: the parts of its world cannot be read"));
  }
}

// Sound checksums over absurd numbers.
TEST_F(ChangedWorld, AbsurdPartsOpenWithoutACrash) {
  std::vector<WorldPart> parts(4000, {PartKind::kScatter, "rock", 1, UINT32_MAX});
  parts.resize(4096, {PartKind::kSeed, "", 5, 0});
  {
    auto save = SaveGame::open(file_, WorldIdentity{"small", 9, parts}, OpenMode::kOpenExisting);
    ASSERT_FALSE(save);
  }
  const Bytes bytes = encode_parts(parts);
  std::string hex;
  for (const std::byte b : bytes)
    hex += fmt::format("{:02x}", std::to_integer<int>(b));
  tamper("UPDATE psygen_facts SET value = x'" + hex + "' WHERE name = 'world parts'");
  tamper("UPDATE psygen_facts SET value = 3 WHERE name = 'world hash'");
  EXPECT_FALSE(open(small_));
  const auto save = open(small_, Accept::kAnyWorld);
  ASSERT_TRUE(save) << save.error().message;
  EXPECT_EQ(list(*save, small_), "(1, 1) +1 ^1");
}

TEST_F(ChangedWorld, DamagedKeptEditsAreAClearError) {
  const world::World none = parsed(replaced(kSmallWorld, "count = 3", "count = 0"));
  ASSERT_TRUE(open(none, Accept::kChangedWorld)->save());
  tamper("UPDATE psygen_kept SET version = version + 1");
  const auto kept = open(none)->kept_blocks();
  ASSERT_FALSE(kept);
  EXPECT_THAT(kept.error().message, HasSubstr("the kept edits of block ("));
  EXPECT_THAT(kept.error().message, HasSubstr("do not match their checksum; the file is damaged"));
}

class Versions : public ChangedWorld {
 protected:
  core::Result<SaveGame> open_version(std::uint32_t version, Migration migrate = {}) const {
    return SaveGame::open(file_, small_, registry(), {.version = version, .migrate = migrate});
  }
};

TEST_F(Versions, AMigrationGetsTheOldVersionAndRewritesTheGamesData) {
  {
    auto save = open_version(0);
    ASSERT_TRUE(save->put_value("gold", std::int64_t{7}));
    ASSERT_TRUE(save->execute("CREATE TABLE game_chest(item TEXT)"));
    ASSERT_TRUE(save->save());
  }
  const std::string old = file_content(file_);
  int calls = 0;
  const auto migrate = [&](SaveGame& save, std::uint32_t from) -> core::Result<void> {
    ++calls;
    EXPECT_EQ(from, 0u);
    const auto gold = std::get<std::int64_t>(*save.value("gold"));
    if (auto ok = save.put_value("coins", 100 * gold); !ok) return ok;
    if (auto ok = save.put_value("gold", {}); !ok) return ok;
    return save.execute("INSERT INTO game_chest VALUES('axe')");
  };
  {
    auto save = open_version(2, migrate);
    ASSERT_TRUE(save) << save.error().message;
    ASSERT_TRUE(save->put_value("coins", std::int64_t{1}));
    ASSERT_TRUE(save->execute("DELETE FROM game_chest"));
    save->discard();
    EXPECT_EQ(*save->value("coins"), Value(std::int64_t{700})) << "the migration stays";
    EXPECT_EQ(*save->value("gold"), Value());
    EXPECT_EQ(save->query("SELECT * FROM game_chest")->rows.size(), 1u);
  }
  EXPECT_TRUE(file_content(file_) == old) << "only save() writes";
  ASSERT_TRUE(open_version(2, migrate)->save());
  EXPECT_EQ(calls, 2);
  const auto save = open_version(2, migrate);
  EXPECT_EQ(calls, 2) << "it has this version now";
  EXPECT_EQ(*save->value("coins"), Value(std::int64_t{700}));
  EXPECT_EQ(save->query("SELECT * FROM game_chest")->rows.size(), 1u);
}

TEST_F(Versions, ANewerSaveIsRejectedAndLeftAsItIs) {
  ASSERT_TRUE(open_version(3)->save());
  const std::string before = file_content(file_);
  const auto save = open_version(2, [](SaveGame&, std::uint32_t) -> core::Result<void> {
    ADD_FAILURE() << "there is nothing to migrate";
    return {};
  });
  ASSERT_FALSE(save);
  EXPECT_EQ(save.error().code, core::ErrorCode::kParse);
  EXPECT_EQ(save.error().message,
            file_.string() +
                ": a newer version of the game saved it: its data has version 3, this "
                "game reads up to 2");
  EXPECT_TRUE(file_content(file_) == before);
  EXPECT_TRUE(open_version(3));
  tamper("UPDATE psygen_facts SET value = 'x' WHERE name = 'game version'");
  EXPECT_THAT(open_version(3).error().message, HasSubstr("is not a number; the file is damaged"));
}

TEST_F(Versions, AFailedMigrationIsTheErrorAndChangesNothing) {
  const std::string before = file_content(file_);
  const auto save = open_version(1, [](SaveGame& game, std::uint32_t) -> core::Result<void> {
    if (auto ok = game.execute("CREATE TABLE game_half(x)"); !ok) return ok;
    return core::fail(core::ErrorCode::kParse, "the gold is missing");
  });
  ASSERT_FALSE(save);
  EXPECT_EQ(save.error().message, "the gold is missing");
  EXPECT_TRUE(file_content(file_) == before);
}

TEST_F(Versions, ANewSaveHasTheVersionAndNeedsNoMigration) {
  const auto fail = [](SaveGame&, std::uint32_t) -> core::Result<void> {
    return core::fail(core::ErrorCode::kInternal, "called");
  };
  for (int i = 0; i < 2; ++i) {
    const auto save =
        SaveGame::open(folder_ / "new.save", small_, registry(), {.version = 4, .migrate = fail});
    ASSERT_TRUE(save) << save.error().message;
    EXPECT_FALSE(save->has_unsaved());
  }
}

}  // namespace
}  // namespace psygen::save
