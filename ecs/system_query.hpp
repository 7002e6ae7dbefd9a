// What a system may do with the columns that it names: a window on a world, cut to these
// components. `Query<Mesh, const Placed>` writes Mesh and reads Placed, and the compiler holds the
// system to it. No structural changes: those are recorded in Commands.
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>

#include "ecs/world.hpp"

namespace psygen::ecs {

template <class... Cs>
class Query {
  static_assert(detail::kDistinct<Cs...>, "a component type occurs once in a query");
  template <class C>
  static constexpr bool kReads =
      ((std::is_same_v<std::remove_const_t<C>, std::remove_const_t<Cs>>) || ...);
  template <class C>
  static constexpr bool kWrites = (std::is_same_v<C, Cs> || ...);

 public:
  explicit Query(World& world) : world_(&world) {}

  // World::each over all of Cs, or over those that are named: query.each<const Placed>(f).
  template <class... Some, class F, class... Filters>
  void each(F&& f, Filters... filters) const {
    if constexpr (sizeof...(Some) == 0) {
      world_->each<Cs...>(f, filters...);
    } else {
      static_assert((may_use<Some>() && ...), "the query does not name this component like this");
      world_->each<Some...>(f, filters...);
    }
  }

  // World::each_of, alike.
  template <class... Some, class F>
  std::size_t each_of(std::span<const Entity> entities, F&& f) const {
    if constexpr (sizeof...(Some) == 0) {
      return world_->each_of<Cs...>(entities, f);
    } else {
      static_assert((may_use<Some>() && ...), "the query does not name this component like this");
      return world_->each_of<Some...>(entities, f);
    }
  }

  // World::accessor for C or const C, as the query says.
  template <class C>
  Accessor<C> accessor() const {
    static_assert(may_use<C>(), "the query does not name this component like this");
    return world_->accessor<C>();
  }
  // World::get; a pointer to const where the query only reads.
  template <class C>
  auto get(Entity entity) const {
    static_assert(kReads<C>, "the query does not name this component");
    using Value = std::conditional_t<kWrites<C>, C, const C>;
    return world_->accessor<Value>().get(entity);
  }
  bool alive(Entity entity) const { return world_->alive(entity); }
  std::span<const Entity> children(Entity parent) const {
    static_assert(kReads<Children>, "the query does not name Children");
    return world_->children(parent);
  }
  std::span<const Entity> children(const Children& list) const {
    static_assert(kReads<Children>, "the query does not name Children");
    return world_->children(list);
  }

  template <Component C>
  LandReport land(std::span<const Landing<C>> results) const {
    static_assert(kWrites<C>, "the query does not write this component");
    return world_->land<C>(results);
  }
  template <Component C>
  LandReport land_moved(std::span<Landing<C>> results) const {
    static_assert(kWrites<C>, "the query does not write this component");
    return world_->land_moved<C>(results);
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
