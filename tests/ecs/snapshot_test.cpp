// Snapshots of worlds, and rejection of bytes that are no snapshot.
#include "ecs/snapshot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <set>
#include <vector>

#include "ecs/snapshot_format.hpp"
#include "tests/ecs/described.hpp"

namespace psygen::ecs::test {
namespace {

void declare_all(World& world) {
  world.declare<Creature, Position, Mesh, Hidden, Selected, Edited, Children>();
}

// Uses every feature, with at least 8 creatures: several archetypes, dead entities, children,
// sparse components, transient values.
void fill(World& world, std::size_t count = 20) {
  const std::vector<Entity> creatures = copy(world.create<Creature, Position>(count).entities);
  const std::vector<Entity> hidden = copy(world.create<Creature, Hidden>(3).entities);
  for (std::size_t i = 0; i < creatures.size(); ++i) {
    Creature& c = *world.get<Creature>(creatures[i]);
    c.name = "creature " + std::to_string(i);
    c.place = {static_cast<float>(i), 2, 3};
    c.path.resize(i % 3, Vec{1, 2, 3});
    c.titles = {"sir", std::string(i % 5, 'x')};
    c.friend_of = hidden[i % 3];
    c.mood = i % 2 == 0 ? Mood::kCross : Mood::kCalm;
    world.get<Position>(creatures[i])->x = 9;
  }
  const Entity parent = world.create<Children>(1).entities[0];
  world.set_children(parent, creatures);
  world.destroy(std::span(creatures).subspan(2, 5));
  world.add<Selected>(std::span(creatures).first(count / 2));
  world.add<Edited>(hidden);
  world.get<Edited>(hidden[1])->version = 42;
}

SnapshotStatus status_of(std::span<const std::byte> bytes) {
  World world(kTestLimits);
  declare_all(world);
  const SnapshotResult result = load_snapshot(bytes, world);
  EXPECT_EQ(result.sentence.empty(), bool(result));
  if (!result) {
    EXPECT_EQ(world.size(), 0U);
  }
  return result.status;
}

void repair(std::vector<std::byte>& bytes) {
  const std::uint64_t sum = detail::checksum(std::span(bytes).first(bytes.size() - sizeof(sum)));
  std::memcpy(bytes.data() + bytes.size() - sizeof(sum), &sum, sizeof(sum));
}

TEST(Snapshot, AWorldIsRestoredExactly) {
  World before;
  fill(before);
  const std::vector<std::byte> bytes = save_snapshot(before);
  World after;
  declare_all(after);
  const SnapshotResult result = load_snapshot(bytes, after);
  ASSERT_TRUE(result) << result.sentence;

  EXPECT_EQ(after.size(), before.size());
  std::size_t compared = 0;
  before.each<const Creature>([&](std::span<const Entity> entities, auto creatures) {
    for (std::size_t i = 0; i < entities.size(); ++i) {
      const Creature* other = after.get<Creature>(entities[i]);
      ASSERT_NE(other, nullptr);
      EXPECT_EQ(*other, creatures[i]);
      EXPECT_EQ(after.get<Selected>(entities[i]) != nullptr,
                before.get<Selected>(entities[i]) != nullptr);
      ++compared;
    }
  });
  EXPECT_EQ(compared, 18U);
  before.each<const Children>([&](std::span<const Entity> entities, auto) {
    EXPECT_EQ(copy(after.children(entities[0])), copy(before.children(entities[0])));
    EXPECT_EQ(after.children(entities[0]).size(), 20U);
  });
  before.each<const Edited>([&](std::span<const Entity> entities, auto edited) {
    EXPECT_EQ(after.get<Edited>(entities[1])->version, edited[1].version);
  });
  EXPECT_EQ(save_snapshot(after), bytes);
  EXPECT_EQ(state_hash(after), state_hash(before));
}

TEST(Snapshot, BothWorldsContinueAlike) {
  World before;
  fill(before);
  World after;
  declare_all(after);
  ASSERT_TRUE(load_snapshot(save_snapshot(before), after));
  for (World* world : {&before, &after})
    world->destroy(copy(world->create<Creature>(7).entities));
  EXPECT_EQ(copy(before.create<Mesh>(9).entities), copy(after.create<Mesh>(9).entities));
  EXPECT_EQ(state_hash(after), state_hash(before));
}

TEST(Snapshot, StaleHandlesStayStaleAndRetiredSlotsRetired) {
  World before(WorldLimits{.first_generation = UINT32_MAX});
  const std::vector<Entity> dead = copy(before.create<Mesh>(3).entities);
  before.destroy(dead);
  before.create<Mesh>(1);
  World after;
  declare_all(after);
  ASSERT_TRUE(load_snapshot(save_snapshot(before), after));
  EXPECT_EQ(after.retired_slots(), 3U);
  EXPECT_FALSE(after.alive(dead[0]));
  EXPECT_EQ(after.size(), 1U);
}

TEST(Snapshot, TransientComponentsAreRestoredWithoutTheirValues) {
  World before;
  const Entity e = before.create<Position>(1).entities[0];
  before.get<Position>(e)->x = 5;
  World after;
  declare_all(after);
  ASSERT_TRUE(load_snapshot(save_snapshot(before), after));
  ASSERT_NE(after.get<Position>(e), nullptr);
  EXPECT_EQ(after.get<Position>(e)->x, 0);
}

TEST(Snapshot, AnEmptyWorldHasASnapshot) {
  EXPECT_EQ(status_of(save_snapshot(World())), SnapshotStatus::kLoaded);
}

TEST(Snapshot, TheOrderOfRegistrationDoesNotMatter) {
  World a;
  World b;
  a.declare<Mesh, Creature, Hidden>();
  b.declare<Hidden, Position, Creature>();
  for (World* world : {&a, &b})
    world->create<Creature, Hidden, Mesh>(5);
  EXPECT_EQ(save_snapshot(a), save_snapshot(b));
}

TEST(Snapshot, LoadedRowsAreNewToAReader) {
  World before;
  fill(before);
  World after;
  declare_all(after);
  auto reader = after.reader<Creature>();
  ASSERT_TRUE(load_snapshot(save_snapshot(before), after));
  EXPECT_EQ(reader.drain([](auto, auto) {}), 18U);
}

TEST(Snapshot, AUsedWorldAndAnUnknownComponentAreRejectedByName) {
  World before;
  fill(before);
  const std::vector<std::byte> bytes = save_snapshot(before);
  EXPECT_EQ(load_snapshot(bytes, before).status, SnapshotStatus::kWorldInUse);
  World stranger;
  stranger.declare<Position>();
  const SnapshotResult result = load_snapshot(bytes, stranger);
  EXPECT_EQ(result.status, SnapshotStatus::kUnknownComponent);
  EXPECT_NE(result.sentence.find("'; call World::declare<…>() with its type before loading"),
            std::string::npos)
      << result.sentence;
}

TEST(Snapshot, MoreThanTheLimitsOfTheWorldIsRejected) {
  World before;
  fill(before, 5000);
  const std::vector<std::byte> bytes = save_snapshot(before);
  World few_entities(WorldLimits{.max_entities = 100});
  declare_all(few_entities);
  EXPECT_EQ(load_snapshot(bytes, few_entities).status, SnapshotStatus::kTooLarge);
  World few_rows(WorldLimits{.max_rows_per_table = 4096});
  declare_all(few_rows);
  EXPECT_EQ(load_snapshot(bytes, few_rows).status, SnapshotStatus::kTooLarge);
  World few_kinds(WorldLimits{.max_tables = 2});
  declare_all(few_kinds);
  EXPECT_EQ(load_snapshot(bytes, few_kinds).status, SnapshotStatus::kTooLarge);
}

TEST(Snapshot, MoreMembersOfASparseComponentThanAllowedRowsAreRejected) {
  World before;
  for (const std::vector<Entity>& some :
       {copy(before.create<Position>(3000).entities), copy(before.create<Mesh>(3000).entities)})
    before.add<Selected>(some);
  World after(WorldLimits{.max_rows_per_table = 4096});
  declare_all(after);
  EXPECT_EQ(load_snapshot(save_snapshot(before), after).status, SnapshotStatus::kTooLarge);
}

TEST(Snapshot, AFreeSlotIsNoEntity) {
  World before;
  before.destroy(copy(before.create<Position>(3).entities));
  World after;
  declare_all(after);
  ASSERT_TRUE(load_snapshot(save_snapshot(before), after));
  EXPECT_EQ(after.get<Position>(Entity{0, 2}), nullptr);
  EXPECT_EQ(after.size(), 0U);
}

TEST(Snapshot, AfterAThrowingConstructorTheWorldIsEmptyAndCanBeLoaded) {
  World before;
  const std::vector<Entity> all = copy(before.create<Creature, Throwing>(5).entities);
  before.add<Selected>(all);
  const std::vector<std::byte> bytes = save_snapshot(before);
  World after;
  declare_all(after);
  after.declare<Throwing>();
  Throwing::fuse = 2;
  EXPECT_THROW((void)load_snapshot(bytes, after), std::runtime_error);
  Throwing::fuse = -1;
  EXPECT_EQ(after.size(), 0U);
  EXPECT_EQ(after.count<Creature>(), 0U);
  EXPECT_TRUE(load_snapshot(bytes, after));
  EXPECT_EQ(state_hash(after), state_hash(before));
}

// ---- forged by hand: content that no Saver writes, with a matching checksum --------------------

class Forger {
 public:
  Forger() {
    bytes(detail::kSnapshotMagic);
    number<std::uint32_t>(detail::kSnapshotVersion);
    number<std::uint64_t>(0);
  }
  template <class T>
  Forger& number(T value) {
    const auto* from = reinterpret_cast<const std::byte*>(&value);
    out_.insert(out_.end(), from, from + sizeof(T));
    return *this;
  }
  Forger& name(std::string_view text) {
    number<std::uint32_t>(static_cast<std::uint32_t>(text.size()));
    return bytes(text);
  }
  Forger& bytes(std::string_view text) {
    for (const char c : text)
      out_.push_back(static_cast<std::byte>(c));
    return *this;
  }
  std::vector<std::byte> done() {
    const std::uint64_t length = out_.size() - detail::kSnapshotHeaderBytes;
    std::memcpy(out_.data() + 12, &length, sizeof(length));
    number<std::uint64_t>(0);
    repair(out_);
    return out_;
  }

