// A system's access to the components that it names: a view of a world, restricted to these
// components. `Query<Mesh, const Placed>` writes Mesh and reads Placed, and the compiler enforces
// it. No structural changes: record those in Commands. Its functions are World's, with the same
// complexity and contracts; a schedule decides which systems run at the same time.
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>

#include "ecs/world.hpp"

namespace psygen::ecs {

// A pointer to the world, passed by value. The world must outlive it.
template <class... Cs>
class Query {
  static_assert(detail::kDistinct<Cs...>, "a component type occurs once in a query");
  template <class C>
  static constexpr bool kReads =
      ((std::is_same_v<std::remove_const_t<C>, std::remove_const_t<Cs>>) || ...);
  template <class C>
  static constexpr bool kWrites = (std::is_same_v<C, Cs> || ...);

 public:
  // A view of `world`. Schedules make it from a system's parameters.
  explicit Query(World& world) : world_(&world) {}

  // World::each over all of Cs, or over the named components: query.each<const Placed>(f).
  template <class... Some, class F, class... Filters>
  void each(F&& f, Filters... filters) const {
    if constexpr (sizeof...(Some) == 0) {
      world_->each<Cs...>(f, filters...);
    } else {
      static_assert((may_use<Some>() && ...),
                    "the query does not name this component with this access");
      world_->each<Some...>(f, filters...);
    }
  }

  // World::each_of, over the same choice of components.
  template <class... Some, class F>
  std::size_t each_of(std::span<const Entity> entities, F&& f) const {
    if constexpr (sizeof...(Some) == 0) {
      return world_->each_of<Cs...>(entities, f);
    } else {
      static_assert((may_use<Some>() && ...),
                    "the query does not name this component with this access");
      return world_->each_of<Some...>(entities, f);
    }
  }

  // World::accessor for C or const C, within the query's access.
  template <class C>
  Accessor<C> accessor() const {
    static_assert(may_use<C>(), "the query does not name this component with this access");
    return world_->accessor<C>();
  }
  // World::get; a pointer to const if the query only reads C.
  template <class C>
  auto get(Entity entity) const {
    static_assert(kReads<C>, "the query does not name this component");
    using Value = std::conditional_t<kWrites<C>, C, const C>;
    return world_->accessor<Value>().get(entity);
  }
  // World::alive.
  bool alive(Entity entity) const { return world_->alive(entity); }
  // World::children, for queries that name Children.
  std::span<const Entity> children(Entity parent) const {
    static_assert(kReads<Children>, "the query does not name Children");
    return world_->children(parent);
  }
  std::span<const Entity> children(const Children& list) const {
    static_assert(kReads<Children>, "the query does not name Children");
    return world_->children(list);
  }

  // World::land, World::move_values and World::mark_changed, for components that the query writes.
  template <Component C>
  WriteReport land(std::span<const Landing<C>> results) const {
    static_assert(kWrites<C>, "the query does not write this component");
    return world_->land<C>(results);
  }
  template <Component C>
  WriteReport move_values(std::span<Landing<C>> results) const {
    static_assert(kWrites<C>, "the query does not write this component");
    return world_->move_values<C>(results);
  }
  template <Component C>
  void mark_changed(std::span<const Entity> entities) const {
    static_assert(kWrites<C>, "the query does not write this component");
    world_->mark_changed<C>(entities);
  }

 private:
  template <class C>
  static constexpr bool may_use() {
    return kWrites<C> || (std::is_const_v<C> && kReads<C>);
  }
  World* world_;
};

}  // namespace psygen::ecs
