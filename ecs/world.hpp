// The world: entities, their components in tables, and verbs that work on batches. Every verb takes
// a span or a count; single look-ups are for tools and tests. A structural change (create, destroy,
// add, remove, reserve) invalidates spans and pointers into columns. It must not happen while a
// query is iterated: the program ends with a message that names the query; use Commands. Component
// constructors and destructors must not touch the world. One thread changes a world; const
// functions may run on several threads while nothing changes it. If a component's constructor
// throws, the exception passes through and no entity was created.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "ecs/accessor.hpp"
#include "ecs/change_reader.hpp"
#include "ecs/query.hpp"
#include "ecs/storage.hpp"

namespace psygen::ecs {

// Result of create: entity i owns row i of every column. Valid until the next structural change.
template <class... Cs>
struct Created {
  std::span<const Entity> entities;
  std::tuple<std::span<Cs>...> columns;

  // The column of C, one value per entity.
  template <class C>
  std::span<C> column() const {
    return std::get<std::span<C>>(columns);
  }
};

// The components that World::change_archetype adds and removes.
template <Component... Cs>
struct Add {};
template <Component... Cs>
struct Remove {};

// A value for an entity that may have died in the meantime.
template <class C>
struct Landing {
  Entity entity;
  C value;
};

// Counts of values written, and of values dropped because their entity is stale.
struct WriteReport {
  std::size_t landed = 0;
  std::size_t stale = 0;  // the entity is dead, or lacks the component
  friend bool operator==(const WriteReport&, const WriteReport&) = default;
};

namespace detail {
class SnapshotAccess;
}

// Owns its entities and components. Handles, accessors and readers belong to one world.
class World {
 public:
  // An empty world. Throws std::bad_alloc if there is no address space for `limits`.
  explicit World(const WorldLimits& limits = {}) : storage_(limits) {}

  // ---- structure -------------------------------------------------------------------------------

  // Makes `count` entities with these components, value-initialised, in contiguous rows. Tracked
  // components count as changed. O(count). Not for sparse components: add them afterwards.
  template <Component... Cs>
  Created<Cs...> create(std::size_t count);

  // Destroys these entities; skips stale handles and repetitions. Returns the number of entities
  // that died. O(handles); touches only the columns of their archetypes.
  std::size_t destroy(std::span<const Entity> entities) { return storage_.destroy(entities); }

  // Destroys these entities, their children, the children of those, and so on. Returns the number
  // of entities that died.
  std::size_t destroy_with_children(std::span<const Entity> parents);

  // add gives these entities value-initialised components, remove takes components away; all other
  // values stay. Skips dead entities, entities that have all of the components already (add), and
  // entities that have none of them (remove). Returns the number of changed entities. A sparse
  // component is added and removed by itself; other components move the entity's row. O(handles).
  template <Component... Cs>
  std::size_t add(std::span<const Entity> entities) {
    if constexpr (one_sparse<Cs...>()) {
      return storage_.add_sparse(id_of<Cs...>(), entities);
    } else {
      return storage_.change_archetype(entities, signature<Cs...>(), {});
    }
  }
  template <Component... Cs>
  std::size_t remove(std::span<const Entity> entities) {
    if constexpr (one_sparse<Cs...>()) {
      return storage_.remove_sparse(id_of<Cs...>(), entities);
    } else {
      return storage_.change_archetype(entities, {}, signature<Cs...>());
    }
  }

  // Adds and removes in one move between archetypes. Returns the number of entities that moved.
  //   world.change_archetype(entities, Add<Asleep>{}, Remove<Awake>{})
  template <Component... As, Component... Rs>
  std::size_t change_archetype(std::span<const Entity> entities, Add<As...>, Remove<Rs...>) {
    return storage_.change_archetype(entities, signature<As...>(), signature<Rs...>());
  }

  // Commits memory for `count` more entities with exactly these components.
  template <Component... Cs>
  void reserve(std::size_t count) {
    storage_.reserve(signature<Cs...>(), count);
  }

  // ---- values ----------------------------------------------------------------------------------