 private:
  std::vector<std::byte> out_;
};

constexpr std::uint8_t kStructKind = 6, kListKind = 8, kSparseNo = 0, kDescribed = 1;

// The component "creature" with the one field "path", whose elements have the fields that follow.
Forger creature_with_path(std::uint32_t fields_of_element) {
  Forger f;
  f.number<std::uint32_t>(1).name("creature").number(kSparseNo).number(kDescribed);
  f.number(kStructKind).number<std::uint32_t>(1).name("path").number(kListKind);
  f.number(kStructKind).number<std::uint32_t>(fields_of_element);
  return f;
}

TEST(ForgedSnapshot, ListsOfEmptyElementsAreRejected) {
  EXPECT_EQ(status_of(creature_with_path(0).done()), SnapshotStatus::kCorrupt);
}

// A crate's list whose elements take one byte in the snapshot and half a kilobyte in the program.
TEST(ForgedSnapshot, ListsThatWouldTakeFarMoreMemoryThanBytesAreRejected) {
  const auto status_with = [](std::uint32_t length) {
    Forger f;
    f.number<std::uint32_t>(1).name("crate").number(kSparseNo).number(kDescribed);
    f.number(kStructKind).number<std::uint32_t>(1).name("items").number(kListKind);
    f.number(kStructKind).number<std::uint32_t>(1);
    f.name("lost").number<std::uint8_t>(0).number<std::uint32_t>(1);               // a bool
    f.number<std::uint32_t>(1).number<std::uint32_t>(1).number<std::uint32_t>(0);  // slots
    f.number<std::uint32_t>(1).number<std::uint32_t>(1).number<std::uint32_t>(0);  // a table
    f.number<std::uint32_t>(1).number<std::uint32_t>(0).number<std::uint32_t>(1);  // its handle
    f.number<std::uint32_t>(length).bytes(std::string(length, '\0'));
    f.number<std::uint32_t>(0);  // no sparse components
    World world;
    world.declare<Crate>();
    const SnapshotStatus status = load_snapshot(f.done(), world).status;
    EXPECT_EQ(world.size(), status == SnapshotStatus::kLoaded ? 1U : 0U);
    return status;
  };
  EXPECT_EQ(status_with(10), SnapshotStatus::kLoaded);
  EXPECT_EQ(status_with(20'000), SnapshotStatus::kTooLarge);
}

TEST(ForgedSnapshot, ListsLongerThanTheDataAreRejected) {
  Forger f = creature_with_path(1);
  constexpr std::uint32_t kRows = 2000;
  f.name("lost").number<std::uint8_t>(0).number<std::uint32_t>(1);  // a bool of one byte
  f.number<std::uint32_t>(kRows);
  for (std::uint32_t i = 0; i < kRows; ++i)
    f.number<std::uint32_t>(1);                                                  // generations
  f.number<std::uint32_t>(0);                                                    // free
  f.number<std::uint32_t>(1).number<std::uint32_t>(1).number<std::uint32_t>(0);  // a table
  f.number<std::uint32_t>(kRows);
  for (std::uint32_t i = 0; i < kRows; ++i)
    f.number<std::uint32_t>(i).number<std::uint32_t>(1);
  // Every list claims as many elements as bytes are left: the first lists are too long.
  for (std::uint32_t i = 0; i < kRows; ++i)
    f.number<std::uint32_t>(0xFFFF);
  EXPECT_EQ(status_of(f.done()), SnapshotStatus::kCorrupt);
}

TEST(ForgedSnapshot, EmptyTablesEndlessNamesAndDeepTypesAreRejected) {
  Forger empty;
  empty.number<std::uint32_t>(0).number<std::uint32_t>(0).number<std::uint32_t>(0);
  empty.number<std::uint32_t>(1).number<std::uint32_t>(0).number<std::uint32_t>(0);
  empty.number<std::uint32_t>(0);
  EXPECT_EQ(status_of(empty.done()), SnapshotStatus::kCorrupt);
  Forger named;
  named.number<std::uint32_t>(1).name(std::string(5000, 'x')).number<std::uint64_t>(0);
  EXPECT_EQ(status_of(named.done()), SnapshotStatus::kCorrupt);
  Forger deep;
  deep.number<std::uint32_t>(1).name("creature").number(kSparseNo).number(kDescribed);
  deep.number(kStructKind).number<std::uint32_t>(1).name("unknown");
  for (int i = 0; i < 100; ++i)
    deep.number(kListKind);
  EXPECT_EQ(status_of(deep.done()), SnapshotStatus::kCorrupt);
}

TEST(Snapshot, IsRejectedWhenTruncatedAtAnyLength) {
  World before;
  fill(before);
  const std::vector<std::byte> bytes = save_snapshot(before);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const SnapshotStatus status = status_of(std::span(bytes).first(length));
    ASSERT_TRUE(status == SnapshotStatus::kTruncated || status == SnapshotStatus::kNotASnapshot)
        << length;
  }
}

TEST(Snapshot, IsRejectedWithAnyByteFlipped) {
  World before;
  fill(before, 8);
  std::vector<std::byte> bytes = save_snapshot(before);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const auto flip : {std::byte{0x01}, std::byte{0x80}, std::byte{0xFF}}) {
      bytes[i] ^= flip;
      ASSERT_NE(status_of(bytes), SnapshotStatus::kLoaded) << i;
      bytes[i] ^= flip;
    }
  }
  EXPECT_EQ(status_of(bytes), SnapshotStatus::kLoaded);
}

TEST(Snapshot, BytesAfterTheEndAreRejected) {
  World before;
  fill(before);
  std::vector<std::byte> bytes = save_snapshot(before);
  bytes.push_back({});
  EXPECT_EQ(status_of(bytes), SnapshotStatus::kCorrupt);
}

// A forger of a snapshot can forge its checksum too; a load then gives at least a sound world.
TEST(Snapshot, WithAnyByteForgedIsRejectedOrASoundWorld) {
  World before;
  fill(before, 8);
  const std::vector<std::byte> good = save_snapshot(before);
  std::mt19937 random(1);
  std::size_t loaded = 0;
  for (std::size_t i = 0; i < good.size() * 3; ++i) {
    std::vector<std::byte> bytes = good;
    const std::size_t at = i % (good.size() - detail::kSnapshotChecksumBytes);
    bytes[at] = static_cast<std::byte>(i < good.size() ? 0xFF : random());
    if (i >= 2 * good.size()) bytes[random() % (bytes.size() - 8)] = std::byte(random());
    repair(bytes);
    World world(kTestLimits);
    declare_all(world);
    if (!load_snapshot(bytes, world)) continue;
    ++loaded;
    std::vector<std::byte> again = save_snapshot(world);
    World twin(kTestLimits);
    declare_all(twin);
    ASSERT_TRUE(load_snapshot(again, twin)) << i;
    ASSERT_EQ(save_snapshot(twin), again) << i;
    world.destroy(copy(world.create<Creature, Hidden>(100).entities));
  }
  EXPECT_GT(loaded, good.size() / 10);  // most bytes are values
  EXPECT_LT(loaded, good.size() * 3);
}

// ---- types that change between versions of a program -----------------------------------------

struct OldCar {
  int wheels = 4;
  float speed = 1;
  std::vector<Vec> tracks;
};
struct NewCar {
  std::string plate = "none";
  int wheels = 6;
};
struct OtherCar {
  double wheels = 4;
};

}  // namespace
}  // namespace psygen::ecs::test

