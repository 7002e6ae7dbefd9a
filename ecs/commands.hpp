// Structural changes recorded while a query is iterated, and applied afterwards in the order of
// recording. Neighbouring commands of one form become one batch. Not thread-safe: a Commands
// belongs to one thread, and every thread may have its own. apply() skips entities that died in the
// meantime. Recording is amortised O(1) per entity.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "ecs/world.hpp"

namespace psygen::ecs {

// A list of recorded changes. The destructor drops changes that were not applied.
class Commands {
 public:
  // Starts empty. Moving transfers the recorded changes.
  Commands() = default;
  Commands(Commands&&) noexcept = default;
  Commands& operator=(Commands&&) noexcept = default;

  // Records one new entity with these components and values.
  template <Component... Cs>
  void create(Cs... values) {
    static_assert(sizeof...(Cs) > 0, "an entity in a batch needs components");
    std::apply([&](auto&... rows) { (rows.push_back(std::move(values)), ...); },
               list<CreateList<Cs...>>().values);
  }
  // Records World::destroy of these entities.
  void destroy(Entity entity) { list<DestroyList>().entities.push_back(entity); }
  void destroy(std::span<const Entity> entities) {
    auto& all = list<DestroyList>().entities;
    all.insert(all.end(), entities.begin(), entities.end());
  }
  // Records World::set_children with a copy of the list.
  void set_children(Entity parent, std::span<const Entity> children) {
    auto& all = list<ChildrenList>().lists;
    all.push_back({parent, {children.begin(), children.end()}});
  }
  // Records World::destroy_with_children.
  void destroy_with_children(Entity parent) { list<FamilyList>().parents.push_back(parent); }
  // Records that the entity gets a C with this value. The value replaces that of an existing C.
  template <Component C>
  void add(Entity entity, C value = {}) {
    list<AddList<C>>().results.push_back({entity, std::move(value)});
  }
  // Records that the entity loses its C.
  template <Component C>
  void remove(Entity entity) {
    list<RemoveList<C>>().entities.push_back(entity);
  }

  // True if nothing is recorded.
  bool empty() const { return lists_.empty(); }
  // Applies all changes in order and clears the list. Not while a query of this world is iterated.
  // If a component's constructor throws, the later lists stay recorded.
  void apply(World& world);

 private:
  // Neighbouring commands of one form. `kind` identifies the form.
  struct List {
    const void* kind = nullptr;
    virtual ~List() = default;
    virtual void apply(World& world) = 0;
  };
  struct DestroyList final : List {
    std::vector<Entity> entities;
    void apply(World& world) override { world.destroy(entities); }
  };
  struct FamilyList final : List {
    std::vector<Entity> parents;
    void apply(World& world) override { world.destroy_with_children(parents); }
  };
  struct ChildrenList final : List {
    std::vector<std::pair<Entity, std::vector<Entity>>> lists;
    void apply(World& world) override {
      for (const auto& [parent, children] : lists)
        world.set_children(parent, children);
    }
  };
  template <class... Cs>
  struct CreateList final : List {
    std::tuple<std::vector<Cs>...> values;
    void apply(World& world) override;
  };
  template <class C>
  struct AddList final : List {
    std::vector<Landing<C>> results;
    void apply(World& world) override;
  };
  template <class C>
  struct RemoveList final : List {
    std::vector<Entity> entities;
    void apply(World& world) override { world.remove<C>(entities); }
  };
  template <class L>
  static constexpr char kKind = 0;

  // The last list if it is an L, else a new one.
  template <class L>
  L& list() {
    if (lists_.empty() || lists_.back()->kind != &kKind<L>) {
      lists_.push_back(std::make_unique<L>());
      lists_.back()->kind = &kKind<L>;
    }
    return static_cast<L&>(*lists_.back());
  }

  std::vector<std::unique_ptr<List>> lists_;
};

template <class... Cs>
void Commands::CreateList<Cs...>::apply(World& world) {
  const std::size_t count = std::get<0>(values).size();
  const Created<Cs...> created = world.create<Cs...>(count);
  const auto fill = [&]<class C>(std::span<C> rows) {
    auto& from = std::get<std::vector<C>>(values);
    for (std::size_t i = 0; i < count; ++i)
      rows[i] = std::move(from[i]);
  };
  (fill(created.template column<Cs>()), ...);
}

template <class C>
void Commands::AddList<C>::apply(World& world) {
  std::vector<Entity> entities;
  entities.reserve(results.size());
  for (const Landing<C>& result : results)
    entities.push_back(result.entity);
  world.add<C>(entities);
  world.move_values<C>(results);
}

}  // namespace psygen::ecs