  // Writes each value in place and marks it changed; of several values for one entity the last
  // wins. Drops stale handles. O(results).
  template <Component C>
  WriteReport land(std::span<const Landing<C>> results) {
    return land_from<C>(results);
  }
  // Like land, but moves the values out of `results`.
  template <Component C>
  WriteReport move_values(std::span<Landing<C>> results) {
    return land_from<C>(results);
  }

  // True if the entity lives. O(1).
  bool alive(Entity entity) const { return storage_.living(entity) != nullptr; }
  // Number of living entities.
  std::size_t size() const { return storage_.slots().living(); }

  // Returns the entity's component; null if the entity is dead or lacks it. Valid until the next
  // structural change. To follow many handles, hold an accessor instead.
  template <Component C>
  C* get(Entity entity) {
    return find<C>(entity);
  }
  template <Component C>
  const C* get(Entity entity) const {
    return find<C>(entity);
  }
  // Random access to C by handle; const C only reads. Valid as long as the world.
  template <class C>
  Accessor<C> accessor() {
    return {storage_, record<std::remove_const_t<C>>()};
  }
  // From a const world. A component that the world does not know stays absent to this accessor,
  // even after it was added.
  template <class C>
  Accessor<C> accessor() const {
    static_assert(std::is_const_v<C>, "a const World is only read: ask for const C");
    return {storage_, known_record<std::remove_const_t<C>>()};
  }

  // ---- iteration -------------------------------------------------------------------------------

  // Calls f(std::span<const Entity>, std::span<Cs>...) once per non-empty table that has all of Cs
  // and passes the filters (With<...>, Without<...>). Filters by sparse components cut tables into
  // runs of rows. Write `const C` for components that are only read. With a first parameter
  // `TableRows<Cs...>`, f can mark the rows that it changed. A sparse component is either the only
  // one of Cs (its members are one run) or a filter.
  template <class... Cs, class F, class... Filters>
  void each(F&& f, Filters... filters) {
    each_in<Cs...>(storage_, f, filters...);
  }
  template <class... Cs, class F, class... Filters>
  void each(F&& f, Filters... filters) const {
    static_assert((std::is_const_v<Cs> && ...), "a const World is only read: ask for const C");
    each_in<Cs...>(storage_, f, filters...);
  }

  // Like each, for these entities in their order: calls f once per run of handles whose rows are
  // neighbours. Entities that were created together usually still are neighbours. Skips entities
  // that are dead or lack one of Cs. No sparse components. Returns the number of visited entities.
  // O(handles).
  template <class... Cs, class F>
  std::size_t each_of(std::span<const Entity> entities, F&& f) {
    return each_of_in<Cs...>(storage_, entities, f);
  }
  template <class... Cs, class F>
  std::size_t each_of(std::span<const Entity> entities, F&& f) const {
    static_assert((std::is_const_v<Cs> && ...), "a const World is only read: ask for const C");
    return each_of_in<Cs...>(storage_, entities, f);
  }

  // Number of entities that have all of these components. O(tables).
  template <Component... Cs>
  std::size_t count() const {
    std::size_t total = 0;
    each<const Cs...>(
        [&](std::span<const Entity> rows, std::span<const Cs>...) { total += rows.size(); });
    return total;
  }

  // ---- parents and children --------------------------------------------------------------------

  // Replaces the children of an entity that has the component Children; returns false if it lacks
  // it. O(children). Children may be dead or die later: their handles are then stale.
  bool set_children(Entity parent, std::span<const Entity> children);
  // Returns the children in the order of set_children; empty for entities without children. Valid
  // until the next structural change or set_children, which is not possible while a query is
  // iterated.
  std::span<const Entity> children(Entity parent) const {
    const Children* list = storage_.children_of(parent);
    return list == nullptr ? std::span<const Entity>{} : children(*list);
  }
  std::span<const Entity> children(const Children& list) const {
    return storage_.child_lists().of(list);
  }

  // ---- changes ---------------------------------------------------------------------------------

