// Structural changes recorded while a query is iterated, and applied afterwards in the order of
// recording. Neighbouring commands of one form become one batch. Not thread-safe: a Commands
// belongs to one thread, and every thread may have its own. apply() skips entities that died in the
// meantime. Recording is amortised O(1) per entity.
#pragma once

#include <cstddef>
#include <span>
#include <tuple>
#include <type_traits>
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
    using List = CreateList<Cs...>;
    std::apply([&](auto&... rows) { (rows.push_back(std::move(values)), ...); },
               list<List>().values);
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
  bool empty() const { return batches_.empty(); }
  // Applies all changes in order and clears the list. Not while a query of this world is iterated.
  // If a component's constructor throws, the later batches stay recorded.
  void apply(World& world);

 private:
  struct DestroyList {
    std::vector<Entity> entities;
    void apply(World& world) { world.destroy(entities); }
  };
  struct FamilyList {
    std::vector<Entity> parents;
    void apply(World& world) { world.destroy_with_children(parents); }
  };
  struct ChildrenList {
    std::vector<std::pair<Entity, std::vector<Entity>>> lists;
    void apply(World& world) {
      for (const auto& [parent, children] : lists)
        world.set_children(parent, children);
    }
  };
  template <class... Cs>
  struct CreateList {
    std::tuple<std::vector<Cs>...> values;
    void apply(World& world);
  };
  template <class C>
  struct AddList {
    std::vector<Landing<C>> results;
    void apply(World& world);
  };
  template <class C>
  struct RemoveList {
    std::vector<Entity> entities;
    void apply(World& world) { world.remove<C>(entities); }
  };

  // Owns one of these lists.
  class Batch {
   public:
    template <class List>
    explicit Batch(std::type_identity<List>) : list_(new List), verbs_(&kVerbs<List>) {}
    ~Batch() {
      if (list_ != nullptr) verbs_->drop(list_);
    }
    Batch(Batch&& other) noexcept
        : list_(std::exchange(other.list_, nullptr)), verbs_(other.verbs_) {}
    Batch& operator=(Batch&& other) noexcept {
      std::swap(list_, other.list_);
      std::swap(verbs_, other.verbs_);
      return *this;
    }
    template <class List>
    List* as() {
      return verbs_ == &kVerbs<List> ? static_cast<List*>(list_) : nullptr;
    }
    void apply(World& world) { verbs_->apply(list_, world); }

   private:
    struct Verbs {
      void (*apply)(void* list, World& world);
      void (*drop)(void* list);
    };
    template <class List>
    static constexpr Verbs kVerbs{
        [](void* list, World& world) { static_cast<List*>(list)->apply(world); },
        [](void* list) { delete static_cast<List*>(list); }};

    void* list_;
    const Verbs* verbs_;
  };

  template <class List>
  List& list() {
    List* last = batches_.empty() ? nullptr : batches_.back().as<List>();
    if (last != nullptr) return *last;
    return *batches_.emplace_back(std::type_identity<List>{}).template as<List>();
  }

  std::vector<Batch> batches_;
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
