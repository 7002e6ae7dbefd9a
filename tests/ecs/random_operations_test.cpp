// Random sequences of every verb against a slow model in a std::map.
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <random>
#include <set>

#include "tests/ecs/components.hpp"

namespace psygen::ecs {
namespace {

using namespace test;

struct Row {
  std::optional<float> position;
  std::optional<std::uint64_t> mesh;
  std::optional<int> owner;  // 0 is a null pointer
  bool hidden = false;
  std::optional<std::uint32_t> edited;  // sparse
  std::optional<std::vector<Entity>> children;
};

class Machine {
 public:
  explicit Machine(std::uint32_t seed)
      : random_(seed),
        reader_(world_.reader<Mesh>(Removed::kReport)),
        edited_reader_(world_.reader<Edited>(Removed::kReport)) {}

  void step() {
    switch (pick(15)) {
      case 0:
        create();
        break;
      case 1:
        create_owners();
        break;
      case 2:
        destroy();
        break;
      case 3:
        land();
        break;
      case 4:
        add_mesh();
        break;
      case 5:
        remove_mesh();
        break;
      case 6:
        toggle_hidden();
        break;
      case 7:
        mark();
        break;
      case 8:
        write_all();
        break;
      case 9:
        add_edited();
        break;
      case 10:
        remove_edited();
        break;
      case 11:
        land_edited();
        break;
      case 12:
        create_parent();
        break;
      case 13:
        destroy_family();
        break;
      default:
        drain();
        break;
    }
  }

  void check() {
    ASSERT_EQ(world_.size(), model_.size());
    for (const auto& [key, row] : model_) {
      const Entity entity = unpack(key);
      ASSERT_TRUE(world_.alive(entity));
      const Position* position = world_.get<Position>(entity);
      ASSERT_EQ(position != nullptr, row.position.has_value());
      if (position != nullptr) {
        ASSERT_EQ(position->x, *row.position);
      }
      const Mesh* mesh = world_.get<Mesh>(entity);
      ASSERT_EQ(mesh != nullptr, row.mesh.has_value());
      if (mesh != nullptr) {
        ASSERT_EQ(mesh->id, *row.mesh);
      }
      const Owner* owner = world_.get<Owner>(entity);
      ASSERT_EQ(owner != nullptr, row.owner.has_value());
      if (owner != nullptr) {
        ASSERT_EQ(owner->value ? *owner->value : 0, *row.owner);
      }
      ASSERT_EQ(world_.get<Hidden>(entity) != nullptr, row.hidden);
      const Edited* edited = world_.get<Edited>(entity);
      ASSERT_EQ(edited != nullptr, row.edited.has_value());
      if (edited != nullptr) {
        ASSERT_EQ(edited->version, *row.edited);
      }
      ASSERT_TRUE(std::ranges::equal(world_.children(entity),
                                     row.children.value_or(std::vector<Entity>{})));
    }
    check_filters();
    check_snapshot();
    for (const Entity entity : dead_)
      ASSERT_FALSE(world_.alive(entity));
    std::size_t visited = 0;
    world_.each<>([&](std::span<const Entity> entities) {
      for (const Entity entity : entities)
        visited += model_.count(pack(entity));
    });
    ASSERT_EQ(visited, model_.size());
  }

  void check_filters() {
    std::size_t edited = 0;
    std::size_t rest = 0;
    world_.each<const Mesh>([&](auto entities, auto) { edited += entities.size(); },
                            With<Edited>{});
    world_.each<const Mesh>([&](auto entities, auto) { rest += entities.size(); },
                            Without<Edited>{});
    std::size_t expected_edited = 0;
    std::size_t expected_rest = 0;
    for (const auto& [key, row] : model_) {
      if (row.mesh) ++(row.edited ? expected_edited : expected_rest);
    }
    ASSERT_EQ(edited, expected_edited);
    ASSERT_EQ(rest, expected_rest);
  }

  void check_snapshot() {
    World twin(kTestLimits);
    twin.declare<Position, Mesh, Owner, Hidden, Edited, Children>();
    const SnapshotResult result = load_snapshot(save_snapshot(world_), twin);
    ASSERT_TRUE(result) << result.sentence;
    ASSERT_EQ(state_hash(twin), state_hash(world_));
  }

 private:
  static std::uint64_t pack(Entity e) { return (std::uint64_t{e.index} << 32) | e.generation; }
  static Entity unpack(std::uint64_t key) {
    return {static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)};
  }
  std::uint32_t pick(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }

  // Some living entities, some repeated, some dead.
  std::vector<Entity> some() {
    std::vector<Entity> result;
    for (const auto& [key, row] : model_) {
      if (pick(8) == 0) result.push_back(unpack(key));
    }
    if (!result.empty()) result.push_back(result[pick(static_cast<std::uint32_t>(result.size()))]);
    if (!dead_.empty()) result.push_back(dead_[pick(static_cast<std::uint32_t>(dead_.size()))]);
    std::ranges::shuffle(result, random_);
    return result;
  }

  void create() {
    const auto created = world_.create<Mesh, Position>(pick(20));
    for (std::size_t i = 0; i < created.entities.size(); ++i) {
      Row& row = model_[pack(created.entities[i])];
      row.position = created.column<Position>()[i].x = static_cast<float>(pick(1000));
      row.mesh = created.column<Mesh>()[i].id = pick(1000);
      changed_.insert(pack(created.entities[i]));
    }
  }
  void create_owners() {
    const auto created = world_.create<Owner>(pick(10));
    for (std::size_t i = 0; i < created.entities.size(); ++i) {
      const int value = static_cast<int>(pick(1000)) + 1;
      created.column<Owner>()[i].value = std::make_unique<int>(value);
      model_[pack(created.entities[i])].owner = value;
    }
  }
  void destroy() {
    const auto entities = some();
    std::size_t expected = 0;
    for (const Entity entity : entities) {
      const auto found = model_.find(pack(entity));
      if (found == model_.end()) continue;
      forget(entity);
      ++expected;
    }
    ASSERT_EQ(world_.destroy(entities), expected);
  }
  void forget(Entity entity) {
    const auto found = model_.find(pack(entity));
    if (found->second.mesh) removed_.insert(pack(entity));
    if (found->second.edited) edited_removed_.insert(pack(entity));
    model_.erase(found);
    changed_.erase(pack(entity));
    edited_changed_.erase(pack(entity));
    dead_.push_back(entity);
  }
  void create_parent() {
    const Entity parent = world_.create<Children>(1).entities[0];
    std::vector<Entity> children = some();
    if (pick(3) == 0) children.push_back(parent);  // a cycle
    ASSERT_TRUE(world_.set_children(parent, children));
    model_[pack(parent)].children = children;
  }
  void destroy_family() {
    std::vector<Entity> parents;
    for (const auto& [key, row] : model_) {
      if (row.children && pick(2) == 0) parents.push_back(unpack(key));
    }
    std::size_t expected = 0;
    std::vector<Entity> todo = parents;
    while (!todo.empty()) {
      const Entity entity = todo.back();
      todo.pop_back();
      const auto found = model_.find(pack(entity));
      if (found == model_.end()) continue;
      const auto children = found->second.children.value_or(std::vector<Entity>{});
      todo.insert(todo.end(), children.begin(), children.end());
      forget(entity);
      ++expected;
    }
    ASSERT_EQ(world_.destroy_with_children(parents), expected);
  }
  void add_edited() {
    const auto entities = some();
    std::size_t expected = 0;
    for (const Entity entity : entities) {
      const auto found = model_.find(pack(entity));
      if (found == model_.end() || found->second.edited) continue;
      found->second.edited = 1;
      edited_changed_.insert(pack(entity));
      ++expected;
    }
    ASSERT_EQ(world_.add<Edited>(entities), expected);
  }
  void remove_edited() {
    const auto entities = some();
    std::size_t expected = 0;
    for (const Entity entity : entities) {
      const auto found = model_.find(pack(entity));
      if (found == model_.end() || !found->second.edited) continue;
      found->second.edited.reset();
      edited_changed_.erase(pack(entity));
      edited_removed_.insert(pack(entity));
      ++expected;
    }
    ASSERT_EQ(world_.remove<Edited>(entities), expected);
  }
  void land_edited() {
    std::vector<Landing<Edited>> results;
    WriteReport expected;
    for (const Entity entity : some()) {
      results.push_back({entity, {pick(1000)}});
      const auto found = model_.find(pack(entity));
      const bool lands = found != model_.end() && found->second.edited;
      ++(lands ? expected.landed : expected.stale);
      if (!lands) continue;
      found->second.edited = results.back().value.version;
      edited_changed_.insert(pack(entity));
    }
    ASSERT_EQ(world_.land<Edited>(results), expected);
  }
  void land() {
    std::vector<Landing<Mesh>> results;
    WriteReport expected;
    for (const Entity entity : some()) {
      results.push_back({entity, {pick(1000)}});
      const auto found = model_.find(pack(entity));
      if (found == model_.end() || !found->second.mesh) {
        ++expected.stale;
      } else {
        ++expected.landed;
        found->second.mesh = results.back().value.id;
        changed_.insert(pack(entity));
      }
    }
    ASSERT_EQ(world_.land<Mesh>(results), expected);
  }
  void add_mesh() {
    const auto entities = some();
    std::size_t expected = 0;
    for (const Entity entity : entities) {
      const auto found = model_.find(pack(entity));
      if (found == model_.end() || found->second.mesh) continue;
      found->second.mesh = 0;
      changed_.insert(pack(entity));
      ++expected;
    }
    ASSERT_EQ(world_.add<Mesh>(entities), expected);
  }
  void remove_mesh() {
    const auto entities = some();
    std::size_t expected = 0;
    for (const Entity entity : entities) {
      const auto found = model_.find(pack(entity));
      if (found == model_.end() || !found->second.mesh) continue;
      found->second.mesh.reset();
      changed_.erase(pack(entity));
      removed_.insert(pack(entity));
      ++expected;
    }
    ASSERT_EQ(world_.remove<Mesh>(entities), expected);
  }
  void toggle_hidden() {
    Commands commands;
    for (const Entity entity : some()) {
      const auto found = model_.find(pack(entity));
      if (found == model_.end()) continue;
      if (found->second.hidden) {
        commands.remove<Hidden>(entity);
      } else {
        commands.add<Hidden>(entity);
      }
      found->second.hidden = !found->second.hidden;
    }
    commands.apply(world_);
  }
  void mark() {
    const auto entities = some();
    world_.mark_changed<Mesh>(entities);
    for (const Entity entity : entities) {
      const auto found = model_.find(pack(entity));
      if (found != model_.end() && found->second.mesh) changed_.insert(pack(entity));
    }
  }
  void write_all() {
    world_.each<Position>([&](std::span<const Entity> entities, std::span<Position> positions) {
      for (std::size_t i = 0; i < entities.size(); ++i) {
        positions[i].x += 1;
        *model_[pack(entities[i])].position += 1;
      }
    });
  }
  void drain() {
    std::set<std::uint64_t> changed;
    reader_.drain([&](std::span<const Entity> entities, std::span<const Mesh> meshes) {
      for (std::size_t i = 0; i < entities.size(); ++i) {
        changed.insert(pack(entities[i]));
        EXPECT_EQ(meshes[i].id, *model_[pack(entities[i])].mesh);
      }
    });
    ASSERT_EQ(changed, changed_);
    changed_.clear();
    std::set<std::uint64_t> removed;
    reader_.drain_removed([&](std::span<const Entity> gone) {
      for (const Entity entity : gone)
        removed.insert(pack(entity));
    });
    ASSERT_EQ(removed, removed_);
    removed_.clear();
    drain_edited();
  }
  void drain_edited() {
    std::set<std::uint64_t> changed;
    edited_reader_.drain([&](std::span<const Entity> entities, std::span<const Edited>) {
      for (const Entity entity : entities)
        changed.insert(pack(entity));
    });
    ASSERT_EQ(changed, edited_changed_);
    edited_changed_.clear();
    std::set<std::uint64_t> removed;
    edited_reader_.drain_removed([&](std::span<const Entity> gone) {
      for (const Entity entity : gone)
        removed.insert(pack(entity));
    });
    ASSERT_EQ(removed, edited_removed_);
    edited_removed_.clear();
  }

  std::mt19937 random_;
  World world_{kTestLimits};
  ChangeReader<Mesh> reader_;
  ChangeReader<Edited> edited_reader_;
  std::map<std::uint64_t, Row> model_;
  std::set<std::uint64_t> changed_;
  std::set<std::uint64_t> removed_;
  std::set<std::uint64_t> edited_changed_;
  std::set<std::uint64_t> edited_removed_;
  std::vector<Entity> dead_;
};

TEST(RandomOperations, ThousandsOfRandomVerbsAgreeWithAMap) {
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    Machine machine(seed);
    for (int step = 0; step < 1500; ++step) {
      machine.step();
      if (step % 25 == 0) machine.check();
      if (testing::Test::HasFatalFailure()) return;
    }
    machine.check();
  }
}

}  // namespace
}  // namespace psygen::ecs