  // Marks C as changed after writes through a span or a pointer. Skips stale handles. O(handles).
  template <Component C>
  void mark_changed(std::span<const Entity> entities);
  template <Component C>
  void mark_changed(Entity entity) {
    mark_changed<C>(std::span<const Entity>(&entity, 1));
  }

  // Makes a consumer of C's changes; to it, all rows are new. A tag separates readers of the same
  // component by type, as a schedule needs. O(rows / 64).
  template <Component C, class Tag = void>
  ChangeReader<C, Tag> reader(Removed removed = Removed::kIgnore) {
    static_assert(is_tracked<C>(), "only a tracked component has changes");
    return {storage_, storage_.add_reader(storage_.id_of(detail::kComponentInfo<C>),
                                          removed == Removed::kReport)};
  }

  // Registers component types before their first use. load_snapshot requires this of every type
  // that its snapshot names.
  template <Component... Cs>
  void declare() {
    (storage_.id_of(detail::kComponentInfo<Cs>), ...);
  }

  // ---- statistics ------------------------------------------------------------------------------

  // Number of tables that the world has made, one per archetype.
  std::size_t table_count() const { return storage_.tables().size() - 1; }
  // Number of slots that have used up their generations.
  std::size_t retired_slots() const { return storage_.slots().retired(); }
  // Committed bytes of handles and columns. Pages never touched cost nothing.
  std::size_t committed_bytes() const { return storage_.committed_bytes(); }

 private:
  friend class detail::SnapshotAccess;

  template <class C>
  detail::ComponentId id_of() {
    return storage_.id_of(detail::kComponentInfo<C>);
  }
  template <class C>
  detail::ComponentRecord& record() {
    return storage_.record(id_of<C>());
  }
  template <class C>
  const detail::ComponentRecord& known_record() const {
    const detail::ComponentId id = storage_.find_id(detail::kComponentInfo<C>);
    return id == detail::kNoComponent ? storage_.absent() : storage_.record(id);
  }
  template <class... Cs>
  static constexpr bool one_sparse() {
    constexpr bool any = (is_sparse<Cs>() || ...);
    static_assert(!any || sizeof...(Cs) == 1, "a sparse component is added and removed by itself");
    return any;
  }
  template <class... Cs>
  detail::Signature signature() {
    static_assert(detail::kDistinct<Cs...>, "a component type occurs once in an archetype");
    static_assert((!is_sparse<Cs>() && ...), "a sparse component is added after create");
    detail::Signature result;
    (result.insert(storage_.id_of(detail::kComponentInfo<Cs>)), ...);
    return result;
  }
  template <class C>
  C* find(Entity entity) const;
  template <class C, class L>
  WriteReport land_from(std::span<L> results);
  template <class... Cs, class S, class F, class... Filters>
  static void each_in(S& storage, F& f, Filters... filters);
  template <class... Cs, class S, class F>
  static std::size_t each_of_in(S& storage, std::span<const Entity> entities, F& f);

  detail::Storage storage_;
};

template <Component... Cs>
Created<Cs...> World::create(std::size_t count) {
  const detail::Storage::Batch batch = storage_.create(signature<Cs...>(), count);
  [[maybe_unused]] const auto column = [&]<class C>(std::type_identity<C>) {
    const detail::ComponentId id = storage_.find_id(detail::kComponentInfo<C>);
    return std::span<C>(detail::rows_of<C>(batch.table->column_data(id)) + batch.first, count);
  };
  return {{batch.table->entities() + batch.first, count}, {column(std::type_identity<Cs>{})...}};
}

template <class C>
C* World::find(Entity entity) const {
  return Accessor<C>(storage_, known_record<C>()).get(entity);
}

template <class C, class L>
WriteReport World::land_from(std::span<L> results) {
  detail::ComponentRecord& target = record<C>();
  const Accessor<C> rows(storage_, target);
  WriteReport report;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (i + detail::kPrefetchAhead < results.size()) {
      rows.prefetch(results[i + detail::kPrefetchAhead].entity);
    }
    L& result = results[i];
    const typename Accessor<C>::Found found = rows.find(result.entity);
    if (found.value == nullptr) {
      ++report.stale;
      continue;
    }
    if constexpr (std::is_const_v<L> && std::is_copy_assignable_v<C>) {
      *found.value = result.value;
    } else {
      static_assert(!std::is_const_v<L>, "values of this type cannot be copied: use move_values");
      *found.value = std::move(result.value);
    }
    if constexpr (is_tracked<C>()) storage_.mark(target, found.at);
    ++report.landed;
  }
  return report;
}