template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::OldCar> {
  using C = psygen::ecs::test::OldCar;
  static constexpr std::string_view name = "car";
  static constexpr auto fields = std::tuple{field("wheels", &C::wheels), field("speed", &C::speed),
                                            field("tracks", &C::tracks)};
};
template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::NewCar> {
  using C = psygen::ecs::test::NewCar;
  static constexpr std::string_view name = "car";
  static constexpr auto fields = std::tuple{field("plate", &C::plate), field("wheels", &C::wheels)};
};
template <>
struct psygen::ecs::ComponentTraits<psygen::ecs::test::OtherCar> {
  using C = psygen::ecs::test::OtherCar;
  static constexpr std::string_view name = "car";
  static constexpr auto fields = std::tuple{field("wheels", &C::wheels)};
};

namespace psygen::ecs::test {
namespace {

TEST(SnapshotOfAnOlderProgram, SkipsRemovedFieldsAndNewOnesKeepTheirDefault) {
  World before;
  const auto cars = before.create<OldCar>(3);
  cars.column<OldCar>()[1] = {3, 99, {Vec{}, Vec{}}};
  const Entity car = cars.entities[1];
  World after;
  after.declare<NewCar>();
  const SnapshotResult result = load_snapshot(save_snapshot(before), after);
  ASSERT_TRUE(result) << result.sentence;
  EXPECT_EQ(after.get<NewCar>(car)->wheels, 3);
  EXPECT_EQ(after.get<NewCar>(car)->plate, "none");
}

TEST(SnapshotOfAnOlderProgram, AFieldOfAnotherTypeIsRejectedByName) {
  World before;
  before.create<OldCar>(1);
  World after;
  after.declare<OtherCar>();
  const SnapshotResult result = load_snapshot(save_snapshot(before), after);
  EXPECT_EQ(result.status, SnapshotStatus::kTypeMismatch);
  EXPECT_NE(result.sentence.find("car.wheels"), std::string::npos) << result.sentence;
}

TEST(SnapshotOfAnOlderProgram, ANewerVersionIsRejected) {
  std::vector<std::byte> bytes = save_snapshot(World());
  bytes[8] = std::byte{2};
  repair(bytes);
  EXPECT_EQ(status_of(bytes), SnapshotStatus::kNewerVersion);
}

// ---- parts of worlds ----------------------------------------------------------------------------

// A world with these creatures among others.
void fill_with_others(World& world) {
  declare_all(world);
  world.create<Position, Mesh>(50);
  fill(world);
  world.create<Position, Mesh>(7);
}

std::set<std::string> names_in(const World& world) {
  std::set<std::string> names;
  world.each<const Creature>([&](auto, std::span<const Creature> all) {
    for (const Creature& creature : all)
      names.insert(creature.name + std::to_string(creature.titles.size()));
  });
  return names;
}

TEST(PartOfAWorld, HasOnlyTheEntitiesWithTheComponent) {
  World world;
  fill_with_others(world);
  const std::vector<std::byte> bytes = save_snapshot_of<Creature>(world);
  World loaded;
  declare_all(loaded);
  ASSERT_TRUE(load_snapshot(bytes, loaded));
  EXPECT_EQ(loaded.size(), world.count<Creature>());
  EXPECT_EQ(loaded.count<Mesh>(), 0U);
  EXPECT_EQ(names_in(loaded), names_in(world));
  EXPECT_EQ(loaded.count<Selected>(), world.count<Selected>());
}

TEST(PartOfAWorld, WithoutEntitiesIsEmpty) {
  World world;
  world.create<Position>(3);
  const std::vector<std::byte> bytes = save_snapshot_of<Creature>(world);
  World loaded;
  ASSERT_TRUE(load_snapshot(bytes, loaded));
  EXPECT_EQ(loaded.size(), 0U);
}

TEST(PartOfAWorld, IsAppendedToOtherEntitiesAndItsHandlesFollow) {
  World world;
  fill_with_others(world);
  const std::vector<std::byte> bytes = save_snapshot_of<Creature>(world);
  World other;
  declare_all(other);
  other.create<Creature, Position>(4);
  other.create<Position>(9);
  const Entity edited = other.create<Creature, Hidden>(1).entities[0];
  other.add<Edited>(std::span(&edited, 1));
  std::vector<Entity> appended;
  ASSERT_TRUE(append_snapshot(bytes, other, &appended));
  EXPECT_EQ(appended.size(), world.count<Creature>());
  EXPECT_EQ(other.size(), 14 + appended.size());
  EXPECT_EQ(other.get<Edited>(edited)->version, Edited{}.version);
  std::size_t friends = 0, versions = 0;
  for (const Entity entity : appended) {
    const Creature* creature = other.get<Creature>(entity);
    ASSERT_NE(creature, nullptr);
    if (const Edited* e = other.get<Edited>(entity)) versions += e->version == 42 ? 1 : 0;
    if (creature->friend_of == kNullEntity) continue;
    ++friends;
    EXPECT_TRUE(std::ranges::find(appended, creature->friend_of) != appended.end());
    EXPECT_NE(other.get<Hidden>(creature->friend_of), nullptr);
  }
  EXPECT_EQ(friends, world.count<Creature>() - 3);
  EXPECT_EQ(versions, 1U);
}

TEST(PartOfAWorld, ChildrenFollowTheirParentsAndUnsavedOnesAreDropped) {
  World world;
  declare_all(world);
  const Entity parent = world.create<Children, Position>(1).entities[0];
  const Entity child = world.create<Position>(1).entities[0];
  const Entity stranger = world.create<Mesh>(1).entities[0];
  world.set_children(parent, std::array{stranger, child});
  const std::vector<std::byte> bytes = save_snapshot_of<Position>(world);
  World other;
  declare_all(other);
  other.create<Mesh>(5);
  std::vector<Entity> appended;
  ASSERT_TRUE(append_snapshot(bytes, other, &appended));
  std::size_t parents = 0;
  for (const Entity entity : appended) {
    if (other.get<Children>(entity) == nullptr) continue;
    ++parents;
    ASSERT_EQ(other.children(entity).size(), 1U);
    EXPECT_NE(other.get<Position>(other.children(entity)[0]), nullptr);
  }
  EXPECT_EQ(parents, 1U);
}

TEST(PartOfAWorld, AWholeSnapshotCanBeAppendedAgainAndAgain) {
  World world;
  declare_all(world);
  fill(world);
  const std::vector<std::byte> bytes = save_snapshot(world);
  const std::size_t once = world.size();
  for (std::size_t times = 2; times < 5; ++times) {
    ASSERT_TRUE(append_snapshot(bytes, world));
    EXPECT_EQ(world.size(), times * once);
  }
}

TEST(PartOfAWorld, BeyondTheLimitsIsRejectedAndTheWorldStays) {
  World small;
  declare_all(small);
  small.create<Creature, Position>(12);
  const std::vector<std::byte> bytes = save_snapshot(small);
  for (const WorldLimits& limits :
       {WorldLimits{.max_entities = 20}, WorldLimits{.max_rows_per_table = 20}}) {
    World world(limits);
    declare_all(world);
    world.create<Creature, Position>(12);
    const std::vector<std::byte> before = save_snapshot(world);
    EXPECT_EQ(append_snapshot(bytes, world).status, SnapshotStatus::kTooLarge);
    EXPECT_EQ(save_snapshot(world), before);
  }
}

TEST(PartOfAWorld, DamagedBytesLeaveTheWorldAsItWas) {
  World world;
  fill_with_others(world);
  const std::vector<std::byte> bytes = save_snapshot_of<Creature>(world);
  const std::vector<std::byte> before = save_snapshot(world);
  for (std::size_t length = 0; length < bytes.size(); length += 37) {
    EXPECT_FALSE(append_snapshot(std::span(bytes).first(length), world));
    EXPECT_EQ(save_snapshot(world), before);
  }
}

}  // namespace
}  // namespace psygen::ecs::test