template <class... Cs, class S, class F, class... Filters>
void World::each_in(S& storage, F& f, Filters... filters) {
  static_assert(detail::kDistinct<Cs...>, "a component type occurs once in a query");
  constexpr bool sparse = (is_sparse<std::remove_const_t<Cs>>() || ...);
  static_assert(!sparse || (sizeof...(Cs) == 1 && sizeof...(Filters) == 0),
                "a sparse component is iterated by itself; in other queries it is a filter");
  static_assert((std::size_t{0} + ... + detail::kFilterSize<Filters>) <= detail::kMaxFilters,
                "the filters of a query name at most 8 components");
  constexpr std::size_t kColumns = sizeof...(Cs);
  const std::array<detail::ComponentId, kColumns> ids{
      storage.find_id(detail::kComponentInfo<std::remove_const_t<Cs>>)...};

  const detail::IterationGuard guard(storage.iteration(), detail::kQuery<Cs...>);
  const auto visit = [&](const detail::Table& table, std::uint32_t first, std::uint32_t count) {
    detail::call_with_spans<Cs...>(storage, f, table, ids, first, count);
  };
  if constexpr (sparse) {
    if (ids[0] == detail::kNoComponent) return;
    const detail::Table& members = storage.record(ids[0]).sparse->rows();
    if (members.rows() > 0) visit(members, 0, members.rows());
  } else {
    detail::RowFilter filter;
    (filter.want(storage, detail::kComponentInfo<std::remove_const_t<Cs>>), ...);
    (filter.add(storage, filters), ...);
    filter.each_run(storage, visit);
  }
}

template <class... Cs, class S, class F>
std::size_t World::each_of_in(S& storage, std::span<const Entity> entities, F& f) {
  static_assert(detail::kDistinct<Cs...>, "a component type occurs once in a query");
  static_assert((!is_sparse<std::remove_const_t<Cs>>() && ...),
                "a sparse component has no rows in tables: use an accessor");
  const std::array<detail::ComponentId, sizeof...(Cs)> ids{
      storage.find_id(detail::kComponentInfo<std::remove_const_t<Cs>>)...};
  detail::Signature wanted;
  for (const detail::ComponentId id : ids) {
    if (id == detail::kNoComponent) return 0;
    wanted.insert(id);
  }
  const detail::IterationGuard guard(storage.iteration(), detail::kQuery<Cs...>);
  std::size_t visited = 0;
  detail::each_run_of(storage, entities,
                      [&](const detail::Table& table, std::uint32_t first, std::uint32_t count) {
                        if (!table.signature().includes(wanted)) return;
                        visited += count;
                        detail::call_with_spans<Cs...>(storage, f, table, ids, first, count);
                      });
  return visited;
}

template <Component C>
void World::mark_changed(std::span<const Entity> entities) {
  static_assert(is_tracked<C>(), "only a tracked component is marked: ComponentTraits<C>::tracked");
  detail::ComponentRecord& target = record<C>();
  const Accessor<C> rows(storage_, target);
  std::array<detail::RowPlace, 128> found;  // resolve first, then mark: two short loops
  std::size_t count = 0;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    if (i + detail::kPrefetchAhead < entities.size()) {
      rows.prefetch(entities[i + detail::kPrefetchAhead]);
    }
    const typename Accessor<C>::Found row = rows.find(entities[i]);
    found[count] = row.at;
    count += row.value != nullptr ? 1 : 0;
    if (count == found.size()) {
      storage_.mark(target, found);
      count = 0;
    }
  }
  storage_.mark(target, std::span(found).first(count));
}

}  // namespace psygen::ecs
